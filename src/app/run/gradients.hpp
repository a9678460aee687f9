#pragma once
/// Derivatives of single quantities at the end of a run by many numbers of its scene.

#include "app/run/changed_scene.hpp"
#include "osculate/time/adjoint_run.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace osculate::app {

/// gradients/NAME.csv: a row for each number, with its derivative by its SI unit, see time::AdjointRun.
class Gradients {
public:
    /// @param resolved  the scene as write_scene() writes it
    Gradients(const LoadedScene& loaded, const std::string& resolved, int threads, Timings& timings,
              std::vector<Fault>& faults);

    /// Of the table, relative to the run's folder.
    [[nodiscard]] static std::string file(const std::string& name) { return "gradients/" + name + ".csv"; }

    [[nodiscard]] time::AdjointRun& run() { return *run_; }
    void write(const std::filesystem::path& folder);
    [[nodiscard]] std::vector<std::string> warnings() const;

private:
    [[nodiscard]] time::FinalQuantity quantity(const scene::Gradient& gradient) const;

    const LoadedScene& loaded_;
    std::map<std::tuple<std::string, double, double>, std::size_t> number_; ///< of a key and its changes
    std::vector<ChangedScenes> scenes_;
    std::unique_ptr<time::AdjointRun> run_;
    bool singular_ = false;         ///< there are none: a linear system has no solution
    std::vector<std::string> zero_; ///< gradients of which all derivatives are 0
};

} // namespace osculate::app
