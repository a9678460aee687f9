#pragma once
/// The part of a body that one of several processes writes.

#include "osculate/core/ranks.hpp"
#include "osculate/model/model.hpp"

#include <vector>

namespace osculate::output {

/// The elements most of whose nodes belong to a process, and their nodes.
struct Piece {
    std::vector<Index> nodes;               ///< of the body, ascending: point by point
    std::vector<mesh::ElementBlock> blocks; ///< as those of the body; connectivity in points
    std::vector<char>
        around; ///< (elements of the body) whether one has a node here: they give the mean values of these nodes
    std::vector<Index> point;   ///< (nodes of the body) where it is in `nodes`; -1: elsewhere
    std::vector<int> processes; ///< those that have a piece of this body, ascending

    [[nodiscard]] model::BodyPart part() const { return {around, point, static_cast<Index>(nodes.size())}; }
};

/// Piece of the calling process. O(elements)
[[nodiscard]] Piece piece_of(const model::Body& body, const Share& share);
/// (ranks) number of elements in the pieces of each, of all bodies.
[[nodiscard]] std::vector<long> elements_of_processes(const model::Model& model, const Share& share);

} // namespace osculate::output
