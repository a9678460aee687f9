#include "osculate/mesh/mesh.hpp"

#include "mesh/faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace osculate::mesh {

Index Mesh::element_count() const {
    Index count = 0;
    for (const ElementBlock& block : blocks) count += block.size();
    return count;
}

void divide(Mesh& mesh, const std::vector<std::vector<int>>& section) {
    std::vector<ElementBlock> blocks;
    std::vector<std::vector<std::pair<Index, Index>>> place(
        mesh.blocks.size()); // new block and element of each element
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        const ElementBlock& old = mesh.blocks[b];
        const auto n = static_cast<std::size_t>(nodes_per_cell(old.type));
        std::map<int, std::size_t> block_of; // by sections, ascending
        for (const int s : section[b]) block_of.emplace(s, 0);
        for (auto& [s, block] : block_of) {
            block = blocks.size();
            blocks.push_back({old.type, {}, s});
        }
        for (std::size_t e = 0; e < section[b].size(); ++e) {
            const std::size_t to = block_of.at(section[b][e]);
            place[b].emplace_back(static_cast<Index>(to), blocks[to].size());
            const auto first = old.connectivity.begin() + static_cast<std::ptrdiff_t>(e * n);
            blocks[to].connectivity.insert(blocks[to].connectivity.end(), first,
                                           first + static_cast<std::ptrdiff_t>(n));
        }
    }
    mesh.blocks = std::move(blocks);
    for (auto& [name, surface] : mesh.surfaces)
        for (Facet& facet : surface)
            std::tie(facet.block, facet.element) =
                place[static_cast<std::size_t>(facet.block)][static_cast<std::size_t>(facet.element)];
}

std::vector<Index> nodes_of(const std::vector<Facet>& facets) {
    std::vector<Index> nodes;
    for (const Facet& facet : facets) nodes.insert(nodes.end(), facet.begin(), facet.end());
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

std::vector<Facet> exterior_facets(const Mesh& mesh) {
    const Faces faces(mesh);
    // Faces of the same nodes have the same smallest one: only those are compared.
    const auto smallest = [](const Facet& facet) {
        return static_cast<std::size_t>(*std::min_element(facet.begin(), facet.end()));
    };
    std::vector<std::size_t> begin(mesh.nodes.size() + 2, 0); // by smallest node
    faces.for_each([&](std::size_t, const Facet& facet) { ++begin[smallest(facet) + 2]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::size_t> of_node(faces.size());
    faces.for_each([&](std::size_t number, const Facet& facet) { of_node[begin[smallest(facet) + 1]++] = number; });

    std::vector<char> single(faces.size(), 0);
    std::vector<std::pair<std::array<Index, 4>, std::size_t>> alike; // nodes, ascending, and number
    for (std::size_t node = 0; node + 2 < begin.size(); ++node) {
        alike.clear();
        for (std::size_t k = begin[node]; k < begin[node + 1]; ++k) {
            alike.emplace_back(faces[of_node[k]].nodes, of_node[k]);
            std::ranges::sort(alike.back().first);
        }
        std::ranges::sort(alike);
        for (std::size_t first = 0, last = 0; first < alike.size(); first = last) {
            while (last < alike.size() && alike[last].first == alike[first].first) ++last;
            if (last - first == 1) single[alike[first].second] = 1;
        }
    }

    std::vector<Facet> exterior;
    for (std::size_t number = 0; number < single.size(); ++number)
        if (single[number] != 0) exterior.push_back(faces[number]);
    return exterior;
}

Vec3 facet_centroid(const Facet& facet, const std::vector<Vec3>& positions) {
    Vec3 sum = Vec3::Zero();
    for (const Index node : facet) sum += positions[node];
    return sum / facet.count;
}

Vec3 facet_area_vector(const Facet& facet, const std::vector<Vec3>& positions) {
    const Vec3& first = positions[facet.nodes[0]];
    const Vec3& second = positions[facet.nodes[1]];
    const Vec3& third = positions[facet.nodes[2]];
    if (facet.count == 3) return 0.5 * (second - first).cross(third - first);
    return 0.5 * (third - first).cross(positions[facet.nodes[3]] - second);
}

Vec3 facet_normal(const Facet& facet, const std::vector<Vec3>& positions) {
    return facet_area_vector(facet, positions).normalized();
}

} // namespace osculate::mesh
