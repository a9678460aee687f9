/// Contact pairs of a plan.

#include "app/fault.hpp"
#include "app/plan/contact_pairs.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/gaps.hpp"
#include "app/plan/loose_slaves.hpp"
#include "app/plan/rigid_surface.hpp"
#include "osculate/model/general_contact.hpp"
#include "osculate/time/audit.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace osculate::app {

void add_pairs(Draft& draft) {
    const bool paths = std::ranges::any_of(draft.plan.stages, &time::Stage::follow_paths);
    for (const auto& [name, spec] : draft.plan.contact) {
        const model::Set& slave = draft.contact_set(spec.slave);
        const model::Set& master = draft.contact_set(master_set(spec.master));
        const std::string key = "contact." + name;
        bool broken = false;
        const std::map<Index, Vec3> loose = loose_slaves(draft, spec.slave);
        if (const auto inside = std::ranges::find_if(loose, [](const auto& one) { return one.second.isZero(0); });
            inside != loose.end()) {
            const Vec3 X = draft.plan.model.X[static_cast<std::size_t>(inside->first)] + draft.plan.model.origin;
            draft.faults.push_back(fault(key + ".slave", "nodes on the outside of their body",
                                         fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m inside", X[0], X[1], X[2])));
            continue;
        }
        for (const auto& [part, group] : {std::pair{".slave", &slave}, std::pair{".master.set", &master}})
            if (group->facets.empty() && (group == &master || loose.empty())) {
                draft.faults.push_back(fault(key + part, "a set with facets", "a set of nodes that cover no facet"));
                broken = true;
            }
        if (broken) continue;
        const ScopedTimer timer(draft.timings, Part::patches);
        try {
            draft.plan.model.pairs.push_back(
                make_contact_pair(draft.scene, name, spec, draft.plan.model, slave, master, loose,
                                  paths ? &draft.plan.model.bodies[master.body].exterior : nullptr));
        } catch (const std::runtime_error& error) {
            draft.faults.push_back(fault(key + ".master.set", "an oriented manifold surface", error.what()));
        }
    }
}

void add_changes_of_pairs(Draft& draft) {
    model::ContactPairs now = draft.plan.model.pairs;
    bool changed = false;
    std::size_t s = 0;
    for (const auto& [name, spec] : draft.scene.stages) {
        for (auto& pair : now) {
            model::ContactOptions options = pair->options();
            if (const double* friction = scene::find(spec.friction, pair->name())) options.friction = *friction;
            if (const bool* in_force = scene::find(spec.pairs, pair->name())) options.in_force = *in_force;
            if (const auto* law = scene::find(spec.pressure_overclosure, pair->name()))
                options.overclosure = law_of(*law);
            if (options == pair->options()) continue;
            pair = std::make_shared<const model::ContactPair>(*pair, options);
            changed = true;
        }
        if (changed) draft.plan.stages[s].pairs = now;
        ++s;
    }
}

namespace {
/// A rigid body does not change its shape: it does not meet itself.
void keep_rigid_bodies_from_themselves(scene::Scene& scene) {
    for (const auto& [name, body] : scene.bodies) {
        if (!body.rigid) continue;
        scene::GeneralRule apart;
        apart.between = {name, name};
        apart.contact = false;
        scene.general->pairs.emplace_back("rigid " + name, apart);
    }
}
} // namespace

void add_general_contact(Draft& draft) {
    if (!draft.plan.general) return;
    const bool dynamic =
        std::ranges::any_of(draft.plan.stages, [](const time::Stage& s) { return s.dynamics.has_value(); });
    const ScopedTimer timer(draft.timings, Part::patches);
    keep_rigid_bodies_from_themselves(draft.scene);
    try {
        draft.plan.model.general = make_general_contact(draft.scene, draft.plan.model, draft.outer_skins, dynamic);
    } catch (const std::runtime_error& error) {
        draft.faults.push_back(
            fault("contact.general", "bodies whose outer surfaces are oriented manifolds", error.what()));
        return;
    }
    const model::GeneralContact& general = *draft.plan.model.general;
    model::ContactScope& scope = draft.plan.scope_at_start.emplace(general.scope_at(draft.plan.model.X, 0));
    draft.plan.near_at_start = general.near(scope, {});
}

namespace {
/// General contact finds nodes that are near a surface. Of a body drawn deeper inside another it sees nothing; the audit does.
void check_depths(Draft& draft) {
    double limit = draft.plan.general->initial_overlap_limit;
    for (const auto& [name, pair] : draft.plan.contact) limit = std::max(limit, pair.initial_overlap_limit);
    time::Audit audit(draft.plan.model);
    audit.examine(Field(draft.plan.model.X.size()));
    const std::optional<contact::Intrusion> deepest = audit.deepest();
    if (!deepest || deepest->relative() <= limit) return;
    draft.faults.push_back(fault(
        "contact.general",
        fmt::format("bodies that are inside one another by less than {:.3g} of the facet size at the start", limit),
        fmt::format("{:.3g} of the facet size: {}", deepest->relative(), time::in_words(*deepest, draft.plan.model))));
}
} // namespace

void check_gaps(Draft& draft) {
    const std::size_t before = draft.faults.size();
    const auto check = [&](const model::ContactPair& pair, double limit, const std::string& key) {
        model::ContactEvaluation evaluation(pair);
        const PairGaps gaps = initial_gaps(evaluation, draft.plan.model.X, draft.timings, draft.threads);
        if (gaps.largest_overlap > limit)
            draft.faults.push_back(
                fault(key, fmt::format("bodies that overlap by less than {:.3g} of the facet size at the start", limit),
                      fmt::format("an overlap of {:.4g} m at slave {}, {:.3g} of the facet size", -gaps.least,
                                  node_name(draft.plan.model, gaps.worst_node), gaps.largest_overlap)));
    };
    for (std::size_t p = 0; p < draft.plan.model.pairs.size(); ++p)
        check(*draft.plan.model.pairs[p], draft.plan.contact[p].second.initial_overlap_limit,
              "contact." + draft.plan.contact[p].first);
    for (const model::ContactHistory& history : draft.plan.near_at_start)
        check(*history.pair, draft.plan.general->initial_overlap_limit, "contact.general");
    if (draft.plan.general && draft.audited() && draft.faults.size() == before) check_depths(draft);
}

} // namespace osculate::app
