#pragma once
/// Why a run gave up: everything known of its last attempt, and what to change.

#include "osculate/core/error.hpp"
#include "osculate/time/attempt.hpp"
#include "osculate/time/solve_ladder.hpp"
#include "osculate/time/stage.hpp"
#include "osculate/time/step_control.hpp"

#include <optional>
#include <string>
#include <vector>

namespace osculate::time {

enum class Cause {
    unsupported_body,     ///< nothing holds a body at the last iterate
    singular_tangent,     ///< every body is held, and yet the tangent has no inverse
    linear_system,        ///< GMRES with multigrid does not solve it
    diverged,             ///< the iterates run away from the last equilibrium
    status_cycle,         ///< statuses come back to what they were
    stalled,              ///< statuses rest, and the residual does not fall
    iterations_exhausted, ///< solver.max_iterations
    no_descent,           ///< a line search found no smaller residual
    not_evaluable,        ///< no residual along the step
    not_finite,           ///< residual or step held NaN or infinity
    inside_out,           ///< an element has no volume left
    interpenetration,
    unseen_contact, ///< bodies inside one another where no contact node sees it
    collision,
    time_error,
    energy,
    load_not_finite, ///< a table or an expression
};

/// A slave node whose status changed within the last attempt.
struct StatusChanges {
    std::string pair, body;
    Index node = -1;                       ///< local to the body
    std::vector<contact::Status> sequence; ///< without repetitions, in their order
};

/// What holds a body.
struct BodyHold {
    std::string body;
    int free_by_supports = 0;              ///< rigid motions that supports and driven motions leave it
    int free_with_contact = 0;             ///< and contact as well, as if what it touches stood still
    std::vector<std::string> free_motions; ///< these in words, see model::RigidHold
    bool in_pair = false;
    Index touching = 0;                ///< closed slave nodes on either side of it, at the last iterate
    Index pressed = 0;                 ///< those of them that contact does not pull
    Index touched = 0;                 ///< closed ones at the last accepted state
    std::string nearest_pair;          ///< with the smallest gap at the last accepted state; empty: no partner anywhere
    double nearest_gap = 0, facet = 0; ///< that gap and the size of the facet, m
};

/// The slave node in question and what it faces.
struct ContactPlace {
    std::string pair, master_body;
    Index master_facet = -1;        ///< of the pair's master surface; -1: nothing faces the node
    std::vector<Index> facet_nodes; ///< local to the master's body
    contact::Status status = contact::Status::open;
    double gap = 0; ///< m
};

struct ElementPlace {
    std::string body;
    Index element = -1;
    double J = 0; ///< det F
};

/// One thing to change.
struct Advice {
    std::string key;                ///< of the scene
    std::string text;               ///< to what, and why
    std::vector<std::string> set{}; ///< KEY=VALUE as `--set` takes them, which do as it says; empty: in words alone
};

/// A load or a motion without a value.
struct MissingLoad {
    std::string course;  ///< its name, as in Course
    double elapsed = 0;  ///< since the stage's start, s
    double duration = 0; ///< of the stage, s
};

/// What is known of a failure. `advice` and `no_remedy` are for whoever knows the keys of a scene to fill in.
struct PostMortem {
    Cause cause = Cause::iterations_exhausted;
    std::string message; ///< the run's own sentence
    std::string stage;
    double time = 0, last_time = 0;      ///< aimed at, and of the last accepted state, s
    double dt = 0, smallest_dt = 0;      ///< of the last attempt, and the smallest allowed, s
    std::string limit;                   ///< why it was not cut any further, in words
    std::vector<Attempt> attempts;       ///< of this step
    std::string body;                    ///< of the node; empty: there is none
    Index node = -1;                     ///< local to the body
    Vec3 X = Vec3::Zero(), x = X;        ///< where it was at first, and is at the last iterate, m
    std::optional<ContactPlace> contact; ///< of that node, or of one whose status went to and fro
    std::optional<ElementPlace> element;
    std::optional<MissingLoad> missing_load{};
    double residual = 0;                                  ///< of the last solve, relative
    double reference_force = 0;                           ///< what it is relative to, N
    Vec3 out_of_balance = Vec3::Zero();                   ///< force that nothing balances at the node, N
    std::string rung;                                     ///< of the ladder, that came last
    std::vector<equilibrium::IterationRecord> iterations; ///< of the last attempt
    std::vector<StatusChanges> changes;                   ///< those that changed most often first
    Index changing = 0;                                   ///< nodes in all; `changes` has the first few
    std::vector<BodyHold> bodies;
    std::vector<Advice> advice;
    std::string no_remedy; ///< why none is known; empty: `advice` holds one
};

[[nodiscard]] std::string name(Cause cause);
[[nodiscard]] std::string in_words(Cause cause);
[[nodiscard]] std::string name(contact::Status status);
/// Of the enumerations; nothing where no cause or status has that name.
[[nodiscard]] std::optional<Cause> cause_of(const std::string& name);
[[nodiscard]] std::optional<contact::Status> status_of(const std::string& name);

/// The last attempt of a run, as the stepper has it.
struct FailedAttempt {
    const model::Model& model;
    const Stage& stage;
    const model::State& last; ///< accepted
    const Vector& z;          ///< last iterate
    const LadderResult& result;
    const LadderOptions& ladder;
    const Decision& decision;
    const std::vector<Attempt>& attempts; ///< of this step, the failed one last
};

/// Examines it. Evaluates `equilibrium` once more, at z with the statuses it has, where z is finite.
[[nodiscard]] PostMortem examine(const FailedAttempt& failed, equilibrium::Equilibrium& equilibrium);
/// A load or a motion without a value: the step cannot even be tried.
class LoadNotFinite : public RunFailure {
public:
    /// @param course   its name, as in Course  @param elapsed  time since the stage's start at which it has no value, s
    LoadNotFinite(const std::string& message, std::string course, double elapsed)
        : RunFailure(message), course_(std::move(course)), elapsed_(elapsed) {}
    [[nodiscard]] const std::string& course() const { return course_; }
    [[nodiscard]] double elapsed() const { return elapsed_; }

private:
    std::string course_;
    double elapsed_;
};

/// @param t_start    of the stage, s  @param last_time  of the last accepted state, s
[[nodiscard]] PostMortem examine(const LoadNotFinite& failure, const model::Model& model, const Stage& stage,
                                 double t_start, double last_time);
/// A failed solve in one sentence; fills in the attempt's body, node and value.
[[nodiscard]] std::string explain(const model::Model& model, const LadderResult& result,
                                  const equilibrium::Equilibrium& equilibrium, Attempt& attempt);
/// Fills in body and local number of a node.
void name_node(const model::Model& model, Index node, Attempt& attempt);

} // namespace osculate::time
