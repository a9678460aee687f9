/// Ties of a plan.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/face_projection.hpp"
#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/dual_weights.hpp"
#include "osculate/mesh/quality.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <string>

namespace osculate::app {

namespace {

/// How far a node may be from the master by default, in facet sizes of this.
constexpr double near = 0.25;
/// Facets of the slave are tied by their part above the master if it is no sliver.
constexpr double least_cover = 1e-3;
/// A weight below this is round-off.
constexpr double vanishing = 1e-9;

/// Finds what the nodes of a slave follow.
class TieMaker {
public:
    TieMaker(const Draft& draft, const model::Set& slave, const model::Set& master, std::optional<double> distance)
        : draft_(draft), slave_(slave), master_(master), X_(draft.plan.model.X.values()), surface_(master.facets, X_),
          facets_(contact::make_facets_surface(surface_)), search_(surface_), distance_(distance),
          slaves_(mesh::nodes_of(slave.facets)) {
        for (const Index node : surface_.vertex_nodes()) vertices_.push_back(X_[static_cast<std::size_t>(node)]);
        search_.build(vertices_);
        for (const Index node : slaves_) {
            S_.push_back(X_[static_cast<std::size_t>(node)]);
            const contact::FacetHit hit = search_.global(S_.back(), vertices_);
            hits_.push_back(hit);
            const bool far = hit.facet < 0 || hit.distance > distance_.value_or(near * surface_.facet_size(hit.facet));
            far_.push_back(far);
            if (hit.facet < 0) continue;
            nearest_ = std::min(nearest_, hit.distance);
            if (hit.overhang == 0) farthest_above_ = std::max(farthest_above_, hit.distance);
            above_ += far && hit.overhang == 0 ? 1 : 0;
        }
        std::vector<contact::SlaveFacet> all;
        for (const mesh::Facet& facet : slave.facets) {
            contact::SlaveFacet& corners = all.emplace_back();
            for (const Index node : facet)
                corners.node[static_cast<std::size_t>(corners.count++)] =
                    static_cast<Index>(std::ranges::lower_bound(slaves_, node) - slaves_.begin());
        }
        weights_ = std::make_unique<contact::DualWeights>(surface_, all, S_, least_cover);
    }

    [[nodiscard]] model::Tie make() {
        const contact::PairPositions at{*facets_, search_, S_, vertices_};
        weights_->begin(at);
        for (Index f = 0; f < weights_->facet_count(); ++f) {
            const contact::SlaveFacet& corners = weights_->corners(f);
            if (std::ranges::any_of(corners, [&](Index j) { return far_[static_cast<std::size_t>(j)] != 0; })) continue;
            std::vector<Index> seeds;
            for (const Index j : corners)
                for (const Index v : surface_.facet_vertices(hits_[static_cast<std::size_t>(j)].facet)) {
                    const auto around = surface_.vertex_facets(v);
                    seeds.insert(seeds.end(), around.begin(), around.end());
                }
            weights_->update(f, at, std::move(seeds));
        }
        const std::map<Index, std::map<Index, double>> follow = linear() ? of_facets() : of_faces();
        model::Tie tie;
        tie.near = near * surface_.mean_facet_size();
        for (const Index node : slaves_) {
            const auto found = follow.find(node);
            if (found == follow.end()) {
                ++tie.left_out;
                continue;
            }
            model::TiedNode& tied = tie.nodes.emplace_back();
            tied.node = node;
            for (const auto& [carrier, weight] : found->second)
                if (std::abs(weight) > vanishing) tied.carriers.emplace_back(carrier, weight);
        }
        return tie;
    }

    [[nodiscard]] double nearest() const { return nearest_; }
    /// Nodes above the master that are too far from it, and the distance of the farthest above it, m.
    [[nodiscard]] Index above() const { return above_; }
    [[nodiscard]] double farthest_above() const { return farthest_above_; }

private:
    using Weights = std::map<Index, std::map<Index, double>>; ///< of nodes of the master, by nodes of the slave

