#include "osculate/time/far_force.hpp"

#include "osculate/contact/surface_distance.hpp"
#include "time/number.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

namespace osculate::time {

namespace {

constexpr double sharp = 40 * std::numbers::pi / 180; ///< more is an edge, see contact::SurfaceAudit

double size_of(const mesh::Facet& facet, const Field& X) {
    return std::sqrt(mesh::facet_area_vector(facet, X).norm());
}

/// Slaves of one pair that carry a force.
class FarSlaves {
public:
    FarSlaves(const model::ContactEvaluation& contact, const Field& X, const Field& x, double allowed)
        : contact_(contact), pair_(contact.pair()), X_(X), x_(x), allowed_(allowed), vertices_(pair_.vertices(x)),
          master_(pair_.surface(), vertices_) {}

    /// Fills in all but pair and force. False where the slave is near.
    bool is_far(Index j, FarForce& far) {
        const double gap = std::abs(contact_.point(j).gap);
        if (pair_.slaves().edges) return is_far_edge(j, gap, far);
        const Index node = pair_.slaves().node[j];
        const Vec3& s = x_[node];
        // any facet that is near will do
        if (const Index f = contact_.hit(j).facet; f >= 0 && counts(f, {&node, 1}))
            if (master_.from(f, s) - gap <= allowed_ * pair_.surface().facet_size(f)) return false;
        const contact::NearFacet near = master_.closest(s, [&](Index f) { return counts(f, {&node, 1}); });
        if (near.facet < 0) return false;
        const double bulge = bulge_at(j, near.facet, far.length);
        const auto exceeds = [&](double distance) {
            const double beyond = distance - gap - bulge;
            far.excess = beyond <= 0 ? 0 : beyond; // NaN stays
            return !(far.relative() <= allowed_);
        };
        far.slave = j;
        far.distance = near.distance;
        if (!exceeds(near.distance)) return false;
        // an average over facets that are partly above the master may have its node beside it
        const Discretisation how = pair_.options().discretisation;
        const bool at_node =
            !averages(how) || (how == Discretisation::petrov_galerkin && !near.at_end && pair_.slaves().around.empty());
        return at_node || exceeds(std::min(distance_of_facets(j, near.distance), height_past_end(j, near)));
    }

private:
    bool is_far_edge(Index j, double gap, FarForce& far) const {
        const auto [own, other] = pair_.edges(j, x_, vertices_);
        far.slave = j;
        far.distance = contact::segment_distance(own.end[0], own.end[1], other.end[0], other.end[1]);
        far.excess = std::max(0.0, far.distance - gap);
        far.length = std::max((own.end[1] - own.end[0]).norm(), (other.end[1] - other.end[0]).norm());
        return !(far.relative() <= allowed_);
    }

    /// Whether a facet of the master is no facet at any of these nodes: a surface may touch itself.
    [[nodiscard]] bool counts(Index facet, std::span<const Index> nodes) const {
        if (!pair_.slaves().own) return true;
        return std::ranges::none_of(pair_.surface().facet_vertices(facet),
                                    [&](Index v) { return std::ranges::find(nodes, pair_.node(v)) != nodes.end(); });
    }

    /// Facets of the slave around a node.
    const std::vector<const mesh::Facet*>& around(Index j) {
        if (around_.empty())
            for (const mesh::Facet& facet : pair_.slaves().facets)
                for (const Index node : facet) around_[node].push_back(&facet);
        return around_[pair_.slaves().node[j]];
    }

    /// Largest turn of the normal between facets around a slave that are no edge, over their size, 1/m.
    double curvature(Index j) {
        double largest = 0;
        for (const mesh::Facet* a : around(j))
            for (const mesh::Facet* b : around(j)) {
                const Vec3 n = mesh::facet_area_vector(*a, x_), m = mesh::facet_area_vector(*b, x_);
                const double turn = std::atan2(n.cross(m).norm(), n.dot(m));
                if (turn <= sharp) largest = std::max(largest, 2 * turn / (size_of(*a, X_) + size_of(*b, X_)));
            }
        return largest;
    }

