#include "osculate/equilibrium/tangent_choice.hpp"

#include "osculate/model/general_contact.hpp"
#include "osculate/solve/direct_on_first.hpp"

#include <algorithm>

namespace osculate::equilibrium {

bool CondensationCost::pays(double as_fast) const {
    constexpr double most = 4e9; // bytes
    return condensed <= as_fast * factorising && bytes <= most;
}

std::vector<Index> contact_nodes(const model::Model& model, const model::ContactPairs& pairs,
                                 const model::ContactScope* scope) {
    std::vector<Index> nodes;
    const auto add = [&](const std::vector<Index>& more) { nodes.insert(nodes.end(), more.begin(), more.end()); };
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        add(pairs[p]->slaves().node);
        if (scope != nullptr && p >= model.pairs.size())
            add(model.general->reachable(*scope, *pairs[p]));
        else
            add(pairs[p]->master_nodes());
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

CondensationCost condensation_cost(const model::Model& model, const model::ContactPairs& pairs,
                                   const model::ContactScope* scope) {
    std::size_t contacts = 0;
    for (const auto& pair : pairs)
        if (!pair->slaves().edges) contacts += static_cast<std::size_t>(pair->size()); // few edges of many cross
    return condensation_cost(model, contact_nodes(model, pairs, scope), contacts);
}

CondensationCost condensation_cost(const model::Model& model, const std::vector<Index>& nodes, std::size_t contacts) {
    constexpr double nested_dissection = 14; // operations of METIS and CHOLMOD over the square of a body's unknowns
    constexpr double laws = 2;               // T's of a solve
    const double forces = 3.0 * static_cast<double>(contacts);
    CondensationCost cost;
    for (const model::Body& body : model.bodies) {
        const double all = 3.0 * static_cast<double>(body.nodes());
        const auto first = std::ranges::lower_bound(nodes, body.first_node),
                   last = std::ranges::lower_bound(nodes, body.first_node + body.nodes());
        const double kept = 3.0 * static_cast<double>(last - first);
        cost.factorising += nested_dissection * all * all;
        cost.condensed += kept * kept * kept;
        cost.bytes += sizeof(double) * kept * kept;
    }
    cost.condensed += laws * 2.0 / 3.0 * forces * forces * forces;
    cost.bytes += sizeof(double) * forces * forces;
    return cost;
}

namespace {
/// Nodes with equations of their own, before supports.
Index nodes_with_equations(const model::Model& model) {
    return model.nodes() - static_cast<Index>(model::dependent_nodes(model).size());
}

bool goes_by_multigrid(const model::Model& model, LinearSolver asked, bool condensable) {
    constexpr Index many = 10000;      // nodes from which cycles cost less than factors that serve one step
    constexpr Index very_many = 50000; // and less than those that condensation makes once
    if (model.share) return true;      // no process has the whole matrix
    if (bars_multigrid(model, asked) != nullptr) return false;
    return asked == LinearSolver::multigrid || nodes_with_equations(model) > (condensable ? very_many : many);
}

/// Not where LU wants a matrix, nor with so many slave nodes that their derivatives, held one by one, would take more memory.
bool goes_by_products(const model::ContactPairs& pairs, LinearSolver asked) {
    constexpr Index most = 40000; // some 50 kB each on a smooth master
    Index slaves = 0;
    for (const auto& pair : pairs) slaves += pair->size();
    return slaves > 0 && slaves <= most && asked != LinearSolver::direct;
}
} // namespace

const char* bars_multigrid(const model::Model& model, LinearSolver asked) {
    constexpr std::size_t few = 10; // each of their motions takes some cycles and two vectors
    if (asked != LinearSolver::automatic && asked != LinearSolver::multigrid)
        return "the scene asks for another solver";
    if (!model.skin.empty()) return "contact of faces with midside nodes takes it too many cycles";
    if (model.rigid.size() > few) return "each of many rigid bodies and couplings takes it some cycles";
    if (model.rigid.size() == model.bodies.size() && std::ranges::none_of(model.rigid, &model::RigidBody::coupling))
        return "no body deforms";
    if (!model.led.empty() && asked == LinearSolver::automatic)
        return "equations between means of many nodes take it several times as many cycles";
    const auto stiff = [&](const auto& pair) {
        const std::vector<Index>& slaves = pair->slaves().node;
        const model::RigidBody* body = slaves.empty() ? nullptr : model::rigid_body_of(model, slaves.front());
        return body != nullptr && !body->coupling;
    };
    if (asked == LinearSolver::automatic && !model.share && std::ranges::any_of(model.pairs, stiff))
        return "a rigid body is the slave of a pair, which takes it many cycles";
    return nullptr;
}

const char* needs_factors(const model::Model& model) {
    constexpr std::size_t few = 8; // nodes that lead one
    if (!model.skin.empty()) return "contact of faces with midside nodes";
    const bool means = std::ranges::any_of(model.led, [](const model::LedNode& one) { return one.by.size() > few; });
    return means ? "equations between means of many nodes" : nullptr;
}

TangentChoice choose_tangent(const model::Model& model, const model::ContactPairs& pairs, LinearSolver asked,
                             bool dynamic, bool follows, const model::ContactScope* scope) {
    const bool pays = !model.nonlinear && !model.has_dependent_nodes() && condensation_cost(model, pairs, scope).pays();
    const bool couplings = std::ranges::any_of(model.rigid, &model::RigidBody::coupling);
    const bool symmetric = !follows && !couplings && (!dynamic || !model.nonlinear);
    const bool contact = !pairs.empty();
    TangentChoice choice;
    if (model.share && needs_factors(model) != nullptr) return choice;
    choice.multigrid = goes_by_multigrid(model, asked, pays);
    choice.factorisable = !choice.multigrid ||
                          nodes_with_equations(model) <= solve::most_nodes_on_first; // of processes, the first does it
    choice.products = choice.multigrid || goes_by_products(pairs, asked);
    choice.preconditioned =
        choice.multigrid ||
        ((contact || !symmetric || !model.ties.empty() || !model.cyclic.empty() || !model.led.empty()) &&
         asked != LinearSolver::direct);
    choice.reduced = choice.preconditioned && choice.products && !choice.multigrid && !model.nonlinear &&
                     !model.has_dependent_nodes() && !follows;
    // steps of dynamics change their length and with it the inverses; general contact reaches many more nodes than bear
    const bool grows = scope != nullptr && !dynamic, asks = asked == LinearSolver::condensed;
    choice.condensed = !model.nonlinear && !model.has_dependent_nodes() && !follows && !choice.multigrid &&
                       choice.products && (asks || (asked == LinearSolver::automatic && (pays || grows)));
    choice.grows = choice.condensed && grows;
    choice.at_any_cost = choice.grows && asks;
    if (choice.condensed && !grows) choice.nodes = contact_nodes(model, pairs, scope);
    return choice;
}

} // namespace osculate::equilibrium
