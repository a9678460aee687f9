#pragma once
/// What every run is checked for while it goes, and whether it came to what its scene expects.

#include "osculate/model/model.hpp"
#include "osculate/output/summary.hpp"
#include "osculate/scene/scene.hpp"
#include "osculate/time/stepper.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osculate::app {

/// Over all accepted steps:
///   force_balance   largest force left over (time::ForceBalance) over the largest sum of forces that act
///   energy_balance  largest balance of the ledger, what the solver left unsolved
///   energy_growth   largest rise of kinetic plus strain energy beyond external work since the dynamic stage began
///   penetration     deepest slave node below its master, open or closed, in sizes of the facet concerned; or of any node
///                   or edge inside another body or its own that the audit of geometry finds
///   closing_loss    what gaps that closed took from the energy: exact contact gives nothing back of it, see docs/theory.md
/// All energies are shares of the largest energy there was: kinetic plus strain, or the work of external forces.
class RunChecks {
public:
    /// The model must outlive it.
    RunChecks(const model::Model& model, std::optional<scene::Expectation> expect)
        : model_(model), expect_(std::move(expect)) {}

    void accepted(const time::AcceptedStep& step);
    /// What has been found so far, as plain numbers; and going on from there.
    /// @throws std::runtime_error where there are not as many as there have to be
    [[nodiscard]] std::vector<double> memory() const;
    void recall(const std::vector<double>& memory);

    [[nodiscard]] output::Summary::Checks checks() const;
    /// What the audit found deepest; `on` as the step says.
    [[nodiscard]] output::Summary::Audit audit() const;
    /// What may surprise whoever believes the results, in sentences.
    [[nodiscard]] std::vector<std::string> warnings() const;
    /// What a run that has ended did not come to; nothing where nothing is expected.
    /// @param failure  why the run gave up; empty: it completed
    [[nodiscard]] std::optional<output::Summary::Expectation> judge(const std::string& failure) const;

private:
    void add_penetration(const time::AcceptedStep& step);
    void add_audit(const time::AcceptedStep& step);
    void add_energies(const time::Ledger& ledger);

    const model::Model& model_;
    const std::optional<scene::Expectation> expect_;
    contact::Intrusion deepest_;                    ///< in body -1: none
    double deepest_time_ = 0;                       ///< s
    double left_over_ = 0, acting_ = 0;             ///< N
    double penetration_ = 0, penetration_m_ = 0;    ///< facet sizes, m
    double excess_ = 0, excessive_ = 0, bound_ = 0; ///< largest penetration over its bound; both, in facet sizes
    bool dynamic_ = false;                          ///< a ledger was seen
    double energy_ = 0, balance_ = 0, growth_ = 0;  ///< J
    double contact_ = 0, closing_ = 0;              ///< J, Ledger::contact of the last step; what it has fallen by
};

} // namespace osculate::app