    [[nodiscard]] const model::Body& body(const model::Set& set) const {
        return draft_.plan.model.bodies[static_cast<std::size_t>(set.body)];
    }
    [[nodiscard]] std::vector<mesh::SurfaceFace> faces(const model::Set& set) const {
        return mesh::surface_faces(body(set).mesh, set.facets, body(set).first_node);
    }
    /// Whether no face has midside nodes.
    [[nodiscard]] bool linear() const {
        const auto flat = [&](const model::Set& set) {
            return std::ranges::all_of(body(set).mesh.blocks, [](const mesh::ElementBlock& block) {
                return mesh::cell_info(block.type).edges.empty();
            });
        };
        return flat(slave_) && flat(master_);
    }

    [[nodiscard]] Weights of_facets() const {
        Weights result;
        for (Index j = 0; j < static_cast<Index>(slaves_.size()); ++j) {
            if (!(weights_->share(j) > 0)) continue;
            std::vector<Index> carriers;
            weights_->add_vertices(j, carriers);
            std::ranges::sort(carriers);
            carriers.erase(std::unique(carriers.begin(), carriers.end()), carriers.end());
            Vector W = Vector::Zero(static_cast<Index>(carriers.size()));
            weights_->add_weights(j, carriers, W);
            std::map<Index, double>& own = result[slaves_[static_cast<std::size_t>(j)]];
            for (std::size_t i = 0; i < carriers.size(); ++i)
                own[surface_.vertex_nodes()[static_cast<std::size_t>(carriers[i])]] = W(static_cast<Index>(i));
        }
        return result;
    }

    [[nodiscard]] Weights of_faces() const {
        FaceProjection projection(slave_.facets, faces(slave_), master_.facets, faces(master_), X_);
        for (Index f = 0; f < weights_->facet_count(); ++f) projection.add(*weights_, f);
        Weights result = projection.weights();
        for (auto& [node, own] : result)
            for (auto& [carrier, weight] : own)
                if (std::abs(weight - 1) < vanishing) weight = 1; // a node on a node
        return result;
    }

