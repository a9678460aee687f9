#pragma once
/// Checks of every run while it proceeds, and its comparison with the expectation of the scene.

#include "osculate/app/rotation_check.hpp"
#include "osculate/model/model.hpp"
#include "osculate/output/summary.hpp"
#include "osculate/scene/scene.hpp"
#include "osculate/time/stepper.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osculate::app {

/// Results over all accepted steps:
///   force_balance   largest unbalanced force (time::ForceBalance) divided by the largest sum of acting forces
///   energy_balance  largest balance of the ledger, the work of the solver's residuals
///   energy_growth   largest rise of kinetic plus strain energy beyond external work since the dynamic stage began
///   penetration     deepest slave node below its master, open or closed, in sizes of its facet; or deepest node or
///                   edge inside another body or its own according to the audit of geometry
///   closing_loss    energy lost in closing gaps: exact contact returns none of it, see docs/theory.md
///   settling_loss   energy lost in inelastic impacts and to stiffness damping, where a rule chose these
///   rotation_strain what rotations add to strains at small strain, see RotationCheck
/// All energies are fractions of the largest energy: kinetic plus strain, or the work of external forces.
class RunChecks {
public:
    /// The model must outlive this object.
    /// @param settles_by_rule  see Plan
    RunChecks(const model::Model& model, std::optional<scene::Expectation> expect, bool settles_by_rule = false)
        : model_(model), expect_(std::move(expect)), settles_by_rule_(settles_by_rule), rotations_(model) {}

    void accepted(const time::AcceptedStep& step);
    /// Results so far, as plain numbers; recall() continues from them.
    /// @throws std::runtime_error if the count of numbers is wrong
    [[nodiscard]] std::vector<double> memory() const;
    void recall(const std::vector<double>& memory);

    [[nodiscard]] output::Summary::Checks checks() const;
    /// The deepest penetration found by the audit; `on` as in the steps.
    [[nodiscard]] output::Summary::Audit audit() const;
    /// Warnings for users who rely on the results, in sentences.
    [[nodiscard]] std::vector<std::string> warnings() const;
    /// Unmet expectations of a run that has ended; no value if there are no expectations.
    /// @param failure  why the run failed; empty: it completed
    [[nodiscard]] std::optional<output::Summary::Expectation> judge(const std::string& failure) const;

private:
    void add_penetration(const time::AcceptedStep& step);
    void add_audit(const time::AcceptedStep& step);
    /// Finds slaves that have left the master over the end of its sector.
    void add_crossing(const time::AcceptedStep& step);
    void add_energies(const time::Ledger& ledger, const time::Stage& stage);

    const model::Model& model_;
    const std::optional<scene::Expectation> expect_;
    bool settles_by_rule_;
    RotationCheck rotations_;
    contact::Intrusion deepest_;                    ///< body -1: none
    double deepest_time_ = 0;                       ///< s
    double left_over_ = 0, acting_ = 0;             ///< N
    double penetration_ = 0, penetration_m_ = 0;    ///< facet sizes, m
    double excess_ = 0, excessive_ = 0, bound_ = 0; ///< largest ratio of penetration to bound; both, in facet sizes
    Index crossed_ = -1;                            ///< the first such slave, -1: none has; ...
    double crossed_time_ = 0;                       ///< ... and when, s
    bool dynamic_ = false;                          ///< a ledger was seen
    double energy_ = 0, balance_ = 0, growth_ = 0;  ///< J
    double contact_ = 0, closing_ = 0;              ///< J, Ledger::contact of the last step; sum of its decreases
    double settling_ = 0, settled_ = 0; ///< J, likewise Ledger::settling, sum of its increases where they count
};

} // namespace osculate::app
