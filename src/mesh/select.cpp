#include "osculate/mesh/select.hpp"

#include "mesh/sort_unique.hpp"
#include "osculate/mesh/triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace osculate::mesh {
namespace {

double tolerance_of(const Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vec3& node : mesh.nodes) box.extend(node);
    return box.isEmpty() ? 0 : selection_tolerance * box.diagonal().norm();
}

std::vector<Facet> facets_within(const std::vector<Facet>& exterior, const std::vector<char>& member) {
    std::vector<Facet> facets;
    std::copy_if(exterior.begin(), exterior.end(), std::back_inserter(facets), [&](const Facet& facet) {
        return std::all_of(facet.begin(), facet.end(), [&](Index node) { return member[node] != 0; });
    });
    return facets;
}

/// Nodes for which `on(position)` holds, and the exterior facets with all corners among them.
template <class Predicate>
Region select_where(const Mesh& mesh, const std::vector<Facet>& exterior, const Predicate& on) {
    Region region;
    std::vector<char> member(mesh.nodes.size(), 0);
    for (Index n = 0; n < mesh.node_count(); ++n)
        if (on(mesh.nodes[n])) {
            member[n] = 1;
            region.nodes.push_back(n);
        }
    region.facets = facets_within(exterior, member);
    return region;
}

} // namespace

std::optional<Region> select_named(const Mesh& mesh, const std::vector<Facet>& exterior, const std::string& name) {
    const auto surface = mesh.surfaces.find(name);
    const auto set = mesh.node_sets.find(name);
    if (surface == mesh.surfaces.end() && set == mesh.node_sets.end()) return std::nullopt;
    Region region;
    if (set != mesh.node_sets.end()) region.nodes = set->second;
    if (surface != mesh.surfaces.end()) {
        region.facets = surface->second;
        const std::vector<Index> more = nodes_of(region.facets);
        region.nodes.insert(region.nodes.end(), more.begin(), more.end());
    } else {
        std::vector<char> member(mesh.nodes.size(), 0);
        for (const Index node : region.nodes) member[node] = 1;
        region.facets = facets_within(exterior, member);
    }
    sort_unique(region.nodes);
    return region;
}

Region select_numbers(const Mesh& mesh, const std::vector<Facet>& exterior, std::vector<int> numbers) {
    std::ranges::sort(numbers);
    Region region;
    std::vector<char> member(mesh.nodes.size(), 0);
    for (std::size_t i = 0; i < mesh.node_ids.size(); ++i) {
        if (!std::ranges::binary_search(numbers, mesh.node_ids[i])) continue;
        member[i] = 1;
        region.nodes.push_back(static_cast<Index>(i));
    }
    region.facets = facets_within(exterior, member);
    return region;
}

std::vector<Index> nearest_nodes(const Mesh& mesh, const Vec3& point) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& X : mesh.nodes) least = std::min(least, (X - point).norm());
    const double allowed = least + tolerance_of(mesh);
    std::vector<Index> nearest;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        if ((mesh.nodes[i] - point).norm() <= allowed) nearest.push_back(static_cast<Index>(i));
    return nearest;
}

Region select_plane(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& point, const Vec3& normal) {
    const double tolerance = tolerance_of(mesh);
    const Vec3 n = normal.normalized();
    return select_where(mesh, exterior, [&](const Vec3& x) { return std::abs((x - point).dot(n)) <= tolerance; });
}

Region select_cylinder(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& point, const Vec3& axis,
                       double radius) {
    const double tolerance = tolerance_of(mesh);
    const Vec3 a = axis.normalized();
    Region region = select_where(
        mesh, exterior, [&](const Vec3& x) { return std::abs((x - point).cross(a).norm() - radius) <= tolerance; });
    const double steepest = std::numbers::sqrt2 / 2;
    std::erase_if(region.facets,
                  [&](const Facet& facet) { return std::abs(facet_normal(facet, mesh.nodes).dot(a)) > steepest; });
    return region;
}

Region select_box(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& min, const Vec3& max) {
    const double tolerance = tolerance_of(mesh);
    const Vec3 low = min.array() - tolerance, high = max.array() + tolerance;
    return select_where(mesh, exterior, [&](const Vec3& x) {
        return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
    });
}

Region select_normal(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& direction, double angle) {
    Region region;
    for (const Facet& facet : exterior) {
        const Vec3 normal = facet_normal(facet, mesh.nodes);
        if (std::atan2(normal.cross(direction).norm(), normal.dot(direction)) <= angle) region.facets.push_back(facet);
    }
    region.nodes = nodes_of(region.facets);
    sort_unique(region.nodes);
    return region;
}

namespace {

double distance(const Mesh& mesh, const Facet& facet, const Vec3& point) {
    const auto corner = [&](int c) -> const Vec3& {
        return mesh.nodes[static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(c)])];
    };
    double least = std::numeric_limits<double>::infinity();
    for (int c = 1; c + 1 < facet.count; ++c)
        least = std::min(least, (Triangle{corner(0), corner(c), corner(c + 1)}.closest(point) - point).norm());
    return least;
}

/// Nodes of each facet, in an order that does not depend on where it begins.
std::vector<std::vector<Index>> facets_of(const std::vector<Facet>& surface) {
    std::vector<std::vector<Index>> all;
    for (const Facet& facet : surface) {
        all.emplace_back(facet.begin(), facet.end());
        std::ranges::sort(all.back());
    }
    std::ranges::sort(all);
    return all;
}

} // namespace

std::vector<std::string> nearest_surfaces(const Mesh& mesh, const Vec3& point) {
    std::vector<std::pair<double, std::string>> found;
    for (const auto& [name, facets] : mesh.surfaces) {
        double least = std::numeric_limits<double>::infinity();
        for (const Facet& facet : facets) least = std::min(least, distance(mesh, facet, point));
        if (std::isfinite(least)) found.emplace_back(least, name);
    }
    if (found.empty()) return {};
    const double limit = std::ranges::min_element(found)->first + tolerance_of(mesh);
    std::vector<std::string> names;
    for (const auto& [at, name] : found) {
        if (at > limit) continue;
        const auto own = facets_of(mesh.surfaces.at(name));
        const bool holds_another = std::ranges::any_of(found, [&, &itself = name](const auto& other) {
            if (other.first > limit || other.second == itself) return false;
            const auto theirs = facets_of(mesh.surfaces.at(other.second));
            const bool within = std::ranges::includes(own, theirs);
            return within && (theirs.size() < own.size() || other.second < itself); // of equal ones the first
        });
        if (!holds_another) names.push_back(name);
    }
    return names;
}

} // namespace osculate::mesh
