#pragma once
/// Gathers advice for one failure, by its cause.

#include "osculate/model/contact_pair.hpp"
#include "osculate/time/post_mortem.hpp"
#include "osculate/time/stepper.hpp"

#include <string>
#include <vector>

namespace osculate::app {

/// In files by what the cause has to do with: advice_on_support.cpp, advice_on_solves.cpp, advice_on_contact.cpp; the rest in advice.cpp.
class Adviser {
public:
    Adviser(time::PostMortem& found, const time::FailedAttempt& failed)
        : found_(found), failed_(failed), stage_("stages." + failed.stage.name) {}

    void advise();
    [[nodiscard]] static std::string number(double value);

private:
    static constexpr double margin = 2; ///< of values that are set beyond a limit, which a longer run may need again

    /// A round number for an override.
    [[nodiscard]] static std::string rounded(double value);
    void add(std::string key, std::string text, std::vector<std::string> set = {});
    /// Advice that is one value of its key.
    void change(const std::string& key, const std::string& value, std::string text);
    [[nodiscard]] std::string in_stage(const std::string& key) const;
    [[nodiscard]] const model::ContactPair* pair(const std::string& name) const;
    /// Key of the scene that describes a pair.
    [[nodiscard]] std::string key_of(const model::ContactPair& pair) const;
    [[nodiscard]] std::string surface_key(const model::ContactPair& pair) const;
    /// Whether the scene has a pair of this name; general contact finds others.
    [[nodiscard]] bool is_own(const std::string& name) const;
    [[nodiscard]] double whole_step() const;
    /// More cuts, where that is what was missing; more steps otherwise.
    void smaller_steps(const std::string& why);
    [[nodiscard]] bool at_smallest() const;
    /// The same where it is known by how much: nothing where a run would not come to its end with such steps.
    /// @param share  of the last attempt's step that would do
    /// @param least  of the stage's steps, steps that a run can do with
    void steps_smaller_by(double share, double least, const std::string& why);
    static std::string listed(const std::vector<std::string>& words);

    // advice_on_support.cpp
    void unsupported();
    /// Whether nodes of a pair that opened during the last attempt closed again: what pulls a body off does not do that.
    [[nodiscard]] bool closed_again(const std::string& name) const;
    void dynamics(const std::string& why);
    void contradiction();

    // advice_on_solves.cpp
    /// Whether the step was cut so often, in this step or before, that more of it would change nothing.
    [[nodiscard]] bool cut_enough() const;
    void diverged();
    void less_load();
    /// Where the residual is so small that round-off rather than the contact may hold it there.
    void larger_tolerance();
    void tolerance_above_residual();
    void cycle();
    void iterations();
    void stall();

    // advice_on_contact.cpp
    void too_deep();
    /// Share of a step that ended beyond the surface, within which the node moves no more than it may enter; infinite: not known.
    [[nodiscard]] double share_within_depth() const;
    /// What allowed_interpenetration is a share of at the node in question, m.
    [[nodiscard]] double unit_of_depth() const;
    void unseen();
    void by_nodes(const model::ContactPair& pair);
    /// Overrides that make the master of a pair its slave, where sets of the scene are these surfaces.
    [[nodiscard]] std::vector<std::string> sides_swapped(const model::ContactPair& pair) const;
    /// What the audit found.
    void inside(const contact::Intrusion& intrusion);
    /// Contact knows nodes against facets, so that one of them must come to lie on a facet soon enough.
    void edges_cross(const model::ContactPair& pair, const contact::Intrusion& intrusion);
    void far();

    // advice.cpp
    void not_finite();
    void inside_out();
    /// Least det F at the last accepted state.
    [[nodiscard]] double volume_left() const;
    void time_error();
    void energy();
    /// Whether there are contact nodes without mass.
    [[nodiscard]] bool massless() const;

    time::PostMortem& found_;
    const time::FailedAttempt& failed_;
    std::string stage_;
};

} // namespace osculate::app
