/// Bodies of one layer of elements that stand for plane ones, or for those of revolution.

#include "app/plan/draft_slices.hpp"

#include "app/fault.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace osculate::app {

namespace {

/// How far apart the places of nodes above one another may be, of the body's size.
constexpr double same_place = 1e-6;

/// A node seen along the layer: its place in the plane, where in the layer it is, and its axes in columns: two of the
/// plane (radial and axial where there is an axis), and across it.
struct Seen {
    Index node = -1;
    double a = 0, b = 0, height = 0;
    Mat3 axes = Mat3::Identity();
};

std::vector<Seen> seen_along(const model::Model& model, const model::Body& body, const scene::Slice& slice) {
    const Vec3 n = slice.axis.normalized(), one = n.unitOrthogonal(), other = n.cross(one),
               point = slice.point - model.origin;
    std::vector<Seen> list;
    Vec3 first = Vec3::Zero(); // radial direction of the node from which angles count
    for (Index i = 0; i < body.nodes(); ++i) {
        Seen s;
        s.node = body.first_node + i;
        const Vec3& X = body.mesh.nodes[static_cast<std::size_t>(i)];
        if (slice.kind != scene::SliceKind::axisymmetric) {
            s.a = one.dot(X);
            s.b = other.dot(X);
            s.height = n.dot(X);
            s.axes << one, other, n;
        } else {
            const Vec3 arm = X - point, radial = arm - n.dot(arm) * n;
            s.a = radial.norm();
            s.b = n.dot(arm);
            const Vec3 e = radial.normalized();
            if (first.isZero(0)) first = e;
            s.height = std::atan2(n.dot(first.cross(e)), first.dot(e));
            s.axes << e, n, e.cross(n);
        }
        list.push_back(s);
    }
    return list;
}

/// Groups of nodes in the same place of the plane, each in the order of their heights.
std::vector<std::vector<Seen>> stacks(std::vector<Seen> list, double within) {
    std::ranges::sort(list, {}, [](const Seen& s) { return std::pair(s.a, s.node); });
    std::vector<char> taken(list.size(), 0);
    std::vector<std::vector<Seen>> groups;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (taken[i] != 0) continue;
        std::vector<Seen>& group = groups.emplace_back();
        for (std::size_t k = i; k < list.size() && list[k].a - list[i].a <= within; ++k)
            if (taken[k] == 0 && std::abs(list[k].b - list[i].b) <= within) {
                taken[k] = 1;
                group.push_back(list[k]);
            }
        std::ranges::sort(group, {}, [](const Seen& s) { return std::pair(s.height, s.node); });
    }
    return groups;
}

double size_of(const model::Body& body) {
    Eigen::AlignedBox3d box;
    for (const Vec3& X : body.mesh.nodes) box.extend(X);
    return box.diagonal().norm();
}

} // namespace

std::map<Index, Index> nodes_above(const scene::Scene& scene, const model::Model& model, Index b) {
    std::map<Index, Index> above;
    const model::Body& body = model.bodies[static_cast<std::size_t>(b)];
    const auto& slice = scene.bodies[static_cast<std::size_t>(b)].second.slice;
    if (!slice) return above;
    for (const std::vector<Seen>& stack : stacks(seen_along(model, body, *slice), same_place * size_of(body)))
        for (std::size_t k = 1; k < stack.size(); ++k) above.emplace(stack[k].node, stack.front().node);
    return above;
}

std::vector<SliceRow> add_slices(Draft& draft) {
    const model::Model& m = draft.plan.model;
    const std::vector<Index> dependent = model::dependent_nodes(m);
    const std::set<Index> follow(dependent.begin(), dependent.end());
    std::vector<SliceRow> rows;
    if (draft.scene.general)
        for (const auto& [name, body] : draft.scene.bodies)
            if (body.slice) {
                draft.faults.push_back(fault("contact.general",
                                             "contact pairs where a body is a slice: they say which of its "
                                             "faces are sides of the plane body",
                                             "general contact with bodies." + name + ".slice"));
                return rows;
            }
    for (std::size_t b = 0; b < m.bodies.size(); ++b) {
        const model::Body& body = m.bodies[b];
        const auto& slice = scene::find(draft.scene.bodies, body.name)->slice;
        if (!slice || body.rigid) continue;
        const std::string key = "bodies." + body.name + ".slice";
        const auto refuse = [&](const std::string& last, const std::string& expected, Index node,
                                const std::string& what) {
            const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
            draft.faults.push_back(fault(
                key + last, expected, fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m {}", X[0], X[1], X[2], what)));
        };
        const double size = size_of(body);
        const bool revolves = slice->kind == scene::SliceKind::axisymmetric;
        const std::vector<Seen> seen = seen_along(m, body, *slice);
        if (revolves)
            if (const auto on = std::ranges::find_if(seen, [&](const Seen& s) { return s.a <= same_place * size; });
                on != seen.end()) {
                refuse("", "nodes apart from the axis", on->node, "on it");
                continue;
            }
        bool fit = true;
        for (const std::vector<Seen>& stack : stacks(seen, same_place * size)) {
            for (const Seen& s : stack)
                if (fit && follow.contains(s.node)) {
                    refuse("", "nodes that follow no tie, coupling or end of a sector", s.node, "that does");
                    fit = false;
                }
            if (fit && stack.size() < 2) {
                refuse(".axis", "a mesh of one layer along it, with nodes above one another", stack.front().node,
                       "with none above or below it");
                fit = false;
            }
            if (!fit) break;
            for (std::size_t k = 0; k < stack.size(); ++k) {
                const Seen& s = stack[k];
                if (slice->kind != scene::SliceKind::plane_stress || k == 0)
                    for (time::Stage& stage : draft.plan.stages) {
                        linear::NodeConstraint held;
                        held.node = s.node;
                        held.direction = s.axes.col(2);
                        stage.constraints.push_back(held);
                    }
                for (Index d = 0; k > 0 && d < 2; ++d)
                    rows.push_back({key, s.node, stack.front().node, s.axes.col(d), stack.front().axes.col(d)});
            }
        }
    }
    return rows;
}

} // namespace osculate::app
