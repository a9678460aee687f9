#include "osculate/time/checkpoint.hpp"

#include "osculate/model/general_contact.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace osculate::time {

namespace {

bool within(Index value, Index end) {
    return value >= 0 && value < end;
}

bool within(const std::vector<Index>& values, Index end) {
    return std::ranges::all_of(values, [&](Index value) { return within(value, end); });
}

template <class List> bool finite(const List& values) {
    return std::ranges::all_of(values, [](const auto& value) { return value.allFinite(); });
}

/// @param slaves, facets  of the pair
std::string misfit(const model::ContactHistory& history, std::size_t slaves, Index facets, const std::string& name) {
    const std::string whose = " of pair '" + name + "'";
    if (history.lambda.size() != slaves || history.status.size() != slaves || history.facet.size() != slaves)
        return "slave nodes" + whose;
    if (!history.slides.empty() && history.slides.size() != slaves) return "slave nodes" + whose;
    if (!finite(history.lambda)) return "contact forces" + whose;
    for (const contact::Status status : history.status)
        if (status > contact::Status::glide) return "contact statuses" + whose;
    for (const Index facet : history.facet)
        if (facet != -1 && !within(facet, facets)) return "contact facets" + whose;
    return {};
}

/// Whether what general contact has found fits its surfaces.
std::string misfit(const FoundPair& pair, const model::GeneralContact& general, Index nodes) {
    const auto surfaces = static_cast<Index>(general.surfaces().size());
    if (!within(pair.slave, surfaces) || !within(pair.master, surfaces)) return "surfaces of general contact";
    if (pair.nodes.empty() || !within(pair.nodes, nodes)) return "slave nodes of general contact";
    if (!pair.edges.empty()) {
        const auto fits = [&](std::size_t k, Index surface) {
            const auto& half_edges = general.surfaces()[static_cast<std::size_t>(surface)].side->surface().half_edges();
            return pair.edges[k] >= 0 && static_cast<std::size_t>(pair.edges[k]) < half_edges.size() &&
                   half_edges[static_cast<std::size_t>(pair.edges[k])].twin >= 0;
        };
        bool all = pair.edges.size() == 2 * pair.nodes.size();
        for (std::size_t k = 0; all && k < pair.edges.size(); ++k) all = fits(k, k % 2 == 0 ? pair.slave : pair.master);
        return all ? "" : "edges of general contact";
    }
    if (!std::ranges::is_sorted(pair.nodes)) return "slave nodes of general contact";
    if (!std::ranges::includes(pair.nodes, pair.yielding)) return "slave nodes of general contact";
    for (std::size_t k = 0; k < pair.facets.size(); ++k)
        if (!(pair.facets[k] == -1 && k % 4 == 3) && !std::ranges::binary_search(pair.nodes, pair.facets[k]))
            return "slave facets of general contact";
    return pair.facets.size() % 4 == 0 ? "" : "slave facets of general contact";
}

std::string misfit(const equilibrium::EquilibriumMemory& memory, const model::Model& model,
                   const std::vector<FoundPair>& found) {
    std::vector<Index> slaves;
    for (const auto& pair : model.pairs)
        slaves.insert(slaves.end(), pair->slaves().node.begin(), pair->slaves().node.end());
    for (const FoundPair& pair : found) slaves.insert(slaves.end(), pair.nodes.begin(), pair.nodes.end());
    if (!memory.couplings.empty()) {
        if (!std::ranges::equal(memory.couplings, slaves, {}, &linear::Coupling::slave)) return "slave nodes";
        for (const linear::Coupling& coupling : memory.couplings)
            if (!within(coupling.masters, model.nodes()) || !std::ranges::is_sorted(coupling.masters))
                return "master nodes";
    }
    if (memory.springs)
        for (const linear::Spring& spring : *memory.springs)
            if (!within(spring.slave, model.nodes()) || !within(spring.masters, model.nodes())) return "springs";
    if (!within(memory.condensed, model.nodes()) || !std::ranges::is_sorted(memory.condensed)) return "condensed nodes";
    if (memory.factors) {
        const auto& contacts = *memory.factors->contacts;
        const auto slave = [](const linear::SoftContact& c) { return c.where.slave; };
        if (!std::isfinite(memory.factors->mass_factor) || !(memory.factors->fresh >= 0) ||
            !(memory.factors->wasted >= 0) || !std::ranges::equal(contacts, slaves, {}, slave))
            return "factors";
        for (const linear::SoftContact& c : contacts)
            if (!within(c.where.masters, model.nodes()) || !finite(c.where.follow) || !c.normal.allFinite() ||
                !c.B.allFinite() || !c.D.allFinite() || !(c.c > 0))
                return "factors";
    }
    if (!memory.laws) return {};
    const linear::ContactLaws& laws = *memory.laws;
    const std::size_t count = laws.terms.size();
    if (!std::isfinite(laws.mass_factor) || !within(laws.couplings, static_cast<Index>(slaves.size())) ||
        laws.couplings.size() > count || laws.B.size() != count || laws.D.size() != count || !finite(laws.B) ||
        !finite(laws.D))
        return "contact laws";
    for (const auto& terms : laws.terms)
        for (const linear::ContactLaws::Term& term : terms) // contact nodes are some of all
            if (!within(term.node, model.nodes()) || !term.by.allFinite()) return "contact laws";
    return {};
}

} // namespace

