/// Sectors of a plan that stand for whole rings, and supports about an axis.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "osculate/mesh/quality.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace osculate::app {

namespace {

/// How far a node may be from the place of its like by default, of the shortest distance between nodes there.
constexpr double near_like = 0.01;
/// Distance from an axis, of the distance from its point, below which no direction is radial.
constexpr double on_axis = 1e-9;
/// Cosine from which faces lie on each other.
constexpr double facing = 0.9;

double from_axis(const Vec3& arm, const Vec3& axis) {
    return (arm - axis * axis.dot(arm)).norm();
}

/// For each of some places the number of the nearest of others, and how far it is.
std::vector<std::pair<std::size_t, double>> nearest(const std::vector<Vec3>& places, const std::vector<Vec3>& others) {
    std::vector<std::size_t> order(others.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return others[i].x(); });
    std::vector<std::pair<std::size_t, double>> found;
    for (const Vec3& place : places) {
        std::pair<std::size_t, double> best{0, std::numeric_limits<double>::infinity()};
        const auto look = [&](std::size_t i) {
            const double distance = (others[i] - place).norm();
            if (distance < best.second || (distance == best.second && i < best.first)) best = {i, distance};
            return std::abs(others[i].x() - place.x()) <= best.second;
        };
        const auto middle =
            std::ranges::lower_bound(order, place.x(), {}, [&](std::size_t i) { return others[i].x(); });
        for (auto at = middle; at != order.end() && look(*at); ++at) {
        }
        for (auto at = middle; at != order.begin() && look(*std::prev(at)); --at) {
        }
        found.push_back(best);
    }
    return found;
}

double shortest_distance(const std::vector<Vec3>& places) {
    double shortest = std::numeric_limits<double>::infinity();
    std::vector<Vec3> sorted = places;
    std::ranges::sort(sorted, {}, [](const Vec3& x) { return x.x(); });
    for (std::size_t i = 0; i < sorted.size(); ++i)
        for (std::size_t j = i + 1; j < sorted.size() && sorted[j].x() - sorted[i].x() < shortest; ++j)
            shortest = std::min(shortest, (sorted[j] - sorted[i]).norm());
    return shortest;
}

class RingMaker {
public:
    RingMaker(Draft& draft, const std::string& name, const scene::CyclicSymmetry& spec)
        : draft_(draft), key_("cyclic." + name), spec_(spec), axis_(spec.axis.direction.normalized()) {
        ring_.name = name;
        ring_.axis = axis_;
        ring_.point = spec.axis.point - draft.plan.model.origin;
    }

    /// False if there are faults.
    [[nodiscard]] bool make() {
        const model::Set &slave = draft_.set(spec_.slave), &master = draft_.set(spec_.master);
        if (slave.body != master.body) return refuse(".master", "nodes of the slave's body", "'" + master.name + "'");
        ring_.body = slave.body;
        const std::vector<Vec3> S = places(slave.nodes), M = places(master.nodes);
        for (const auto& [key, set] : {std::pair{".slave", &slave}, std::pair{".master", &master}})
            for (const Index node : set->nodes)
                if (from_axis(X(node) - ring_.point, axis_) <= on_axis * (X(node) - ring_.point).norm())
                    return refuse(key, "nodes apart from the axis: hold those on it by supports",
                                  words(node) + ", on it");
        const double within = spec_.distance.value_or(near_like * shortest_distance(M)),
                     angle = 2 * std::numbers::pi / spec_.sectors;
        double worst[2];
        for (const int way : {0, 1}) {
            ring_.turn = Eigen::AngleAxisd(way == 0 ? angle : -angle, axis_).toRotationMatrix();
            std::vector<Vec3> turned;
            for (const Vec3& x : M) turned.push_back(ring_.point + ring_.turn * (x - ring_.point));
            const auto likes = nearest(S, turned);
            worst[way] = std::ranges::max(likes, {}, &std::pair<std::size_t, double>::second).second;
            if (worst[way] > within) continue;
            std::set<std::size_t> taken;
            for (std::size_t i = 0; i < S.size(); ++i) {
                if (!taken.insert(likes[i].first).second)
                    return refuse(".master", "one node for each of the slave",
                                  words(slave.nodes[i]) + " and another of the slave that have the same");
                ring_.nodes.push_back({slave.nodes[i], master.nodes[likes[i].first]});
                move(slave.nodes[i], turned[likes[i].first]);
            }
            return covers_ends(slave, master, within) && is_the_same_everywhere();
        }
        return refuse(".slave",
                      "nodes that the master's, turned by one sector about the axis, meet; or a larger `distance`",
                      fmt::format("one that is {:.3g} m from the nearest, and at most {:.3g} m are allowed",
                                  std::min(worst[0], worst[1]), within));
    }

