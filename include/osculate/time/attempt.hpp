#pragma once
/// Record of one attempted step, for steps.csv.

#include "osculate/core/types.hpp"

#include <string>

namespace osculate::time {

enum class Verdict { accept, retry, give_up };
enum class Reason {
    none,
    interpenetration,
    solver,
    error,
    energy,
    collision,
    audit,
    distance,
    closing_energy,
    reach,
    impact,
    forced
};
/// Those whose names differ.
inline constexpr Reason reasons[] = {Reason::none,   Reason::interpenetration, Reason::solver, Reason::error,
                                     Reason::energy, Reason::collision,        Reason::audit,  Reason::distance,
                                     Reason::reach,  Reason::impact,           Reason::forced};

/// A row of steps.csv.
struct Attempt {
    int attempt = 0;
    double time = 0; ///< at the end of the step, s
    double dt = 0;   ///< s
    Verdict verdict = Verdict::accept;
    Reason reason = Reason::none;
    std::string body;  ///< of the governing node; empty if there is none
    Index node = -1;   ///< local to the body
    double value = 0;  ///< deciding value: the relative residual for `solver`
    double lambda = 1; ///< fraction of dt proposed for the next attempt
    int iterations = 0;
    std::string cause; ///< in words, for messages
};

[[nodiscard]] std::string name(Verdict verdict);
[[nodiscard]] std::string name(Reason reason);

} // namespace osculate::time
