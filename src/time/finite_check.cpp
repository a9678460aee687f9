#include "osculate/time/finite_check.hpp"

#include "osculate/time/post_mortem.hpp"
#include "time/number.hpp"

#include <cmath>
#include <utility>

namespace osculate::time {

namespace {

std::optional<NotFinite> first_in(const char* what, const Field& field) {
    for (std::size_t i = 0; i < field.size(); ++i)
        for (const double value : field[i])
            if (!std::isfinite(value)) return NotFinite{what, static_cast<Index>(i), value};
    return {};
}

std::optional<NotFinite> first_in(const model::ContactEvaluation& evaluation, const model::ContactHistory& contact) {
    for (Index j = 0; j < evaluation.pair().size(); ++j) {
        const Index node = evaluation.pair().slaves().node[j];
        for (const double value : contact.lambda[j])
            if (!std::isfinite(value)) return NotFinite{"contact force", node, value};
        if (const contact::ContactPoint& point = evaluation.point(j); point.found && !std::isfinite(point.gap))
            return NotFinite{"gap", node, point.gap};
    }
    return {};
}

std::optional<NotFinite> first_in(const Ledger& ledger) {
    using Term = std::pair<const char*, double>;
    for (const auto& [what, value] :
         {Term{"energy.kinetic", ledger.kinetic}, Term{"energy.strain", ledger.strain},
          Term{"energy.external", ledger.external}, Term{"energy.friction", ledger.friction},
          Term{"energy.damping", ledger.damping}, Term{"energy.algorithmic", ledger.algorithmic},
          Term{"energy.contact", ledger.contact}, Term{"energy.balance", ledger.balance}})
        if (!std::isfinite(value)) return NotFinite{what, -1, value};
    for (const auto& [what, momentum] :
         {std::pair{"linear momentum", ledger.linear}, std::pair{"angular momentum", ledger.angular}})
        for (const double value : momentum)
            if (!std::isfinite(value)) return NotFinite{what, -1, value};
    return {};
}

} // namespace

std::optional<NotFinite> find_not_finite(const model::ContactEvaluations& contact, const model::State& state,
                                         const Ledger* ledger) {
    for (const auto& [what, field] :
         {std::pair{"displacement", &state.u}, std::pair{"velocity", &state.v}, std::pair{"acceleration", &state.a}})
        if (auto found = first_in(what, *field)) return found;
    for (std::size_t p = 0; p < contact.size(); ++p)
        if (auto found = first_in(contact[p], state.contact[p])) return found;
    for (const double value : state.material)
        if (!std::isfinite(value)) return NotFinite{"a value that a material remembers", -1, value};
    return ledger != nullptr ? first_in(*ledger) : std::nullopt;
}

void explain(const NotFinite& found, const model::Model& model, Attempt& attempt) {
    attempt.body.clear();
    attempt.node = -1;
    name_node(model, found.node, attempt);
    attempt.cause = found.what;
    if (!attempt.body.empty())
        attempt.cause += " of node " + std::to_string(attempt.node) + " of body '" + attempt.body + "'";
    attempt.cause += " is " + number(found.value) + " although the residual is within tolerance";
}

} // namespace osculate::time
