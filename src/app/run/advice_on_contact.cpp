/// Advice where bodies enter each other, or forces act far from the surface.

#include "app/run/adviser.hpp"
#include "osculate/model/general_contact.hpp"
#include "osculate/time/collision_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::app {

void Adviser::too_deep() {
    constexpr double least = 1e-6; // steps grow again once the surfaces touch
    const std::string why = "the node then moves less in a step";
    if (found_.cause == time::Cause::collision) { // shorter still: at the surface its depth is bounded, too
        constexpr double most = 0.02;
        return steps_smaller_by(std::min({failed_.decision.value, most, share_within_depth()}), least, why);
    }
    const time::StepLimits& limits = failed_.stage.limits;
    const double depth = std::abs(failed_.decision.value), unit = unit_of_depth();
    steps_smaller_by(limits.allowed_interpenetration * unit / depth, least, why);
    const std::string words = limits.in_metres ? " m" : " (of the facet size)";
    const double enough = margin * depth / unit;
    const std::string key = in_stage("control.allowed_interpenetration");
    const std::string text = "more than " + number(limits.allowed_interpenetration) + words + ", if a trial gap of " +
                             number(failed_.decision.value) +
                             " m does no harm: contact pushes the node back before the step is done";
    if (limits.in_metres && std::isfinite(enough))
        change(key, rounded(enough) + " m", text);
    else if (constexpr double largest = 1; !limits.in_metres && enough <= largest)
        change(key, rounded(enough), text);
    else
        add(key, text);
}

double Adviser::share_within_depth() const {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    if (!found_.contact || found_.contact->master_facet < 0 || !(found_.contact->gap < 0)) return unknown;
    const double beyond = 1 - failed_.decision.value, moved = -found_.contact->gap / beyond;
    const double depth =
        std::min(failed_.stage.limits.allowed_interpenetration * unit_of_depth(),
                 time::CollisionCheck::deepest * pair(found_.contact->pair)->thickness(found_.contact->master_facet));
    return beyond > 0 && moved > 0 ? depth / moved : unknown;
}

double Adviser::unit_of_depth() const {
    if (failed_.stage.limits.in_metres || !found_.contact || found_.contact->master_facet < 0) return 1;
    return pair(found_.contact->pair)->surface().facet_size(found_.contact->master_facet);
}

void Adviser::unseen() {
    if (failed_.decision.intrusion) return inside(*failed_.decision.intrusion);
    by_nodes(*failed_.last.contact[static_cast<std::size_t>(failed_.decision.pair)].pair);
}

void Adviser::by_nodes(const model::ContactPair& pair) {
    change(key_of(pair) + ".discretisation", "node",
           "node: averages over facets see neither edges against edges nor vertices");
}

std::vector<std::string> Adviser::sides_swapped(const model::ContactPair& pair) const {
    const auto named = [&](std::vector<Index> nodes) {
        std::ranges::sort(nodes);
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        const auto at = std::ranges::find(failed_.model.sets, nodes,
                                          [](const model::Set& set) { return mesh::nodes_of(set.facets); });
        return at == failed_.model.sets.end() ? std::string() : at->name;
    };
    const std::string slave = named(pair.slaves().node), master = named(pair.master_nodes());
    if (slave.empty() || master.empty()) return {};
    const std::string key = "contact." + pair.name();
    return {key + ".slave=" + master, key + ".master.set=" + slave};
}

void Adviser::inside(const contact::Intrusion& intrusion) {
    const model::Model& model = failed_.model;
    const auto name = [&](Index body) { return model.bodies[static_cast<std::size_t>(body)].name; };
    const std::string &body = name(intrusion.body), &other = name(intrusion.other);
    const auto joins = [&](const auto& pair) {
        const std::string &slave = body_of(model, pair->slaves().node.front())->name,
                          &master = body_of(model, pair->master_nodes().front())->name;
        return (slave == body && master == other) || (slave == other && master == body);
    };
    const auto pair = std::ranges::find_if(model.pairs, joins);
    const bool general = model.general && model.general->meet(intrusion.body, intrusion.other);
    if (!general && (intrusion.body == intrusion.other || pair == model.pairs.end())) {
        const std::string who = intrusion.body == intrusion.other
                                    ? "'" + body + "' from going through itself where its mesh resolves the folds"
                                    : "'" + body + "' and '" + other + "' apart";
        add("contact.general", "{}, which keeps " + who + ": no pair does", {"contact.general={}"});
    } else if (pair == model.pairs.end()) {
        found_.no_remedy = "general contact sees nodes against facets, and no node of '" + body + "' or '" + other +
                           "' met one here; a finer mesh of either may help";
    } else {
        const model::ContactPair& one = **pair;
        const std::vector<Index>& slaves = one.slaves().node;
        const bool known = std::ranges::count(slaves, intrusion.node) > 0;
        if (averages(one.options().discretisation)) by_nodes(one);
        if (intrusion.edge || intrusion.facet)
            edges_cross(one, intrusion);
        else if (!known)
            add("contact." + one.name() + ".slave",
                "the other side, or a surface that contains node " + std::to_string(found_.node) + " of body '" +
                    found_.body + "', which is not a slave node: contact keeps only slave nodes out of the other body",
                std::ranges::count(one.master_nodes(), intrusion.node) > 0 ? sides_swapped(one)
                                                                           : std::vector<std::string>{});
        constexpr double in_dynamics = 0.05; // the default there
        if (const time::StepLimits& limits = failed_.stage.limits;
            known && (limits.in_metres || limits.allowed_interpenetration > in_dynamics))
            change(in_stage("control.allowed_interpenetration"), number(in_dynamics),
                   number(in_dynamics) + ", so that no node passes through a surface");
    }
}

void Adviser::edges_cross(const model::ContactPair& pair, const contact::Intrusion& intrusion) {
    const std::string &slave = body_of(failed_.model, pair.slaves().node.front())->name,
                      &master = body_of(failed_.model, pair.master_nodes().front())->name;
    // two edges at right angles: one that is d deep lies inside the other's body over a length of about 2 d
    const double apart = 2 * failed_.stage.limits.audited_depth * intrusion.length;
    add("bodies." + slave + ".mesh",
        "slave nodes at most " + rounded(apart) + " m apart along its edges, and the mesh of '" + master +
            "' unchanged: contact sees nodes against facets, not edges against edges between their nodes, and with "
            "this spacing a node meets a facet before the edge is too deep");
}

void Adviser::far() {
    const model::ContactPair& pair = *failed_.last.contact[static_cast<std::size_t>(failed_.decision.pair)].pair;
    smaller_steps("nodes then move over fewer facets in a step");
    change(surface_key(pair), "facets", "facets, whose gaps are those of the mesh itself");
    if (averages(pair.options().discretisation))
        change(key_of(pair) + ".discretisation", "node", "node: the force then acts where the gap is");
}

} // namespace osculate::app
