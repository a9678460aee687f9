#pragma once
/// A mesh under other numbers.

#include "osculate/mesh/mesh.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace osculate::support {

/// Numbers nodes, elements within their blocks, and facets within their surfaces at random; node sets stay ascending.
/// @returns (nodes) new number of every node
inline std::vector<Index> renumber(mesh::Mesh& m, std::mt19937& random) {
    std::vector<Index> to(m.nodes.size());
    std::iota(to.begin(), to.end(), 0);
    std::shuffle(to.begin(), to.end(), random);
    std::vector<Vec3> nodes(m.nodes.size());
    for (std::size_t i = 0; i < to.size(); ++i) nodes[static_cast<std::size_t>(to[i])] = m.nodes[i];
    m.nodes = nodes;
    auto ids = m.node_ids;
    for (std::size_t i = 0; i < ids.size(); ++i) m.node_ids[static_cast<std::size_t>(to[i])] = ids[i];
    const auto moved = [&](Index node) { return to[static_cast<std::size_t>(node)]; };
    std::vector<std::vector<Index>> element_to;
    for (mesh::ElementBlock& block : m.blocks) {
        const auto n = static_cast<std::size_t>(mesh::nodes_per_cell(block.type));
        std::vector<Index> order(static_cast<std::size_t>(block.size())), place(order.size());
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), random);
        std::vector<Index> connectivity;
        for (std::size_t e = 0; e < order.size(); ++e) {
            place[static_cast<std::size_t>(order[e])] = static_cast<Index>(e);
            for (std::size_t k = 0; k < n; ++k)
                connectivity.push_back(moved(block.connectivity[static_cast<std::size_t>(order[e]) * n + k]));
        }
        block.connectivity = connectivity;
        element_to.push_back(place);
    }
    for (auto& [name, list] : m.node_sets) {
        for (Index& node : list) node = moved(node);
        std::ranges::sort(list);
    }
    for (auto& [name, facets] : m.surfaces) {
        for (mesh::Facet& facet : facets) {
            for (int c = 0; c < facet.count; ++c)
                facet.nodes[static_cast<std::size_t>(c)] = moved(facet.nodes[static_cast<std::size_t>(c)]);
            if (facet.block >= 0 && facet.element >= 0)
                facet.element =
                    element_to[static_cast<std::size_t>(facet.block)][static_cast<std::size_t>(facet.element)];
        }
        std::shuffle(facets.begin(), facets.end(), random);
    }
    return to;
}

} // namespace osculate::support
