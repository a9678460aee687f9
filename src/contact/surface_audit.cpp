#include "osculate/contact/surface_audit.hpp"

#include "contact/audit_shell.hpp"
#include "contact/box_tree.hpp"
#include "osculate/mesh/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace osculate::contact {

namespace {
using mesh::Triangle;

/// Of the facet size. Less deep is touching.
constexpr double touching = 1e-9;
/// What facets of a smooth surface turn by at most.
constexpr double crease = 40 * std::numbers::pi / 180;

struct Bounds {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;

    void extend(const Vec3& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    [[nodiscard]] bool meets(const Bounds& other) const {
        return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
    }
    [[nodiscard]] bool within(const Bounds& other) const {
        return (other.low.array() <= low.array()).all() && (high.array() <= other.high.array()).all();
    }
    [[nodiscard]] Box box() const { return {to_point(low), to_point(high)}; }
};

using Tree = bgi::rtree<Leaf, bgi::rstar<16>>;
} // namespace

/// One audit: trees and boxes of the bodies at the current positions, made where they are needed.
class SurfaceAudit::Examination {
public:
    Examination(const SurfaceAudit& audit, const std::vector<Vec3>& x)
        : audit_(audit), shells_(audit.shells_), x_(x), trees_(shells_.size()), bounds_(shells_.size()) {
        for (std::size_t b = 0; b < shells_.size(); ++b)
            for (const Index node : shells_[b].nodes) bounds_[b].extend(x[node]);
    }

    AuditResult run() {
        const auto bodies = static_cast<Index>(shells_.size());
        for (Index a = 0; a < bodies; ++a)
            for (Index b = a; b < bodies; ++b) {
                deepest_ = {};
                if (a == b) {
                    pass_through_itself(a);
                } else if (bounds_[a].meets(bounds_[b])) {
                    enter(a, b);
                    enter(b, a);
                }
                if (deepest_.body >= 0) result_.intrusions.push_back(deepest_);
            }
        for (const auto& [node, excess] : inside_) result_.nodes.emplace_back(node, excess);
        return std::move(result_);
    }

private:
    struct Side {
        double distance = 0; ///< < 0 inside
        Index facet = -1;
    };
    struct Foot {
        Index facet = -1;
        Triangle triangle;
        Vec3 closest; ///< its point that is closest
    };
    struct Crossing {
        double at = 0; ///< fraction of the edge
        Index facet = -1;
        double least = 0; ///< of the distances of both ends from the plane of the facet, m
    };

    [[nodiscard]] Bounds bounds(const mesh::Facet& facet) const {
        Bounds box;
        for (const Index node : facet) box.extend(x_[node]);
        return box;
    }

    const Tree& tree(Index body) {
        if (!trees_[body]) {
            std::vector<Leaf> leaves;
            leaves.reserve(shells_[body].facets.size());
            for (std::size_t f = 0; f < shells_[body].facets.size(); ++f)
                leaves.emplace_back(bounds(shells_[body].facets[f]).box(), static_cast<Index>(f));
            trees_[body].emplace(leaves.begin(), leaves.end());
        }
        return *trees_[body];
    }

    /// Of a quadrilateral two, along the diagonal from its first corner unless they would lie on one another.
    template <class Visit> void for_triangles(const mesh::Facet& facet, const Visit& visit) const {
        const auto triangle = [&](std::size_t i, std::size_t j, std::size_t k) {
            return Triangle{x_[facet.nodes[i]], x_[facet.nodes[j]], x_[facet.nodes[k]]};
        };
        const Triangle first = triangle(0, 1, 2);
        if (facet.count < 4) return visit(first);
        const Triangle second = triangle(0, 2, 3);
        if (first.normal().dot(second.normal()) >= 0) {
            visit(first);
            visit(second);
        } else {
            visit(triangle(0, 1, 3));
            visit(triangle(1, 2, 3));
        }
    }