std::string misfit(const Checkpoint& checkpoint, const model::Model& model, std::size_t stages) {
    const model::State& state = checkpoint.state;
    const auto nodes = static_cast<std::size_t>(model.nodes());
    if (checkpoint.stage >= stages) return "number of stages";
    if (!std::isfinite(checkpoint.stage_start) || !std::isfinite(state.time) || state.time < checkpoint.stage_start ||
        !(checkpoint.dt > 0) || !std::isfinite(checkpoint.dt))
        return "times";
    if (state.u.size() != nodes || checkpoint.displacement_start.size() != nodes || state.v.size() != state.a.size() ||
        (!state.v.empty() && state.v.size() != nodes))
        return "number of nodes";
    if (state.material.size() != model::initial_history(model).size()) return "values that materials remember";
    if (state.rigid.size() != model.rigid.size()) return "number of rigid bodies";
    for (const model::RigidMotion& motion : state.rigid)
        if (!(std::abs(motion.orientation.norm() - 1) < 1e-9) || !motion.rotation.allFinite() ||
            !motion.velocity.allFinite() || !motion.acceleration.allFinite() || !motion.angular_velocity.allFinite() ||
            !motion.angular_rate.allFinite() || !motion.moment.allFinite())
            return "motions of rigid bodies";
    if (!finite(state.u) || !finite(state.v) || !finite(state.a) || !finite(checkpoint.displacement_start))
        return "values that are not finite";
    const std::vector<FoundPair>& found = checkpoint.found;
    if (state.contact.size() != model.pairs.size() + found.size() ||
        checkpoint.patches.size() != state.contact.size() || (!found.empty() && !model.general))
        return "number of contact pairs";
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
        const model::ContactPair& pair = *model.pairs[p];
        if (const std::string what = misfit(state.contact[p], static_cast<std::size_t>(pair.size()),
                                            pair.surface().facet_count(), pair.name());
            !what.empty())
            return what;
    }
    for (std::size_t k = 0; k < found.size(); ++k) {
        if (const std::string what = misfit(found[k], *model.general, model.nodes()); !what.empty()) return what;
        const auto& master = *model.general->surfaces()[static_cast<std::size_t>(found[k].master)].side;
        if (const std::string what = misfit(state.contact[model.pairs.size() + k], found[k].nodes.size(),
                                            master.surface().facet_count(), "general");
            !what.empty())
            return what;
    }
    if (model.general && (checkpoint.scope_x.size() != nodes || !finite(checkpoint.scope_x) ||
                          checkpoint.scope_margin.size() != model.general->surfaces().size() ||
                          checkpoint.scope_own.size() != model.general->surfaces().size()))
        return "scope of general contact";
    for (std::size_t k = 0; k < checkpoint.watched.size(); ++k)
        if (!model.general || checkpoint.watched.size() % 2 != 0 ||
            !within(checkpoint.watched[k],
                    k % 2 == 0 ? model.nodes() : static_cast<Index>(model.general->surfaces().size())))
            return "watched nodes of general contact";
    for (const auto& patches : checkpoint.patches)
        for (const contact::RefittedPatch& patch : patches)
            if (!finite(patch.at)) return "patches";
    return misfit(checkpoint.memory, model, found);
}

std::vector<FoundPair> found_pairs(const model::State& state, const model::Model& model) {
    std::vector<FoundPair> found;
    for (std::size_t p = model.pairs.size(); p < state.contact.size(); ++p) {
        const model::ContactPair& pair = *state.contact[p].pair;
        FoundPair& one = found.emplace_back();
        std::tie(one.slave, one.master) = model.general->sides_of(pair);
        const model::SlaveNodes& slaves = pair.slaves();
        one.nodes = slaves.node;
        for (std::size_t j = 0; j < slaves.yields.size(); ++j)
            if (slaves.yields[j] != 0) one.yielding.push_back(slaves.node[j]);
        if (slaves.edges)
            for (const auto& edges : slaves.edges->half_edges)
                one.edges.insert(one.edges.end(), edges.begin(), edges.end());
        for (const mesh::Facet& facet : pair.slaves().facets)
            one.facets.insert(one.facets.end(), facet.nodes.begin(), facet.nodes.end());
    }
    return found;
}

void restore_pairs(Checkpoint& checkpoint, const model::Model& model) {
    model::State& state = checkpoint.state;
    if (model.general) {
        model::ContactScope scope{checkpoint.scope_x, checkpoint.scope_margin, checkpoint.scope_own, {}};
        for (std::size_t k = 0; k < checkpoint.watched.size(); k += 2)
            scope.watched.push_back({checkpoint.watched[k], checkpoint.watched[k + 1]});
        scope.passed = model.general->passed(scope);
        state.scope = std::make_shared<const model::ContactScope>(std::move(scope));
    }
    for (std::size_t p = 0; p < model.pairs.size(); ++p) state.contact[p].pair = model.pairs[p];
    for (std::size_t k = 0; k < checkpoint.found.size(); ++k) {
        const FoundPair& one = checkpoint.found[k];
        std::shared_ptr<const model::ContactPair>& pair = state.contact[model.pairs.size() + k].pair;
        if (!one.edges.empty()) {
            std::vector<std::array<Index, 2>> edges;
            for (std::size_t e = 0; e < one.edges.size(); e += 2) edges.push_back({one.edges[e], one.edges[e + 1]});
            pair = model.general->make_edges(*state.scope, one.slave, one.master, edges);
            continue;
        }
        std::vector<mesh::Facet> facets(one.facets.size() / 4);
        for (std::size_t f = 0; f < facets.size(); ++f) {
            std::copy_n(one.facets.begin() + static_cast<std::ptrdiff_t>(4 * f), 4, facets[f].nodes.begin());
            facets[f].count = facets[f].nodes[3] < 0 ? 3 : 4;
        }
        pair =
            model.general->make_pair(*state.scope, one.slave, one.master, one.nodes, std::move(facets), one.yielding);
    }
}

} // namespace osculate::time
