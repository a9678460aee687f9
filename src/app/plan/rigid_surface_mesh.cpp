/// Shells of hexahedra on exact shapes.

#include "app/overloaded.hpp"
#include "app/plan/rigid_surface.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace osculate::app {

namespace {

/// A point of a shape, and the one behind it in the solid.
struct Layer {
    Vec3 front, back;
};

/// A grid of layers, columns i along the surface and rows j to their left, seen from outside.
mesh::Mesh grid(int columns, int rows, bool around, const std::function<Layer(int, int)>& at) {
    mesh::Mesh m;
    const int lines = around ? columns : columns + 1;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i < lines; ++i) {
            const Layer layer = at(i, j);
            m.nodes.push_back(layer.back);
            m.nodes.push_back(layer.front);
        }
    const auto node = [&](int i, int j, int front) { return static_cast<Index>(2 * (j * lines + i % lines) + front); };
    mesh::ElementBlock& block = m.blocks.emplace_back();
    block.type = mesh::CellType::hex8;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            for (const int front : {0, 1})
                block.connectivity.insert(block.connectivity.end(), {node(i, j, front), node(i + 1, j, front),
                                                                     node(i + 1, j + 1, front), node(i, j + 1, front)});
    return m;
}

/// Extent of a box along a direction, from a point.
std::pair<double, double> extent(const Eigen::AlignedBox3d& box, const Vec3& from, const Vec3& along) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int c = 0; c < 8; ++c) {
        const double z = along.dot(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)) - from);
        low = std::min(low, z);
        high = std::max(high, z);
    }
    return {low, high};
}

Vec3 across(const Vec3& axis) {
    int smallest = 0;
    axis.cwiseAbs().minCoeff(&smallest);
    return axis.cross(Vec3::Unit(smallest)).normalized();
}

constexpr double beyond = 0.25;       ///< of the bodies' extent: how far a surface without ends is shown past them
constexpr int per_turn = 72;          ///< facets around a circle
constexpr double in = 0.6, out = 1.3; ///< radius behind a surface, of its own

mesh::Mesh shell(const contact::PlaneShape& plane, const Eigen::AlignedBox3d& near) {
    const Vec3 u = across(plane.normal), v = plane.normal.cross(u);
    const double half = (0.5 + beyond) * near.diagonal().norm();
    const Vec3 centre = near.center() - plane.normal * plane.normal.dot(near.center() - plane.point);
    constexpr int cells = 8;
    return grid(cells, cells, false, [&](int i, int j) {
        const Vec3 p = centre + half * ((2.0 * i / cells - 1) * u + (2.0 * j / cells - 1) * v);
        return Layer{p, p - 0.5 * half * plane.normal};
    });
}

/// Of a surface of revolution, whose profile has radius(z) for z from low to high.
/// @param behind  radius behind the surface, of its own
mesh::Mesh revolved(const Vec3& point, const Vec3& axis, double low, double high, double behind,
                    const std::function<double(double)>& radius) {
    constexpr int cells = 8;
    const Vec3 u = across(axis), v = axis.cross(u);
    return grid(per_turn, cells, true, [&](int i, int j) {
        // around the axis outside, against it inside, so that rows are on the left
        const double angle = (behind < 1 ? 1 : -1) * 2 * std::numbers::pi * i / per_turn;
        const double z = low + (high - low) * j / cells, r = radius(z);
        const Vec3 e = std::cos(angle) * u + std::sin(angle) * v;
        return Layer{point + z * axis + r * e, point + z * axis + behind * r * e};
    });
}

mesh::Mesh shell(const contact::CylinderShape& c, const Eigen::AlignedBox3d& near) {
    auto [low, high] = extent(near, c.point, c.axis);
    const double more = beyond * (high - low) + 0.1 * c.radius;
    return revolved(c.point, c.axis, low - more, high + more, c.inside ? out : in, [&](double) { return c.radius; });
}

mesh::Mesh shell(const contact::ConeShape& c, const Eigen::AlignedBox3d& near) {
    auto [low, high] = extent(near, c.apex, c.axis);
    const double more = beyond * (high - low), tip = 0.02;
    const double top = high + more > 0 ? high + more : high - low; // the bodies may all be beyond the apex
    const double bottom = std::max(low - more, tip * top);
    return revolved(c.apex, c.axis, std::min(bottom, 0.5 * top), top, c.inside ? out : in,
                    [&](double z) { return z * std::tan(c.half_angle); });
}

