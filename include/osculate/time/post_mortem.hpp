#pragma once
/// Diagnosis of a failed run: all data of its last attempt, and advice.

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
    unsupported_body,     ///< a body is not held at the last iterate
    singular_tangent,     ///< every body is held, but the tangent is singular
    linear_system,        ///< GMRES with multigrid does not converge
    diverged,             ///< the iterates diverge from the last equilibrium
    status_cycle,         ///< statuses repeat
    stalled,              ///< statuses are constant, and the residual does not decrease
    iterations_exhausted, ///< solver.max_iterations reached
    no_descent,           ///< a line search found no smaller residual
    not_evaluable,        ///< no residual along the step
    not_finite,           ///< residual or step contained NaN or infinity
    inside_out,           ///< an element has det F <= 0
    interpenetration,
    unseen_contact, ///< bodies penetrate each other where no contact node detects it
    far_contact,    ///< a contact force acts on a node that is far from the master
    collision,
    time_error,
    energy,
    load_not_finite, ///< a table or an expression
};

/// A slave node whose status changed during the last attempt.
struct StatusChanges {
    std::string pair, body;
    Index node = -1;                       ///< local to the body
    std::vector<contact::Status> sequence; ///< without repetitions, in temporal order
};

/// How a body is held.
struct BodyHold {
    std::string body;
    int free_by_supports = 0;              ///< rigid motions that supports and driven motions leave free
    int free_with_contact = 0;             ///< rigid motions that contact with fixed partners leaves free, too
    std::vector<std::string> free_motions; ///< these motions in words, see model::RigidHold
    bool in_pair = false;
    Index touching = 0;                ///< closed slave nodes on either side of it, at the last iterate
    Index pressed = 0;                 ///< number of these without tensile contact force
    Index touched = 0;                 ///< closed slave nodes at the last accepted state
    bool pushed = false;               ///< its loads push it against what it touched there
    std::string nearest_pair;          ///< of the smallest gap at the last accepted state; empty: no partner
    double nearest_gap = 0, facet = 0; ///< that gap and the facet's size, m
};

/// The slave node in question and the master facet that it faces.
struct ContactPlace {
    std::string pair, master_body;
    Index master_facet = -1;        ///< of the pair's master surface; -1: the node faces none
    std::vector<Index> facet_nodes; ///< local to the master's body
    contact::Status status = contact::Status::open;
    double gap = 0; ///< m
};

struct ElementPlace {
    std::string body;
    Index element = -1;
    double J = 0; ///< det F
};

/// One recommended change.
struct Advice {
    std::string key;                ///< of the scene
    std::string text;               ///< new value and reason
    std::vector<std::string> set{}; ///< KEY=VALUE as for `--set`, with the same effect; empty: text only
};

/// A load or a motion without a value.
struct MissingLoad {
    std::string course;  ///< its name, as in Course
    double elapsed = 0;  ///< since the stage's start, s
    double duration = 0; ///< of the stage, s
};

/// Data of a failure. `advice` and `no_remedy` are filled in by code that knows the keys of a scene.
struct PostMortem {
    Cause cause = Cause::iterations_exhausted;
    std::string message; ///< error message of the run
    std::string stage;
    double time = 0, last_time = 0;      ///< end of the attempt, and of the last accepted step, s
    double dt = 0, smallest_dt = 0;      ///< of the last attempt, and the smallest allowed, s
    std::string limit;                   ///< why it was not cut further, in words
    std::vector<Attempt> attempts;       ///< of this step
    std::string body;                    ///< of the node; empty: none
    Index node = -1;                     ///< local to the body
    Vec3 X = Vec3::Zero(), x = X;        ///< reference position, and position at the last iterate, m
    std::optional<ContactPlace> contact; ///< of that node, or of one with alternating status
    std::optional<ElementPlace> element;
    std::optional<MissingLoad> missing_load{};
    double residual = 0;                                  ///< of the last solve, relative
    double reference_force = 0;                           ///< reference of `residual`, N
    Vec3 out_of_balance = Vec3::Zero();                   ///< unbalanced force at the node, N
    std::string rung;                                     ///< last rung of the ladder
    std::vector<equilibrium::IterationRecord> iterations; ///< of the last attempt
    std::vector<StatusChanges> changes;                   ///< most frequent changes first
    Index changing = 0;                                   ///< number of such nodes; `changes` has the first few
    std::vector<BodyHold> bodies;
    std::vector<Advice> advice;
    std::string no_remedy; ///< why no advice is known; empty: there is some
};

[[nodiscard]] std::string name(Cause cause);
[[nodiscard]] std::string in_words(Cause cause);
[[nodiscard]] std::string name(contact::Status status);
/// The enumerator with a name; no value if there is none.
[[nodiscard]] std::optional<Cause> cause_of(const std::string& name);
[[nodiscard]] std::optional<contact::Status> status_of(const std::string& name);

/// The last attempt of a run, with references to the stepper's data.
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

/// Examines the failed attempt. Evaluates `equilibrium` once more at z, with its statuses, if z is finite.
[[nodiscard]] PostMortem examine(const FailedAttempt& failed, equilibrium::Equilibrium& equilibrium);
/// Error: a load or a motion has no finite value, so that the step cannot even be tried.
class LoadNotFinite : public RunFailure {
public:
    /// @param course  its name, as in Course  @param elapsed  time since the stage's start at which there is no value,
    ///                s
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
/// Describes a failed solve in one sentence; fills in the attempt's body, node and value.
[[nodiscard]] std::string explain(const model::Model& model, const LadderResult& result,
                                  const equilibrium::Equilibrium& equilibrium, Attempt& attempt);
/// Sets the body and the local number of a node in the attempt.
void name_node(const model::Model& model, Index node, Attempt& attempt);

} // namespace osculate::time
