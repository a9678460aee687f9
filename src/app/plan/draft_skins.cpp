/// Skins of bodies whose elements have midside nodes.

#include "app/fault.hpp"
#include "app/plan/contact_pairs.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/rigid_surface.hpp"
#include "osculate/fe/face_skin.hpp"

#include <fmt/format.h>
#include <map>
#include <optional>

namespace osculate::app {

namespace {

/// Adds skins to a model, each for a surface.
class SkinMaker {
public:
    explicit SkinMaker(Draft& draft) : draft_(draft), free_(free_directions(draft)) {
        for (const model::RigidBody& body : draft.plan.model.rigid)
            for (const Index node : body.nodes)
                follows_.emplace(node, (body.coupling ? "couplings." : "bodies.") + body.name);
        for (const model::Tie& tie : draft.plan.model.ties)
            for (const model::TiedNode& tied : tie.nodes) follows_.emplace(tied.node, "ties." + tie.name);
    }

    /// The surface with nodes of a skin; none where it needs none. A rigid body shows its facets as they are.
    std::optional<model::Set> skin(const model::Set& surface, const std::string& key) {
        model::Model& m = draft_.plan.model;
        const model::Body& body = m.bodies[static_cast<std::size_t>(surface.body)];
        if (body.rigid) return {};
        std::vector<fe::SkinWeights> all = fe::skin_weights(body.mesh, surface.facets, body.first_node, m.X.values());
        if (all.empty()) return {};
        std::map<Index, Index> own; // node of an element -> of the skin
        for (fe::SkinWeights& weights : all) {
            for (const auto& [node, weight] : weights.carriers)
                if (const auto other = follows_.find(node); other != follows_.end()) {
                    const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
                    draft_.faults.push_back(fault(key,
                                                  "nodes that follow nothing else, as its elements have midside nodes",
                                                  fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m that follows {}",
                                                              X[0], X[1], X[2], other->second)));
                    return {};
                }
            model::SkinNode& one = m.skin.emplace_back();
            one.node = m.nodes();
            one.host = weights.node;
            one.carriers = std::move(weights.carriers);
            if (const auto at = free_.find(one.host); at != free_.end()) one.free = at->second;
            const Vec3 X = m.X[static_cast<std::size_t>(one.host)];
            m.X.values().push_back(X);
            own.emplace(one.host, one.node);
        }
        model::Set skin = surface;
        for (Index& node : skin.nodes)
            if (const auto at = own.find(node); at != own.end()) node = at->second; // nodes of no facet stay
        for (mesh::Facet& facet : skin.facets)
            for (int c = 0; c < facet.count; ++c) {
                Index& node = facet.nodes[static_cast<std::size_t>(c)];
                node = own.at(node);
            }
        return skin;
    }

private:
    Draft& draft_;
    std::map<Index, Mat3> free_;
    std::map<Index, std::string> follows_;
};

} // namespace

void add_skins(Draft& draft) {
    SkinMaker maker(draft);
    const auto add = [&](const std::string& name, const std::string& key) {
        if (draft.skins.contains(name)) return;
        const model::Set& set = draft.set(name);
        if (set.facets.empty()) return; // found wanting by add_pairs
        if (auto skin = maker.skin(set, key)) draft.skins.emplace(name, std::move(*skin));
    };
    for (const auto& [name, pair] : draft.plan.contact) {
        add(pair.slave, "contact." + name + ".slave");
        add(master_set(pair.master), "contact." + name + ".master.set");
    }
    if (!draft.scene.general) return;
    for (std::size_t b = 0; b < draft.plan.model.bodies.size(); ++b) {
        if (draft.scene.bodies[b].second.rigid_surface) continue;
        const model::Set outer = outer_surface(draft.scene, draft.plan.model, static_cast<Index>(b));
        if (auto skin = maker.skin(outer, "contact.general"))
            draft.outer_skins.emplace(static_cast<Index>(b), std::move(*skin));
    }
}

} // namespace osculate::app