    /// Signed distance from the surface of a body. At an edge or a vertex the mean of the normals of the triangles there tells the
    /// side, each with its angle as weight                                              [Baerentzen, Aanaes 2005].
    Side side(Index body, const Vec3& p) {
        constexpr double tie = 1e-7; // relative, of distances
        const Shell& shell = shells_[body];
        const Tree& boxes = tree(body);
        const Point at = to_point(p);
        const auto every = static_cast<unsigned>(shell.facets.size());
        for (unsigned k = 8;; k *= 2) {
            nearest_.clear();
            boxes.query(bgi::nearest(at, std::min(k, every)), std::back_inserter(nearest_));
            double reached = 0, least = std::numeric_limits<double>::infinity();
            Vec3 foot = Vec3::Zero();
            feet_.clear();
            for (const Leaf& leaf : nearest_) {
                const Index f = leaf.second;
                const double away = bg::distance(at, leaf.first);
                reached = std::max(reached, away);
                if (away > least * (1 + tie)) continue;
                for_triangles(shell.facets[f], [&](const Triangle& triangle) {
                    if (triangle.normal().isZero(0)) return;
                    const Vec3 closest = triangle.closest(p);
                    const double distance = (p - closest).norm();
                    if (distance > least * (1 + tie)) return;
                    feet_.push_back({f, triangle, closest});
                    if (distance >= least) return;
                    least = distance;
                    foot = closest;
                });
            }
            if (k < every && !(reached > least)) continue;
            Side found;
            Vec3 normal = Vec3::Zero();
            double steepest = -1; // of the facets there, the one turned to p most
            for (const Foot& one : feet_) {
                if (!((one.closest - foot).norm() <= tie * shell.size[one.facet])) continue;
                const Vec3 n = one.triangle.normal().normalized();
                normal += one.triangle.angle_at(one.closest, tie) * n;
                if (const double turned = std::abs(n.dot(p - foot)); turned > steepest) {
                    steepest = turned;
                    found.facet = one.facet;
                }
            }
            found.distance = normal.dot(p - foot) < 0 ? -least : least;
            return found;
        }
    }

    /// Largest turn of the normal from a facet to those around it that are no crease, over its size, 1/m.
    double curvature(const Shell& shell, Index f) const {
        const Vec3 n = mesh::facet_area_vector(shell.facets[f], x_);
        double largest = 0;
        for (const Index g : shell.neighbours[f]) {
            const Vec3 m = mesh::facet_area_vector(shell.facets[g], x_);
            const double turn = std::atan2(n.cross(m).norm(), n.dot(m));
            if (turn <= crease) largest = std::max(largest, turn / (0.5 * (shell.size[f] + shell.size[g])));
        }
        return largest;
    }

    double warp(const mesh::Facet& f) const {
        return f.count < 4 ? 0 : 0.25 * (x_[f.nodes[0]] - x_[f.nodes[1]] + x_[f.nodes[2]] - x_[f.nodes[3]]).norm();
    }

    enum class Part { node, edge, facet };

    /// Takes down what lies `depth` deep at a facet of `other`.
    /// @param parts  nodes of the node, edge or facet
    /// @returns excess, m
    double note(Index body, Index other, const std::array<Index, 4>& parts, Part part, const Vec3& place, Index facet,
                double depth) {
        const Index node = parts[0];
        const Shell &own = shells_[body], &host = shells_[other];
        double h = host.size[facet], bend = 0;
        for (const Index f : own.node_facets[audit_.shell_node_[node]]) {
            h = std::max(h, own.size[f]);
            bend = std::max(bend, curvature(own, f));
        }
        const double sharpest =
            crease / h; // what turns by more over h is too fine for the other's facets: no sagitta of theirs
        bend = std::min(bend, sharpest) + std::min(curvature(host, facet), sharpest);
        const double sagitta = h * h / 8 * bend + warp(host.facets[facet]);
        const double excess = std::max(0.0, depth - sagitta);
        if (deepest_.body < 0 || excess / h > deepest_.relative())
            deepest_ = {body, other, node, part == Part::edge, part == Part::facet, place, depth, excess, h};
        if (body != other) result_.places.push_back({body, other, parts, host.facets[facet].nodes, depth, excess, h});
        return excess;
    }

