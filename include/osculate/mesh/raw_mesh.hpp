#pragma once
/// Content of a mesh file, with the numbers used in the file, before a body is made of it.

#include "osculate/mesh/instances.hpp"
#include "osculate/mesh/mesh.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace osculate::mesh {

/// A volume cell; nodes in the order of `CellType`.
struct RawCell {
    std::int64_t id = 0; ///< the file's
    CellType type = CellType::hex8;
    int section = 0; ///< ElementBlock::section
    std::array<Index, most_nodes_per_cell> nodes = none();

    [[nodiscard]] int count() const { return nodes_per_cell(type); }
    [[nodiscard]] auto begin() const { return nodes.begin(); }
    [[nodiscard]] auto end() const { return nodes.begin() + count(); }

private:
    static constexpr std::array<Index, most_nodes_per_cell> none() {
        std::array<Index, most_nodes_per_cell> all{};
        all.fill(-1);
        return all;
    }
};

/// A face of a cell by its points, in any orientation, otherwise in the order of FaceShape.
struct RawFace {
    std::array<Index, most_nodes_per_face> nodes{-1, -1, -1, -1, -1, -1, -1, -1};
    int count = 0;
};

struct RawMesh {
    std::string file;
    std::vector<Vec3> points;
    std::vector<std::int64_t> point_ids; ///< the file's
    std::vector<char> elsewhere;         ///< per point: used by a cell that is not a volume or not in this mesh
    std::vector<RawCell> cells;
    std::map<std::string, std::vector<Index>> node_sets;
    std::map<std::string, std::vector<RawFace>> surfaces;
    std::map<std::string, std::vector<Index>> parts; ///< named sets of cells
    bool sets_are_surfaces = false; ///< the exterior facets of a node set are the surface with its name
    Instances instances;            ///< whose numbers those of points and cells are
    const char* cell_word = "element";
    const char* point_word = "node";
};

} // namespace osculate::mesh
