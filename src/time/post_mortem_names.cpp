/// Names of causes and statuses, in files and in words.

#include "osculate/time/post_mortem.hpp"

#include <algorithm>
#include <array>

namespace osculate::time {

using contact::Status;

namespace {

struct CauseWords {
    Cause cause;
    const char *name, *words;
};

constexpr std::array<CauseWords, 18> causes{{
    {Cause::unsupported_body, "unsupported_body", "nothing holds a body: a static load moves it without end"},
    {Cause::singular_tangent, "singular_tangent",
     "the tangent has no inverse: the equations contradict or repeat each other"},
    {Cause::linear_system, "linear_system",
     "multigrid does not solve a linear system, and it is too large to be factorised"},
    {Cause::diverged, "diverged",
     "the iterates run away: there is no equilibrium near the last one, or the step is too long"},
    {Cause::status_cycle, "status_cycle", "contact statuses repeat in a cycle"},
    {Cause::stalled, "stalled", "the residual stops falling although no contact status changes"},
    {Cause::iterations_exhausted, "iterations_exhausted", "Newton's iterations ran out"},
    {Cause::no_descent, "no_descent", "no step along the Newton direction lowers the residual"},
    {Cause::not_evaluable, "not_evaluable", "the residual cannot be evaluated along the Newton step"},
    {Cause::not_finite, "not_finite", "a number of the solve is not finite"},
    {Cause::inside_out, "inside_out", "an element is turned inside out"},
    {Cause::interpenetration, "interpenetration", "the step takes a node deeper into a surface than is allowed"},
    {Cause::unseen_contact, "unseen_contact",
     "a body goes into another, or into itself, where no contact force acts on it: no pair has both surfaces, or the "
     "place is at an edge between nodes, at a node of a master, or where averages over facets see nothing"},
    {Cause::far_contact, "far_contact",
     "contact puts a force on a node that geometry finds far from the surface it should lie on: the contact is wrong "
     "there"},
    {Cause::collision, "collision", "the step takes a node through a surface"},
    {Cause::time_error, "time_error", "the step makes a larger error in time than is allowed"},
    {Cause::energy, "energy", "contact adds more energy in the step than is allowed"},
    {Cause::load_not_finite, "load_not_finite", "a load or a motion has no finite value"},
}};

constexpr std::array<Status, 4> all_statuses{Status::open, Status::stick, Status::slip, Status::glide};

} // namespace

std::string name(Cause cause) {
    return std::ranges::find(causes, cause, &CauseWords::cause)->name;
}

std::string in_words(Cause cause) {
    return std::ranges::find(causes, cause, &CauseWords::cause)->words;
}

std::string name(Status status) {
    switch (status) {
    case Status::open: return "open";
    case Status::stick: return "stick";
    case Status::slip: return "slip";
    case Status::glide: return "glide";
    }
    return "";
}

std::optional<Cause> cause_of(const std::string& text) {
    for (const CauseWords& row : causes)
        if (text == row.name) return row.cause;
    return std::nullopt;
}

std::optional<Status> status_of(const std::string& text) {
    for (const Status status : all_statuses)
        if (text == name(status)) return status;
    return std::nullopt;
}

} // namespace osculate::time