    /// Of the facets of a body that meet a box.
    [[nodiscard]] Tree tree_within(Index body, const Bounds& box) const {
        std::vector<Leaf> leaves;
        for (std::size_t f = 0; f < shells_[body].facets.size(); ++f)
            if (const Bounds one = bounds(shells_[body].facets[f]); one.meets(box))
                leaves.emplace_back(one.box(), static_cast<Index>(f));
        return {leaves.begin(), leaves.end()};
    }

    /// Where the edge goes through those facets of a body in a tree that share no node with it, and its ends that lie on
    /// such facets.
    void cross(Index body, const Tree& facets, const Shell::Edge& edge, std::vector<Crossing>& crossings,
               std::vector<Index>& on) {
        crossings.clear();
        on.clear();
        const Shell& shell = shells_[body];
        const Vec3 &p = x_[edge.a], &q = x_[edge.b];
        Bounds box;
        box.extend(p);
        box.extend(q);
        near_.clear();
        facets.query(bgi::intersects(box.box()), std::back_inserter(near_));
        for (const Leaf& leaf : near_) {
            const Index f = leaf.second;
            const mesh::Facet& facet = shell.facets[f];
            if (std::ranges::count(facet, edge.a) + std::ranges::count(facet, edge.b) > 0) continue;
            for_triangles(facet, [&](const Triangle& triangle) {
                const Vec3 n = triangle.normal();
                const double dp = n.dot(p - triangle.a), dq = n.dot(q - triangle.a);
                const double close = touching * shell.size[f] * n.norm();
                if (std::abs(dp) <= close && triangle.holds(p)) on.push_back(edge.a);
                if (std::abs(dq) <= close && triangle.holds(q)) on.push_back(edge.b);
                if ((dp > 0) == (dq > 0)) return;
                const double least = std::min(std::abs(dp), std::abs(dq)) / n.norm();
                if (!(least > touching * shell.size[f])) return;
                const double at = dp / (dp - dq);
                if (triangle.holds(p + at * (q - p))) crossings.push_back({at, f, least});
            });
        }
        std::ranges::sort(crossings, {}, [](const Crossing& c) { return std::pair(c.at, c.facet); });
    }

    void pass_through_itself(Index body) {
        // what has moved by less relative to the rest has not gone through it by more than twice that
        constexpr double little = 0.02; // of the smallest facet
        const Shell& shell = shells_[body];
        if (shell.sound && shell.change_of_shape(x_) <= little * shell.finest) return;
        std::vector<Crossing> crossings;
        std::vector<Index> on;
        for (const Shell::Edge& edge : shell.edges) {
            cross(body, tree(body), edge, crossings, on);
            for (const Crossing& c : crossings)
                note(body, body, {edge.a, edge.b, -1, -1}, Part::edge, x_[edge.a] + c.at * (x_[edge.b] - x_[edge.a]),
                     c.facet, c.least);
        }
    }

