#include "osculate/time/attempt.hpp"

namespace osculate::time {

std::string name(Verdict verdict) {
    switch (verdict) {
    case Verdict::accept: return "accept";
    case Verdict::retry: return "retry";
    case Verdict::give_up: return "give_up";
    }
    return "";
}

std::string name(Reason reason) {
    switch (reason) {
    case Reason::none: return "none";
    case Reason::interpenetration: return "interpenetration";
    case Reason::solver: return "solver";
    case Reason::error: return "error";
    case Reason::energy:
    case Reason::closing_energy: return "energy";
    case Reason::collision: return "collision";
    case Reason::audit: return "audit";
    case Reason::distance: return "distance";
    case Reason::reach: return "reach";
    case Reason::impact: return "impact";
    case Reason::forced: return "forced";
    }
    return "";
}

} // namespace osculate::time
