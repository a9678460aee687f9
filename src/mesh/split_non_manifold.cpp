#include "mesh/split_non_manifold.hpp"

#include "mesh/sort_few.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace osculate::mesh {
namespace {

constexpr Index stride = most_nodes_per_cell;

Index root_of(std::vector<Index>& parent, Index i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

Index slot_of(const RawCell& cell, Index number, Index node) {
    return number * stride + static_cast<Index>(std::find(cell.begin(), cell.end(), node) - cell.begin());
}

/// Node of a cell midway between two corners; -1 if it has none.
Index middle(const RawCell& cell, Index a, Index b) {
    const CellInfo& info = cell_info(cell.type);
    if (info.edges.empty()) return -1;
    const auto place = [&](Index n) { return static_cast<int>(std::find(cell.begin(), cell.end(), n) - cell.begin()); };
    const int local = info.midway(place(a), place(b));
    return local < 0 ? -1 : cell.nodes[static_cast<std::size_t>(local)];
}

std::array<Index, 4> key_of(const RawFace& face) {
    std::array<Index, 4> key{-1, -1, -1, -1};
    const int corners = face_shape(face.count).corners;
    std::copy(face.nodes.begin(), face.nodes.begin() + corners, key.begin());
    sort_few(key.begin(), key.begin() + corners);
    return key;
}

} // namespace

NonManifold find_non_manifold(const RawMesh& raw) {
    NonManifold found;
    std::vector<Index>& parent = found.group;
    parent.resize(raw.cells.size() * stride);
    std::iota(parent.begin(), parent.end(), 0);
    std::vector<std::pair<Index, Index>> edges;
    const auto join = [&](Index a, Index b, Index node) {
        const Index x = root_of(parent, slot_of(raw.cells[a], a, node)),
                    y = root_of(parent, slot_of(raw.cells[b], b, node));
        parent[std::max(x, y)] = std::min(x, y);
    };
    const std::vector<FaceOfCell> faces = faces_side_by_side(raw.cells, raw.points.size());
    for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
        while (last < faces.size() && faces[last].corners == faces[first].corners) ++last;
        const FaceOfCell& face = faces[first];
        for (std::size_t more = first + 2; more < last; ++more) found.crowded_faces.push_back(faces[more]);
        if (last - first == 1) {
            const LocalFace& local = cell_info(raw.cells[face.cell].type).faces[static_cast<std::size_t>(face.face)];
            for (int i = 0; i < local.count; ++i) {
                const Index a = raw.cells[face.cell].nodes[local.nodes[i]],
                            b = raw.cells[face.cell].nodes[local.nodes[(i + 1) % local.count]];
                edges.emplace_back(std::min(a, b), std::max(a, b));
            }
            continue;
        }
        for (std::size_t other = first + 1; other < last; ++other) {
            const Index a = face.cell, b = faces[other].cell;
            for (const Index node : face.corners)
                if (node >= 0) join(a, b, node);
            bool alike = true;
            const LocalFace& local = cell_info(raw.cells[a].type).faces[static_cast<std::size_t>(face.face)];
            for (int i = 0; i < local.count; ++i) {
                const Index p = raw.cells[a].nodes[local.nodes[i]],
                            q = raw.cells[a].nodes[local.nodes[(i + 1) % local.count]],
                            mid = middle(raw.cells[a], p, q);
                if (middle(raw.cells[b], p, q) != mid)
                    alike = false;
                else if (mid >= 0)
                    join(a, b, mid);
            }
            if (!alike) found.unlike_faces.emplace_back(face, faces[other]);
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
        while (last < edges.size() && edges[last] == edges[first]) ++last;
        if (last - first > 2) found.crowded_edges.push_back(edges[first]);
    }
    std::vector<Index> group(raw.points.size(), -1);
    std::vector<bool> touching(raw.points.size(), false);
    for (std::size_t c = 0; c < raw.cells.size(); ++c)
        for (int i = 0; i < raw.cells[c].count(); ++i) {
            const auto slot = static_cast<Index>(c) * stride + i;
            parent[slot] = root_of(parent, slot);
            Index& known = group[raw.cells[c].nodes[i]];
            if (known < 0)
                known = parent[slot];
            else if (known != parent[slot])
                touching[raw.cells[c].nodes[i]] = true;
        }
    for (std::size_t p = 0; p < touching.size(); ++p)
        if (touching[p]) found.touching_points.push_back(static_cast<Index>(p));
    return found;
}

void split_non_manifold(RawMesh& raw, const NonManifold& found) {
    std::vector<bool> touching(raw.points.size(), false);
    for (const Index p : found.touching_points) touching[p] = 1;
    // Faces of sets that have such points, by their cells, before numbers change.
    std::map<std::array<Index, 4>, std::pair<Index, int>> exterior;
    for (const FaceOfCell& face : faces_side_by_side(raw.cells, raw.points.size()))
        if (std::any_of(face.corners.begin(), face.corners.end(), [&](Index n) { return n >= 0 && touching[n]; }))
            exterior.emplace(face.corners, std::pair(face.cell, face.face));

    const std::vector<RawCell> before = raw.cells;
    std::map<Index, std::map<Index, Index>> copies; // of a point, per group of cells
    for (std::size_t c = 0; c < raw.cells.size(); ++c)
        for (int i = 0; i < raw.cells[c].count(); ++i) {
            Index& node = raw.cells[c].nodes[i];
            if (!touching[node]) continue;
            auto& of_point = copies[node];
            const auto [place, fresh] = of_point.emplace(found.group[c * stride + i], node);
            if (fresh && of_point.size() > 1) {
                place->second = static_cast<Index>(raw.points.size());
                const Vec3 position = raw.points[node];
                raw.points.push_back(position);
                raw.point_ids.push_back(raw.point_ids[node]);
                raw.elsewhere.push_back(0);
            }
            node = place->second;
        }
    for (auto& [name, set] : raw.node_sets) {
        const std::size_t count = set.size();
        for (std::size_t k = 0; k < count; ++k)
            if (const auto of_point = copies.find(set[k]); of_point != copies.end())
                for (const auto& [group, copy] : of_point->second)
                    if (copy != of_point->first) set.push_back(copy);
    }
    for (auto& [name, faces] : raw.surfaces)
        for (RawFace& face : faces) {
            const auto at = exterior.find(key_of(face));
            if (at == exterior.end()) continue;
            const Index c = at->second.first;
            for (int i = 0; i < face.count; ++i)
                if (const Index slot = slot_of(before[c], c, face.nodes[i]) - c * stride; slot < before[c].count())
                    face.nodes[i] = raw.cells[c].nodes[slot];
        }
}

} // namespace osculate::mesh
