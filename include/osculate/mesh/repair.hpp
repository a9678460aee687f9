#pragma once
/// Faults of meshes from files, and options to repair them.

#include "osculate/mesh/raw_mesh.hpp"

#include <string>
#include <vector>

namespace osculate::mesh {

/// Faults that can be repaired. A mesh with any of them is unfit for use, except coincident nodes, which are legitimate
/// between two bodies in one file.
enum class Repair {
    inverted,   ///< a cell with a negative volume: its nodes are reordered to make the volume positive
    degenerate, ///< a cell with a repeated node or no volume: a hexahedron that is a wedge becomes one; flat cells go
    duplicate,  ///< a cell with the same nodes as an earlier one: it is removed
    dangling_nodes,    ///< nodes that nothing in the file uses: they are removed
    coincident_nodes,  ///< nodes at the same place: the first of them replaces the others
    non_manifold,      ///< parts of the body that touch only at a node or an edge: each gets its own nodes
    keep_non_manifold, ///< the same: they stay joined there, and no contact has such a surface for a master
};
inline constexpr int repair_count = 7;
/// In the order of the enumerators, as in scenes.
[[nodiscard]] const std::vector<std::string>& repair_words();

struct Repairs {
    std::array<bool, repair_count> wanted{};
    [[nodiscard]] bool operator[](Repair r) const { return wanted[static_cast<std::size_t>(r)]; }
    bool operator==(const Repairs&) const = default;
};

/// Finds faults among the cells of `raw`, and repairs the wanted kinds in place. O(n log n) in the number of cells.
struct MeshFaults {
    std::vector<std::string>
        faults; ///< one sentence each with the file's numbers, 20 of a kind at most; empty: fit for use
    std::vector<std::string> notes; ///< what was repaired, and coincident nodes that were not
};
[[nodiscard]] MeshFaults find_and_mend(RawMesh& raw, const Repairs& repairs);

/// Nodes closer than this fraction of the mesh's extent are at the same place.
inline constexpr double coincidence = 1e-9;

} // namespace osculate::mesh
