#pragma once
/// What all stages of a run have in common.

#include "osculate/time/audit.hpp"
#include "osculate/time/perturbed_run.hpp"
#include "osculate/time/stepper.hpp"

#include <memory>
#include <vector>

namespace osculate::time {

struct RunContext {
    const model::Model& model;
    StepperOptions options;
    Timings& timings;
    double characteristic_length = 1;       ///< m
    double largest_stiffness = 0;           ///< model::largest_stiffness
    std::unique_ptr<Audit> audit{};         ///< null: not wanted
    std::vector<BesideRun*> beside{};       ///< runs that follow this one
    std::vector<double> shares_of_volume{}; ///< of volume_shares()

    /// model::volume_shares, made when first asked for.
    [[nodiscard]] const std::vector<double>& volume_shares() {
        if (shares_of_volume.empty()) shares_of_volume = model::volume_shares(model);
        return shares_of_volume;
    }
    /// Reference force over displacement that round-off calls for, N/m: the last digits of displacements, over neighbours;
    /// sums of the forces themselves lose no more, see BlockMatrix::multiply_add_relative().
    [[nodiscard]] double round_off_force() const;
};

} // namespace osculate::time
