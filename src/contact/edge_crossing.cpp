#include "osculate/contact/edge_crossing.hpp"

#include "contact/cubic.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace osculate::contact {

LineCrossing cross_lines(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    const Vec3 a = a1 - a0, b = b1 - b0, c = b0 - a0, w = a.cross(b);
    LineCrossing crossing;
    const double area2 = w.squaredNorm();
    crossing.sine = std::sqrt(area2 / (a.squaredNorm() * b.squaredNorm()));
    if (!(crossing.sine > 0)) return crossing;
    crossing.s = c.cross(b).dot(w) / area2;
    crossing.t = c.cross(a).dot(w) / area2;
    crossing.across = w / std::sqrt(area2);
    crossing.offset = a0 + crossing.s * a - b0 - crossing.t * b;
    return crossing;
}

SharpEdge sharp_edge(const std::array<Vec3, 2>& end, const std::array<Vec3, 2>& centres) {
    SharpEdge edge{end, {}};
    const Vec3 e = (end[1] - end[0]).normalized();
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec3 into = centres[k] - end[0];
        edge.wings[k] = (into - e * e.dot(into)).normalized();
    }
    return edge;
}

std::array<Index, 2> vertices_of_edge(const mesh::HalfEdgeSurface& surface, Index half_edge) {
    const mesh::HalfEdge& half = surface.half_edges()[static_cast<std::size_t>(half_edge)];
    return {half.origin, surface.half_edges()[static_cast<std::size_t>(half.next)].origin};
}

std::array<Index, 2> facets_at_edge(const mesh::HalfEdgeSurface& surface, Index half_edge) {
    const mesh::HalfEdge& half = surface.half_edges()[static_cast<std::size_t>(half_edge)];
    return {half.facet, surface.half_edges()[static_cast<std::size_t>(half.twin)].facet};
}

SharpEdge sharp_edge(const mesh::HalfEdgeSurface& surface, Index half_edge, const std::vector<Vec3>& x) {
    const auto [a, b] = vertices_of_edge(surface, half_edge);
    std::array<Vec3, 2> centres{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < 2; ++k) {
        const auto around = surface.facet_vertices(facets_at_edge(surface, half_edge)[k]);
        for (const Index v : around) centres[k] += x[static_cast<std::size_t>(v)] / static_cast<double>(around.size());
    }
    return sharp_edge({x[static_cast<std::size_t>(a)], x[static_cast<std::size_t>(b)]}, centres);
}

double out_of_cones(const Vec3& normal, const SharpEdge& a, const SharpEdge& b) {
    return std::max({normal.dot(b.wings[0]), normal.dot(b.wings[1]), -normal.dot(a.wings[0]), -normal.dot(a.wings[1])});
}

std::optional<EdgePassage> first_passage(const SharpEdge& a0, const SharpEdge& b0, const SharpEdge& a1,
                                         const SharpEdge& b1) {
    const auto across = [](const SharpEdge& a, const SharpEdge& b) {
        return cross_lines(a.end[0], a.end[1], b.end[0], b.end[1]);
    };
    const auto between = [](const SharpEdge& from, const SharpEdge& to, double time) {
        SharpEdge edge;
        for (std::size_t k = 0; k < 2; ++k) {
            edge.end[k] = from.end[k] + time * (to.end[k] - from.end[k]);
            edge.wings[k] = from.wings[k] + time * (to.wings[k] - from.wings[k]);
        }
        return edge;
    };
    const auto along = [](const SharpEdge& edge) -> Vec3 { return edge.end[1] - edge.end[0]; };
    const Vec3 e0 = a0.end[0] - b0.end[0], e1 = a1.end[0] - b1.end[0];
    const Vec3 p0 = along(a0), p1 = along(a1), q0 = along(b0), q1 = along(b1);
    const Cubic volume = triple_product(e0, e1 - e0, p0, p1 - p0, q0, q1 - q0);
    const std::vector<double> ends = volume.pieces();
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double from = volume(ends[k]), to = volume(ends[k + 1]);
        if (!((from > 0 && to <= 0) || (from < 0 && to >= 0))) continue;
        EdgePassage passage;
        passage.time = volume.root(ends[k], ends[k + 1]);
        const SharpEdge a = between(a0, a1, passage.time), b = between(b0, b1, passage.time);
        const LineCrossing then = across(a, b);
        if (!(then.sine > least_sine) || then.s < 0 || then.s > 1 || then.t < 0 || then.t > 1) continue;
        const double side = out_of_cones(then.across, a, b) < out_of_cones(-then.across, a, b) ? 1 : -1;
        if (out_of_cones(side * then.across, a, b) > cone_tolerance) continue;
        const LineCrossing start = across(a0, b0), end = across(a1, b1);
        passage.before = side * start.across.dot(start.offset);
        passage.after = side * end.across.dot(end.offset);
        if (passage.before > 0 && passage.after < 0) return passage;
    }
    return std::nullopt;
}

} // namespace osculate::contact