    const Draft& draft_;
    const model::Set &slave_, &master_;
    const std::vector<Vec3>& X_;
    mesh::HalfEdgeSurface surface_;
    std::shared_ptr<const contact::MasterSurface> facets_;
    contact::FacetSearch search_;
    std::optional<double> distance_;
    std::vector<Index> slaves_;
    std::vector<Vec3> S_, vertices_;
    std::vector<contact::FacetHit> hits_;
    std::vector<char> far_;
    std::unique_ptr<contact::DualWeights> weights_;
    double nearest_ = std::numeric_limits<double>::infinity(), farthest_above_ = 0;
    Index above_ = 0;
};

/// Moves tied nodes onto the surfaces that they follow: those that are there turn with them.
void adjust(model::Model& m, model::Tie& tie) {
    model::Body& body = m.bodies[static_cast<std::size_t>(tie.slave_body)];
    for (const model::TiedNode& tied : tie.nodes) {
        Vec3 X = Vec3::Zero();
        for (const auto& [node, weight] : tied.carriers) X += weight * m.X[static_cast<std::size_t>(node)];
        Vec3& own = m.X[static_cast<std::size_t>(tied.node)];
        tie.adjusted = std::max(tie.adjusted, (X - own).norm());
        own = body.mesh.nodes[static_cast<std::size_t>(tied.node - body.first_node)] = X;
    }
}

} // namespace

Mat3 axes_at(const Draft& draft, const scene::Support* support, Index node) {
    if (support == nullptr) return Mat3::Identity();
    if (!support->cylinder) return support->axes;
    const model::Model& m = draft.plan.model;
    const Vec3 axis = support->cylinder->direction.normalized(),
               arm = m.X[static_cast<std::size_t>(node)] + m.origin - support->cylinder->point,
               radius = arm - axis * axis.dot(arm);
    Mat3 axes;
    axes.col(0) = radius.normalized();
    axes.col(1) = axis.cross(axes.col(0));
    axes.col(2) = axis;
    return axes;
}

std::map<Index, Mat3> free_directions(const Draft& draft) {
    std::map<Index, Mat3> free;
    for (const auto& [set, support] : draft.scene.supports)
        for (const Index node : draft.set(set).nodes)
            for (int k = 0; k < 3; ++k)
                if (support.fixed[static_cast<std::size_t>(k)]) {
                    Mat3& P = free.try_emplace(node, Mat3::Identity()).first->second;
                    const Vec3 d = P * axes_at(draft, &support, node).col(k); // less what others hold
                    if (d.norm() > vanishing) P -= d * d.transpose() / d.squaredNorm();
                }
    return free;
}

void add_ties(Draft& draft) {
    model::Model& m = draft.plan.model;
    const auto place = [&](Index node) {
        const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
        return fmt::format("[{:.6g}, {:.6g}, {:.6g}] m", X[0], X[1], X[2]);
    };
    std::map<Index, std::string> follows; // node -> what it follows
    for (const model::RigidBody& body : m.rigid)
        for (const Index node : body.nodes)
            follows.emplace(node, (body.coupling ? "couplings." : "bodies.") + body.name);
    const std::map<Index, Mat3> free = free_directions(draft);
    for (const auto& [name, spec] : draft.scene.ties) {
        const std::string key = "ties." + name;
        const model::Set &slave = draft.set(spec.slave), &master = draft.set(spec.master);
        bool surfaces = true;
        for (const auto& [word, set] : {std::pair{"slave", &slave}, std::pair{"master", &master}})
            if (set->facets.empty()) {
                draft.faults.push_back(
                    fault(key + "." + word, "a surface", "set '" + set->name + "', which has nodes alone"));
                surfaces = false;
            }
        if (!surfaces) continue;
        TieMaker maker(draft, slave, master, spec.distance);
        model::Tie tie = maker.make();
        tie.name = name;
        tie.slave_body = slave.body;
        tie.master_body = master.body;
        if (tie.nodes.empty()) {
            draft.faults.push_back(
                fault(key + ".slave", "nodes near the master, or a larger `distance`",
                      fmt::format("none above it: the nearest is {:.3g} m from it", maker.nearest())));
            continue;
        }
        if (!spec.distance && maker.above() > 0) {
            draft.faults.push_back(fault(key + ".distance",
                                         "a distance: up to where nodes are tied, and moved onto the master",
                                         fmt::format("none, and {} nodes above the master that are more than a quarter "
                                                     "of a facet from it, up to {:.3g} m",
                                                     maker.above(), maker.farthest_above())));
            continue;
        }
        for (model::TiedNode& tied : tie.nodes) {
            if (const auto other = follows.find(tied.node); other != follows.end()) {
                draft.faults.push_back(
                    fault(key + ".slave", "nodes that follow nothing else",
                          fmt::format("a node at {} that follows {} too", place(tied.node), other->second)));
                break;
            }
            if (const auto at = free.find(tied.node); at != free.end()) tied.free = at->second;
        }
        for (const model::TiedNode& tied : tie.nodes) follows.emplace(tied.node, key);
        m.ties.push_back(std::move(tie));
    }
    if (!draft.faults.empty()) return;
    for (const model::Tie& tie : m.ties)
        for (const model::TiedNode& tied : tie.nodes)
            for (const auto& [node, weight] : tied.carriers)
                if (const auto other = follows.find(node); other != follows.end()) {
                    draft.faults.push_back(
                        fault("ties." + tie.name + ".master",
                              "nodes that follow nothing else: swap slave and master, here or there",
                              fmt::format("a node at {} that follows {}", place(node), other->second)));
                    return;
                }
    for (const auto& [stage_name, stage] : draft.scene.stages)
        for (const auto& [set, components] : stage.displacement)
            for (const Index node : draft.set(set).nodes)
                if (const auto at = follows.find(node); at != follows.end() && at->second.starts_with("ties.")) {
                    draft.faults.push_back(fault("stages." + stage_name + ".displacement." + set,
                                                 "nodes that follow no others: drive the tie's master, or swap the two",
                                                 fmt::format("a node at {} that follows {}", place(node), at->second)));
                    break;
                }
    for (model::Tie& tie : m.ties) {
        adjust(m, tie);
        for (const std::string& what : mesh::faults(m.bodies[static_cast<std::size_t>(tie.slave_body)].mesh))
            draft.faults.push_back(fault("ties." + tie.name + ".distance",
                                         "a smaller one: elements fold where nodes are moved onto the master", what));
    }
}

} // namespace osculate::app
