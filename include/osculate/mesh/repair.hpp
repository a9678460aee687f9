#pragma once
/// Faults of meshes from files, and which of them are to be mended.

#include "osculate/mesh/raw_mesh.hpp"

#include <string>
#include <vector>

namespace osculate::mesh {

/// Faults that can be mended. All but coincident nodes, which two bodies in one file may well have, make a mesh unfit.
enum class Repair {
    inverted,   ///< a cell with a negative volume: its nodes are put into the order that makes it positive
    degenerate, ///< a cell with a node twice or without volume: a hexahedron that is a wedge becomes one; flat ones go
    duplicate,  ///< a cell of the same nodes as one before: it goes
    dangling_nodes,   ///< nodes that nothing in the file uses: they go
    coincident_nodes, ///< nodes at one place: they become the first of them
    non_manifold,     ///< parts of the body that touch at a node or an edge alone: each gets nodes of its own
};
inline constexpr int repair_count = 6;
/// In the order of the enumerators, as in scenes.
[[nodiscard]] const std::vector<std::string>& repair_words();

struct Repairs {
    std::array<bool, repair_count> wanted{};
    [[nodiscard]] bool operator[](Repair r) const { return wanted[static_cast<std::size_t>(r)]; }
    bool operator==(const Repairs&) const = default;
};

/// Finds faults among the cells of `raw`, and mends those wanted, in place. O(n log n) in the number of cells.
struct MeshFaults {
    std::vector<std::string>
        faults; ///< one sentence each with the file's numbers, 20 of a kind at most; empty: fit for use
    std::vector<std::string> notes; ///< what was mended, and coincident nodes that were not
};
[[nodiscard]] MeshFaults find_and_mend(RawMesh& raw, const Repairs& repairs);

/// Nodes closer than this part of the mesh's extent stand at one place.
inline constexpr double coincidence = 1e-9;

} // namespace osculate::mesh
