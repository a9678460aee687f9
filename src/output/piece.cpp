#include "osculate/output/piece.hpp"

#include "output/elements.hpp"

#include <algorithm>

namespace osculate::output {

namespace {
/// (elements of the body) Of each the process that owns most of its nodes. Where several own as many, as between two parts of a
/// mesh of bricks, the whole border goes to one of them: to the lower of some pairs, to the higher of others.
std::vector<int> owners_of_elements(const model::Body& body, const Share& share) {
    std::vector<int> owners, own, most;
    for_each_element(body, [&](const ElementOf& element) {
        own.clear();
        for (const Index node : nodes_of(body, element))
            own.push_back(share.owner()[static_cast<std::size_t>(body.first_node + node)]);
        std::ranges::sort(own);
        std::ptrdiff_t times = 0;
        most.clear();
        for (auto at = own.begin(); at != own.end();) {
            const auto end = std::upper_bound(at, own.end(), *at);
            if (end - at > times) most.clear();
            if (end - at >= times) most.push_back(*at);
            times = std::max(times, end - at);
            at = end;
        }
        owners.push_back(most[static_cast<std::size_t>(most.front() + most.back()) % most.size()]);
    });
    return owners;
}
} // namespace

Piece piece_of(const model::Body& body, const Share& share) {
    Piece piece;
    std::vector<char> is_here(static_cast<std::size_t>(body.nodes()), 0),
        has_one(static_cast<std::size_t>(share.ranks().count()), 0);
    for (const mesh::ElementBlock& block : body.mesh.blocks) piece.blocks.push_back({block.type, {}, block.section});
    const std::vector<int> owners = owners_of_elements(body, share);
    for (const int owner : owners) has_one[static_cast<std::size_t>(owner)] = 1;
    std::size_t number = 0;
    for_each_element(body, [&](const ElementOf& element) {
        if (owners[number++] != share.ranks().rank()) return;
        const std::vector<Index> nodes = nodes_of(body, element);
        std::vector<Index>& own = piece.blocks[static_cast<std::size_t>(element.block)].connectivity;
        own.insert(own.end(), nodes.begin(), nodes.end());
        for (const Index node : nodes) is_here[static_cast<std::size_t>(node)] = 1;
    });
    for_each_element(body, [&](const ElementOf& element) {
        const std::vector<Index> nodes = nodes_of(body, element);
        piece.around.push_back(
            std::ranges::any_of(nodes, [&](Index node) { return is_here[static_cast<std::size_t>(node)] != 0; }));
    });
    piece.point.assign(is_here.size(), -1);
    for (Index node = 0; node < body.nodes(); ++node)
        if (is_here[static_cast<std::size_t>(node)] != 0) {
            piece.point[static_cast<std::size_t>(node)] = static_cast<Index>(piece.nodes.size());
            piece.nodes.push_back(node);
        }
    for (mesh::ElementBlock& block : piece.blocks)
        for (Index& node : block.connectivity) node = piece.point[static_cast<std::size_t>(node)];
    for (std::size_t rank = 0; rank < has_one.size(); ++rank)
        if (has_one[rank] != 0) piece.processes.push_back(static_cast<int>(rank));
    return piece;
}

std::vector<long> elements_of_processes(const model::Model& model, const Share& share) {
    std::vector<long> count(static_cast<std::size_t>(share.ranks().count()), 0);
    for (const model::Body& body : model.bodies)
        for (const int owner : owners_of_elements(body, share)) ++count[static_cast<std::size_t>(owner)];
    return count;
}

} // namespace osculate::output