/// A cube whose faces are blown up to the sphere.
mesh::Mesh shell(const contact::SphereShape& s, const Eigen::AlignedBox3d&) {
    constexpr int n = 18;
    mesh::Mesh m;
    std::map<std::array<int, 3>, Index> number; // of the back; the front is the next
    const auto node = [&](const std::array<int, 3>& at) {
        const auto [found, fresh] = number.emplace(at, m.node_count());
        if (fresh) {
            Vec3 d;
            for (int k = 0; k < 3; ++k)
                d(k) = std::tan(std::numbers::pi / 4 * (2.0 * at[static_cast<std::size_t>(k)] / n - 1));
            d.normalize();
            m.nodes.push_back(s.centre + (s.inside ? out : in) * s.radius * d);
            m.nodes.push_back(s.centre + s.radius * d);
        }
        return found->second;
    };
    mesh::ElementBlock& block = m.blocks.emplace_back();
    block.type = mesh::CellType::hex8;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto at = [&](int a, int b) {
                        std::array<int, 3> place{};
                        place[static_cast<std::size_t>(axis)] = side;
                        place[static_cast<std::size_t>((axis + 1) % 3)] = a;
                        place[static_cast<std::size_t>((axis + 2) % 3)] = b;
                        return node(place);
                    };
                    std::array<Index, 4> corners{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
                    // counter-clockwise, seen from where slaves are
                    if ((side == 0) != s.inside) std::swap(corners[1], corners[3]);
                    for (const int front : {0, 1})
                        for (const Index corner : corners) block.connectivity.push_back(corner + front);
                }
    return m;
}

mesh::Mesh shell(const contact::ExtrudedShape& s, const Eigen::AlignedBox3d& near) {
    const auto left_of = [](const Vec2& t) { return Vec2(-t.y(), t.x()); };
    struct Station {
        Vec2 place, normal;
    };
    std::vector<Station> stations;
    double shortest = std::numeric_limits<double>::infinity(), size = 0;
    const auto add = [&](const Vec2& p, const Vec2& n) {
        if (!stations.empty() && (stations.back().place - p).norm() < 1e-9 * size) // a corner: between both normals
            stations.back().normal = (stations.back().normal + n).normalized();
        else
            stations.push_back({p, n});
    };
    for (const contact::ProfilePiece& piece : s.pieces) size += (piece.end - piece.begin).norm();
    for (const contact::ProfilePiece& piece : s.pieces) {
        if (piece.bend == 0) {
            const Vec2 n = left_of((piece.end - piece.begin).normalized());
            constexpr int parts = 4;
            for (int k = 0; k <= parts; ++k) add(piece.begin + k * (piece.end - piece.begin) / parts, n);
            shortest = std::min(shortest, (piece.end - piece.begin).norm());
            continue;
        }
        const Vec2 a = piece.begin - piece.centre, b = piece.end - piece.centre;
        const double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)), radius = 1 / std::abs(piece.bend);
        const int parts = std::max(2, static_cast<int>(std::ceil(std::abs(angle) * per_turn / (2 * std::numbers::pi))));
        for (int k = 0; k <= parts; ++k) {
            const Vec2 arm = Eigen::Rotation2Dd(angle * k / parts) * a;
            add(piece.centre + arm, (piece.bend > 0 ? -1 : 1) * arm / radius);
        }
        shortest = std::min(shortest, radius);
    }
    if (s.closed) {
        stations.front().normal = (stations.front().normal + stations.back().normal).normalized();
        stations.pop_back();
    }
    const double thickness = std::min(0.05 * size, 0.4 * shortest);
    const auto reach = extent(near, s.origin, s.along);
    const double low = reach.first, high = reach.second; // a lambda takes no parts of a pair
    const double more = beyond * (high - low);
    constexpr int cells = 4;
    const auto columns = static_cast<int>(stations.size()) - (s.closed ? 0 : 1);
    const auto in_space = [&](const Vec2& p, double z) {
        return Vec3(s.origin + p.x() * s.u + p.y() * s.v + z * s.along);
    };
    // u to the right, v up, slaves above: columns come out of the plane where rows go right
    mesh::Mesh m = grid(columns, cells, s.closed, [&](int i, int j) {
        const Station& at = stations[static_cast<std::size_t>(i)];
        const double z = high + more - (high - low + 2 * more) * j / cells;
        return Layer{in_space(at.place, z), in_space(at.place - thickness * at.normal, z)};
    });
    return m;
}

} // namespace

mesh::Mesh shell_of(const contact::ExactShape& shape, const Eigen::AlignedBox3d& near) {
    return std::visit([&](const auto& one) { return shell(one, near); }, shape);
}

} // namespace osculate::app