    [[nodiscard]] model::CyclicSymmetry take() { return std::move(ring_); }

private:
    /// Faces that meet those of the next sector are ends, with all their nodes.
    bool covers_ends(const model::Set& slave, const model::Set& master, double within) {
        const model::Body& body = draft_.plan.model.bodies[static_cast<std::size_t>(ring_.body)];
        const std::vector<mesh::Facet>& facets = body.exterior;
        std::set<Index> known(slave.nodes.begin(), slave.nodes.end());
        known.insert(master.nodes.begin(), master.nodes.end());
        std::vector<Vec3> centres, turned, normals;
        for (const mesh::Facet& facet : facets) {
            Vec3 centre = Vec3::Zero();
            for (const Index node : facet) centre += X(body.first_node + node) / facet.count;
            centres.push_back(centre);
            turned.push_back(ring_.point + ring_.turn * (centre - ring_.point));
            normals.push_back(mesh::facet_area_vector(facet, body.mesh.nodes).normalized());
        }
        const auto likes = nearest(turned, centres);
        for (std::size_t f = 0; f < facets.size(); ++f) {
            const std::size_t g = likes[f].first;
            if (likes[f].second > within || normals[g].dot(ring_.turn * normals[f]) > -facing) continue;
            for (const mesh::Facet* facet : {&facets[f], &facets[g]})
                for (const Index local : *facet) {
                    const Index node = body.first_node + local;
                    if (known.contains(node) ||
                        from_axis(X(node) - ring_.point, axis_) <= on_axis * (X(node) - ring_.point).norm())
                        continue;
                    return refuse("", "slave and master with all nodes of the sector's ends",
                                  words(node) + ", on a face that meets the next sector's, in neither");
                }
        }
        return true;
    }

    /// Gravity and motions at the start, which are those of the whole scene.
    bool is_the_same_everywhere() {
        const model::Body& body = draft_.plan.model.bodies[static_cast<std::size_t>(ring_.body)];
        const scene::Body& spec = *scene::find(draft_.scene.bodies, body.name);
        const Vec3& g = draft_.scene.gravity;
        if (body.has_mass() && from_axis(g, axis_) > on_axis * g.norm())
            return refuse(".axis", "gravity along the axis: it is not the same in every sector otherwise",
                          "gravity across it");
        const Vec3 centre = model::centre_of_mass(body);
        double fastest = 0, off = 0;
        for (const model::LikeNode& one : ring_.nodes) {
            const auto v = [&](Index node) -> Vec3 {
                return spec.initial_velocity + spec.initial_spin.cross(X(node) - centre);
            };
            fastest = std::max(fastest, v(one.node).norm());
            off = std::max(off, (v(one.node) - ring_.turn * v(one.like)).norm());
        }
        if (off > near_like * fastest)
            return refuse(".slave", "initial velocities that are the same in every sector: along the axis, or about it",
                          fmt::format("two of which one, turned, differs by {:.3g} m/s from the other", off));
        return true;
    }

    [[nodiscard]] const Vec3& X(Index node) const { return draft_.plan.model.X[static_cast<std::size_t>(node)]; }
    [[nodiscard]] std::vector<Vec3> places(const std::vector<Index>& nodes) const {
        std::vector<Vec3> list;
        for (const Index node : nodes) list.push_back(X(node));
        return list;
    }
    [[nodiscard]] std::string words(Index node) const {
        const Vec3 at = X(node) + draft_.plan.model.origin;
        return fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m", at[0], at[1], at[2]);
    }
    bool refuse(const std::string& key, const std::string& expected, const std::string& found) {
        draft_.faults.push_back(fault(key_ + key, expected, found));
        return false;
    }
    void move(Index node, const Vec3& to) {
        model::Model& m = draft_.plan.model;
        model::Body& body = m.bodies[static_cast<std::size_t>(ring_.body)];
        m.X[static_cast<std::size_t>(node)] = body.mesh.nodes[static_cast<std::size_t>(node - body.first_node)] = to;
    }

