#include "osculate/mesh/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <span>
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
    std::vector<Facet> faces;
    std::size_t count = 0;
    for (const ElementBlock& block : mesh.blocks)
        count += static_cast<std::size_t>(block.size()) * cell_info(block.type).facets.size();
    faces.reserve(count);
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        const ElementBlock& block = mesh.blocks[b];
        const int stride = nodes_per_cell(block.type);
        const auto local_faces = cell_info(block.type).facets;
        for (Index e = 0; e < block.size(); ++e) {
            const Index* nodes = block.connectivity.data() + static_cast<std::ptrdiff_t>(e) * stride;
            for (const LocalFace& local : local_faces) {
                Facet facet{{-1, -1, -1, -1}, local.count, static_cast<Index>(b), e};
                for (int i = 0; i < local.count; ++i) facet.nodes[i] = nodes[local.nodes[i]];
                faces.push_back(facet);
            }
        }
    }

    // Faces of the same nodes have the same smallest one: only those are compared.
    using Key = std::array<Index, 4>;
    std::vector<Key> keys(faces.size());
    std::vector<std::size_t> begin(mesh.nodes.size() + 2, 0); // by smallest node
    const auto smallest = [](const Key& key) { return static_cast<std::size_t>(key[0] < 0 ? key[1] : key[0]); };
    for (std::size_t f = 0; f < faces.size(); ++f) {
        keys[f] = faces[f].nodes;
        std::ranges::sort(keys[f]);
        ++begin[smallest(keys[f]) + 2];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::size_t> of_node(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) of_node[begin[smallest(keys[f]) + 1]++] = f;
    std::vector<char> single(faces.size(), 0);
    for (std::size_t node = 0; node + 2 < begin.size(); ++node) {
        const std::span list(of_node.begin() + static_cast<std::ptrdiff_t>(begin[node]),
                             of_node.begin() + static_cast<std::ptrdiff_t>(begin[node + 1]));
        std::ranges::sort(list, {}, [&](std::size_t f) -> const Key& { return keys[f]; });
        for (std::size_t first = 0, last = 0; first < list.size(); first = last) {
            while (last < list.size() && keys[list[last]] == keys[list[first]]) ++last;
            if (last - first == 1) single[list[first]] = 1;
        }
    }

    std::vector<Facet> exterior;
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (single[f] != 0) exterior.push_back(faces[f]);
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
