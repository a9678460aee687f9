#include "osculate/output/piece.hpp"

#include "output/elements.hpp"

#include <algorithm>

namespace osculate::output {

Piece piece_of(const model::Body& body, const Share& share) {
    Piece piece;
    std::vector<char> is_here(static_cast<std::size_t>(body.nodes()), 0),
        has_one(static_cast<std::size_t>(share.ranks().count()), 0);
    for (const mesh::ElementBlock& block : body.mesh.blocks) piece.blocks.push_back({block.type, {}, block.section});
    for_each_element(body, [&](const ElementOf& element) {
        const std::vector<Index> nodes = nodes_of(body, element);
        const int owner = share.owner()[static_cast<std::size_t>(body.first_node + nodes.front())];
        has_one[static_cast<std::size_t>(owner)] = 1;
        if (owner != share.ranks().rank()) return;
        std::vector<Index>& own = piece.blocks[static_cast<std::size_t>(element.block)].connectivity;
        own.insert(own.end(), nodes.begin(), nodes.end());
        for (const Index node : nodes) is_here[static_cast<std::size_t>(node)] = 1;
    });
    for_each_element(body, [&](const ElementOf& element) {
        const std::vector<Index> nodes = nodes_of(body, element);
        piece.around.push_back(
            std::ranges::any_of(nodes, [&](Index node) { return is_here[static_cast<std::size_t>(node)] != 0; }));
    });
    std::vector<Index> point(is_here.size(), -1);
    for (Index node = 0; node < body.nodes(); ++node)
        if (is_here[static_cast<std::size_t>(node)] != 0) {
            point[static_cast<std::size_t>(node)] = static_cast<Index>(piece.nodes.size());
            piece.nodes.push_back(node);
        }
    for (mesh::ElementBlock& block : piece.blocks)
        for (Index& node : block.connectivity) node = point[static_cast<std::size_t>(node)];
    for (std::size_t rank = 0; rank < has_one.size(); ++rank)
        if (has_one[rank] != 0) piece.processes.push_back(static_cast<int>(rank));
    return piece;
}

} // namespace osculate::output