    Draft& draft_;
    std::string key_;
    const scene::CyclicSymmetry& spec_;
    Vec3 axis_;
    model::CyclicSymmetry ring_;
};

/// Directions about an axis are none on the axis.
void check_cylinders(Draft& draft) {
    const model::Model& m = draft.plan.model;
    for (const auto& [set, support] : draft.scene.supports) {
        if (!support.cylinder) continue;
        if (!support.axes.isIdentity(0))
            draft.faults.push_back(fault("supports." + set + ".cylinder", "axes or cylinder", "both"));
        const Vec3 axis = support.cylinder->direction.normalized();
        for (const Index node : draft.set(set).nodes) {
            const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin, arm = X - support.cylinder->point;
            if (from_axis(arm, axis) > on_axis * arm.norm()) continue;
            draft.faults.push_back(fault("supports." + set + ".cylinder", "nodes apart from the axis",
                                         fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m, on it", X[0], X[1], X[2])));
            break;
        }
    }
}

} // namespace

void add_cyclic_symmetry(Draft& draft) {
    check_cylinders(draft);
    model::Model& m = draft.plan.model;
    if (draft.scene.cyclic.empty() || !draft.faults.empty()) return;
    std::map<Index, std::string> follows;
    for (const model::RigidBody& body : m.rigid)
        for (const Index node : body.nodes)
            follows.emplace(node, (body.coupling ? "couplings." : "bodies.") + body.name);
    for (const model::Tie& tie : m.ties)
        for (const model::TiedNode& tied : tie.nodes) follows.emplace(tied.node, "ties." + tie.name);
    const std::map<Index, Mat3> free = free_directions(draft);
    std::map<Index, Mat3> driven; // the same less what stages drive
    for (const auto& [name, stage] : draft.scene.stages)
        for (const auto& [set, components] : stage.displacement)
            for (const Index node : draft.set(set).nodes)
                for (int k = 0; k < 3; ++k)
                    if (components[static_cast<std::size_t>(k)]) {
                        const auto at = free.find(node);
                        Mat3& P = driven.try_emplace(node, at != free.end() ? at->second : Mat3(Mat3::Identity()))
                                      .first->second;
                        const Vec3 d = P * axes_at(draft, scene::find(draft.scene.supports, set), node).col(k);
                        if (d.norm() > on_axis) P -= d * d.transpose() / d.squaredNorm();
                    }
    for (const auto& [name, spec] : draft.scene.cyclic) {
        RingMaker maker(draft, name, spec);
        if (!maker.make()) continue;
        model::CyclicSymmetry ring = maker.take();
        const auto refuse = [&, &name = name](const std::string& key, const std::string& expected, Index node,
                                              const std::string& what) {
            const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
            draft.faults.push_back(
                fault("cyclic." + name + key, expected,
                      fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m {}", X[0], X[1], X[2], what)));
        };
        draft.rings.push_back(ring);
        std::set<Index> ends;
        for (const model::LikeNode& one : ring.nodes) ends.insert(one.node);
        std::erase_if(ring.nodes, [&](const model::LikeNode& one) { // what leads it in all directions is enough
            const auto at = driven.find(one.node);
            return at != driven.end() && at->second.norm() < near_like;
        });
        std::erase_if(ring.nodes, [&](const model::LikeNode& one) { // ties at both ends do what the ends would
            const auto tie = follows.find(one.node), other = follows.find(one.like);
            return tie != follows.end() && other != follows.end() && tie->second == other->second &&
                   tie->second.starts_with("ties.");
        });
        for (model::LikeNode& one : ring.nodes) {
            if (const auto other = follows.find(one.node); other != follows.end()) {
                refuse(".slave", "nodes that follow nothing else", one.node, "of " + other->second);
                break;
            }
            if (const auto other = follows.find(one.like); other != follows.end() || ends.contains(one.like)) {
                refuse(".master", "nodes that follow nothing else", one.like,
                       "that follows " + (other != follows.end() ? other->second : "cyclic." + name));
                break;
            }
            const auto held = free.find(one.node);
            const auto led = std::as_const(driven).find(one.node);
            if (led != driven.end() &&
                !led->second.isApprox(held != free.end() ? held->second : Mat3(Mat3::Identity()))) {
                refuse(".slave", "nodes that no stage drives, or in all directions", one.node,
                       "that is driven in some");
                break;
            }
            if (held != free.end()) one.free = held->second;
        }
        for (const model::LikeNode& one : ring.nodes) follows.emplace(one.node, "cyclic." + name);
        m.cyclic.push_back(std::move(ring));
    }
    if (!draft.faults.empty()) return;
    for (const model::CyclicSymmetry& ring : m.cyclic) {
        const model::Body& body = m.bodies[static_cast<std::size_t>(ring.body)];
        for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node) {
            const Vec3& X = m.X[static_cast<std::size_t>(node)];
            if (from_axis(X - ring.point, ring.axis) > on_axis * (X - ring.point).norm()) continue;
            const auto at = free.find(node);
            const Mat3 across = Mat3::Identity() - ring.axis * ring.axis.transpose();
            if (at != free.end() && (across * at->second).norm() < on_axis) continue;
            const Vec3 place = X + m.origin;
            draft.faults.push_back(
                fault("cyclic." + ring.name + ".axis",
                      "supports that hold the body's nodes on the axis across it: all sectors meet there",
                      fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m that is free across it", place[0], place[1],
                                  place[2])));
            break;
        }
        for (const std::string& what : mesh::faults(body.mesh))
            draft.faults.push_back(fault("cyclic." + ring.name + ".distance", "a smaller one: elements fold", what));
    }
}

namespace {

using Held = std::vector<const linear::NodeConstraint*>;

/// Whether constraints of a node leave it no direction.
bool hold_all(const Held& held) {
    Mat3 P = Mat3::Identity();
    for (const linear::NodeConstraint* c : held) P -= P * c->direction * c->direction.transpose();
    return P.norm() < near_like;
}

/// Whether a node's constraints prescribe a displacement along a direction, and the same as a constraint does.
bool prescribe(const Held& held, const Vec3& along, const linear::NodeConstraint& as) {
    constexpr double round_off = 1e-9;
    Mat3 P = Mat3::Identity();
    std::map<Index, double> by_course;
    by_course[as.course] = -as.target;
    double largest = std::abs(as.target);
    for (const linear::NodeConstraint* c : held) { // parallel or orthogonal to one another
        if ((P * c->direction).norm() < round_off) continue;
        const double share = c->direction.dot(along);
        P -= c->direction * c->direction.transpose();
        by_course[c->course] += share * c->target;
        largest = std::max(largest, std::abs(c->target));
    }
    return (P * along).norm() < near_like &&
           std::ranges::all_of(by_course, [&](const auto& one) { return std::abs(one.second) <= round_off * largest; });
}

} // namespace

void check_sectors(Draft& draft) {
    const model::Model& m = draft.plan.model;
    std::set<Index> follow; // what need not be held to be where it belongs
    for (const model::CyclicSymmetry& ring : m.cyclic)
        for (const model::LikeNode& one : ring.nodes) follow.insert(one.node);
    for (const model::Tie& tie : m.ties)
        for (const model::TiedNode& one : tie.nodes) follow.insert(one.node);
    for (const time::Stage& stage : draft.plan.stages) {
        std::map<Index, Held> at;
        for (const linear::NodeConstraint& c : stage.constraints) at[c.node].push_back(&c);
        for (const model::CyclicSymmetry& ring : draft.rings)
            for (const model::LikeNode& one : ring.nodes) {
                const Held &slave = at[one.node], &like = at[one.like];
                const bool alike = std::ranges::all_of(slave, [&](const linear::NodeConstraint* c) {
                    return prescribe(like, ring.turn.transpose() * c->direction, *c);
                });
                if (alike && (follow.contains(one.node) || hold_all(slave))) continue;
                const Vec3 X = m.X[static_cast<std::size_t>(one.node)] + m.origin;
                draft.faults.push_back(
                    fault("cyclic." + ring.name,
                          "supports and motions that are the same at both ends, turned, in every stage",
                          fmt::format("others at [{:.6g}, {:.6g}, {:.6g}] m than at its like in stage '{}': name both "
                                      "ends in one set, with cylinder where directions are not along the axis",
                                      X[0], X[1], X[2], stage.name)));
                return;
            }
    }
}

} // namespace osculate::app