    /// Nodes and edges of `body` in `other`.
    void enter(Index body, Index other) {
        const Shell& shell = shells_[body];
        std::vector<char> seen(shell.nodes.size(), 0);
        std::vector<Index> queue; // nodes inside
        std::vector<Index> on, on_surface;
        const auto look = [&](Index node) {
            const Index own = audit_.shell_node_[node];
            if (seen[own]) return seen[own] == 2;
            const Side where = side(other, x_[node]);
            const bool in = where.distance < -touching * shells_[other].size[where.facet];
            seen[own] = in ? 2 : 1;
            if (!in) return false;
            const double excess =
                note(body, other, {node, -1, -1, -1}, Part::node, x_[node], where.facet, -where.distance);
            double& most = inside_[node];
            most = std::max(most, excess);
            queue.push_back(own);
            return true;
        };
        std::vector<Crossing> crossings;
        Bounds common; // of both bodies
        common.low = bounds_[body].low.cwiseMax(bounds_[other].low);
        common.high = bounds_[body].high.cwiseMin(bounds_[other].high);
        const Tree facets = tree_within(other, common);
        for (const Shell::Edge& edge : shell.edges) {
            if (facets.empty()) break;
            Bounds box;
            box.extend(x_[edge.a]);
            box.extend(x_[edge.b]);
            if (!box.meets(common)) continue;
            cross(other, facets, edge, crossings, on);
            for (const Index node : on) on_surface.push_back(audit_.shell_node_[node]);
            if (crossings.empty()) continue;
            const bool a = look(edge.a), b = look(edge.b);
            if (a || b) continue;
            for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
                const double at = 0.5 * (crossings[k].at + crossings[k + 1].at);
                const Vec3 middle = x_[edge.a] + at * (x_[edge.b] - x_[edge.a]);
                const Side where = side(other, middle);
                if (where.distance < -touching * shells_[other].size[where.facet])
                    note(body, other, {edge.a, edge.b, -1, -1}, Part::edge, middle, where.facet, -where.distance);
            }
        }
        for (const std::vector<Index>& part : shell.components) {
            if (std::ranges::any_of(part, [&](Index own) { return seen[own] != 0; })) continue;
            Bounds box;
            for (const Index own : part) box.extend(x_[shell.nodes[own]]);
            if (box.within(bounds_[other])) look(shell.nodes[part.front()]);
        }
        std::ranges::sort(on_surface);
        on_surface.erase(std::unique(on_surface.begin(), on_surface.end()), on_surface.end());
        const auto look_between = [&](const std::array<Index, 4>& parts, Part part, const Vec3& middle) {
            const Side where = side(other, middle);
            if (where.distance < -touching * shells_[other].size[where.facet])
                note(body, other, parts, part, middle, where.facet, -where.distance);
        };
        std::vector<Index> around; // facets
        for (const Index own : on_surface) {
            const Index node = shell.nodes[own];
            for (const Index next : shell.node_nodes[own])
                if (!look(shell.nodes[next]) && (next > own || !std::ranges::binary_search(on_surface, next)))
                    look_between({node, shell.nodes[next], -1, -1}, Part::edge,
                                 0.5 * (x_[node] + x_[shell.nodes[next]]));
            around.insert(around.end(), shell.node_facets[own].begin(), shell.node_facets[own].end());
        }
        std::ranges::sort(around);
        around.erase(std::unique(around.begin(), around.end()), around.end());
        for (const Index f : around) {
            Vec3 middle = Vec3::Zero();
            for (const Index node : shell.facets[f]) middle += x_[node] / shell.facets[f].count;
            look_between(shell.facets[f].nodes, Part::facet, middle);
        }
        for (std::size_t k = 0; k < queue.size(); ++k)
            for (const Index next : shell.node_nodes[queue[k]]) look(shell.nodes[next]);
    }

    const SurfaceAudit& audit_;
    const std::vector<Shell>& shells_;
    const std::vector<Vec3>& x_;
    std::vector<std::optional<Tree>> trees_;
    std::vector<Bounds> bounds_;
    std::map<Index, double> inside_;
    Intrusion deepest_; ///< of the two bodies looked at
    AuditResult result_;
    std::vector<Leaf> near_, nearest_;
    std::vector<Foot> feet_;
};

const Intrusion* AuditResult::worst() const {
    const auto at = std::ranges::max_element(intrusions, {}, &Intrusion::relative);
    return at == intrusions.end() ? nullptr : &*at;
}

double AuditResult::between(Index body, Index other) const {
    for (const Intrusion& one : intrusions)
        if (std::minmax(one.body, one.other) == std::minmax(body, other)) return one.excess;
    return 0;
}

SurfaceAudit::SurfaceAudit(const std::vector<std::vector<mesh::Facet>>& bodies, const std::vector<Vec3>& X)
    : shell_node_(X.size(), -1) {
    for (const std::vector<mesh::Facet>& facets : bodies) shells_.emplace_back(facets, X, shell_node_);
    drawn_ = examine(X);
    for (std::size_t b = 0; b < shells_.size(); ++b)
        shells_[b].sound = std::ranges::none_of(drawn_.intrusions, [&](const Intrusion& one) {
            return one.body == one.other && one.body == static_cast<Index>(b);
        });
}

SurfaceAudit::~SurfaceAudit() = default;

AuditResult SurfaceAudit::examine(const std::vector<Vec3>& x) const {
    return Examination(*this, x).run();
}

} // namespace osculate::contact
