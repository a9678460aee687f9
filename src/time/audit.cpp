#include "osculate/time/audit.hpp"

#include "osculate/model/general_contact.hpp"
#include "time/number.hpp"

#include <algorithm>

namespace osculate::time {

namespace {

std::vector<std::vector<mesh::Facet>> outer_facets(const model::Model& model) {
    std::vector<std::vector<mesh::Facet>> bodies;
    for (const model::Body& body : model.bodies) bodies.push_back(model::exterior_facets(body));
    return bodies;
}

/// Without those of exact surfaces, whose facets stand for them only.
std::vector<std::vector<mesh::Facet>> facets_to_audit(const model::Model& model,
                                                      std::vector<std::vector<mesh::Facet>> bodies) {
    for (const model::RigidBody& rigid : model.rigid)
        if (rigid.shape) bodies[static_cast<std::size_t>(rigid.body)].clear();
    return bodies;
}

std::pair<Index, Index> ordered(Index a, Index b) {
    return {std::min(a, b), std::max(a, b)};
}

} // namespace

Audit::Audit(const model::Model& model) : Audit(model, outer_facets(model)) {}

Audit::Audit(const model::Model& model, const std::vector<std::vector<mesh::Facet>>& outer)
    : model_(model), surfaces_(facets_to_audit(model, outer), model.X), exact_(model, outer) {
    for (const contact::Intrusion& one : surfaces_.drawn().intrusions)
        drawn_[ordered(one.body, one.other)] = one.excess;
    // contact lifts what overlaps, but not where curved surfaces are tied
    const auto tied = [&](const std::pair<Index, Index>& bodies) {
        return std::ranges::any_of(
            model.ties, [&](const model::Tie& tie) { return ordered(tie.slave_body, tie.master_body) == bodies; });
    };
    if (model.general)
        std::erase_if(drawn_, [&](const auto& one) {
            return model.general->meet(one.first.first, one.first.second) && !tied(one.first);
        });
    for (const auto& pair : model.pairs)
        if (const auto bodies = ordered(model::body_index(model, pair->slaves().node.front()),
                                        model::body_index(model, pair->master_nodes().front()));
            !tied(bodies))
            drawn_.erase(bodies);
}

const contact::AuditResult& Audit::examine(const Field& u) {
    const Field x = sum(model_.X, u);
    result_ = surfaces_.examine(x);
    if (!exact_.empty()) exact_.examine(x, result_);
    return result_;
}

std::optional<contact::Intrusion> Audit::deepest() const {
    std::optional<contact::Intrusion> worst;
    for (contact::Intrusion one : result_.intrusions) {
        if (model_.general && model_.general->pass_through(one.body, one.other)) continue;
        if (apart_.contains(ordered(one.body, one.other))) continue;
        const auto drawn = drawn_.find(ordered(one.body, one.other));
        if (drawn != drawn_.end()) one.excess = std::max(0.0, one.excess - drawn->second);
        if (!worst || one.relative() > worst->relative()) worst = one;
    }
    return worst;
}

std::string in_words(const contact::Intrusion& intrusion, const model::Model& model) {
    const model::Body& body = model.bodies[static_cast<std::size_t>(intrusion.body)];
    const Vec3 at = intrusion.place + model.origin;
    return (intrusion.edge    ? "an edge at node "
            : intrusion.facet ? "a facet at node "
                              : "node ") +
           std::to_string(intrusion.node - body.first_node) + " of body '" + body.name + "' lies " +
           number(intrusion.depth) + " m deep in " +
           (intrusion.other == intrusion.body
                ? "the body itself"
                : "body '" + model.bodies[static_cast<std::size_t>(intrusion.other)].name + "'") +
           ", at (" + number(at.x()) + ", " + number(at.y()) + ", " + number(at.z()) + ") m";
}

} // namespace osculate::time