    /// @param h  becomes the size of the larger of the facets there, m
    double bulge_at(Index j, Index facet, double& h) {
        h = pair_.surface().facet_size(facet);
        for (const mesh::Facet* own : around(j)) h = std::max(h, size_of(*own, X_));
        const double sharpest = sharp / h;
        const double bend = std::min(curvature(j), sharpest) + std::min(master_.curvature(facet), sharpest);
        return h * h / 8 * bend + master_.warp(facet);
    }

    /// Least distance of the facets around a slave from the master, m, at most `most`.
    double distance_of_facets(Index j, double most) {
        for (const mesh::Facet* own : around(j)) {
            const std::span<const Index> nodes(own->nodes.data(), static_cast<std::size_t>(own->count));
            std::vector<Vec3> corners;
            for (const Index node : nodes) corners.push_back(x_[node]);
            most = master_.from(corners, most, [&](Index f) { return counts(f, nodes); });
        }
        return most;
    }

    /// Where a facet of the slave reaches back from past the master's end: how far its node is from the plane of a facet that ends
    /// there, in which the master goes on; else the distance, m.
    double height_past_end(Index j, const contact::NearFacet& near) {
        constexpr double tie = 1e-6; // of the distance
        const Vec3& s = x_[pair_.slaves().node[j]];
        double reach = 0, least = near.distance;
        for (const mesh::Facet* own : around(j))
            for (const Index node : *own) reach = std::max(reach, (x_[node] - s).norm());
        const auto look = [&](Index f) {
            if (master_.from(f, s) > near.distance * (1 + tie)) return;
            const auto v = pair_.surface().facet_vertices(f);
            const Vec3 &a = vertices_[v[0]],
                       n = (vertices_[v[1]] - a).cross(vertices_[v[v.size() - 1]] - a).normalized();
            const double height = std::abs(n.dot(s - a));
            if (near.distance * near.distance - height * height <= reach * reach) least = std::min(least, height);
        };
        look(near.facet);
        for (const Index f : pair_.surface().vertex_neighbours(near.facet)) look(f);
        return least;
    }

    const model::ContactEvaluation& contact_;
    const model::ContactPair& pair_;
    const Field &X_, &x_;
    double allowed_;
    std::vector<Vec3> vertices_;
    contact::SurfaceDistance master_;
    std::map<Index, std::vector<const mesh::Facet*>> around_; ///< (slave nodes) made when first asked for
};

bool has_exact_master(const model::Model& model, const model::ContactPair& pair) {
    const Index body = model::body_index(model, pair.master_nodes().front());
    return std::ranges::any_of(model.rigid,
                               [&](const model::RigidBody& rigid) { return rigid.shape && rigid.body == body; });
}

} // namespace

std::optional<FarForce> farthest_force(const model::Model& model, const model::ContactEvaluations& contact,
                                       const model::State& state, double allowed) {
    std::optional<FarForce> worst;
    Field x;
    for (std::size_t p = 0; p < contact.size(); ++p) {
        const model::ContactHistory& history = state.contact[p];
        std::optional<FarSlaves> slaves;
        for (Index j = 0; j < contact[p].pair().size(); ++j) {
            if (!contact::is_closed(history.status[j]) || history.lambda[j].isZero(0)) continue;
            if (!slaves) {
                if (has_exact_master(model, contact[p].pair())) break;
                if (x.empty()) x = sum(model.X, state.u);
                slaves.emplace(contact[p], model.X, x, allowed);
            }
            FarForce far;
            if (!slaves->is_far(j, far) || (worst && !(far.relative() > worst->relative()))) continue;
            far.pair = static_cast<Index>(p);
            far.force = history.lambda[j].norm();
            worst = far;
        }
    }
    return worst;
}

std::string in_words(const FarForce& far, const model::ContactPair& pair, const model::Model& model) {
    const Index node = pair.slaves().node[far.slave];
    const model::Body* const body = model::body_of(model, node);
    return "pair '" + pair.name() + "' puts a contact force of " + number(far.force) + " N on node " +
           std::to_string(body != nullptr ? model::material_node(model, node) - body->first_node : node) +
           (body != nullptr ? " of body '" + body->name + "'" : "") + ", which is " + number(far.distance) +
           " m from the closest facet of the master";
}

} // namespace osculate::time
