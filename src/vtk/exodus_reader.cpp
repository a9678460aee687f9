#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/vtk_threads.hpp"
#include "vtk/cell_translation.hpp"
#include "vtk/readers.hpp"
#include "vtk/vtk_errors.hpp"

#include <array>
#include <fstream>
#include <functional>
#include <string_view>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkCompositeDataSet.h>
#include <vtkExodusIIReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtk_exodusII.h>

namespace osculate::vtk {

using namespace mesh;
namespace {

/// Whether a file begins as Exodus files do; the library would print a report about any other.
bool is_netcdf(const std::filesystem::path& path) {
    std::array<char, 4> start{};
    std::ifstream(path, std::ios::binary).read(start.data(), start.size());
    const std::string_view text(start.data(), start.size());
    return text.starts_with("CDF") || text == "\x89HDF";
}

/// The file's name of a block or a set; VTK makes one up where there is none.
std::string name_of(vtkExodusIIReader& reader, int kind, int index, const char* otherwise) {
    const char* name = reader.GetObjectName(kind, index);
    if (name != nullptr && *name != '\0' && !std::string_view(name).starts_with("Unnamed ")) return name;
    return std::string(otherwise) + "_" + std::to_string(reader.GetObjectId(kind, index));
}

vtkUnstructuredGrid* grid_of(vtkMultiBlockDataSet& all, unsigned kind, unsigned index) {
    auto* kinds = vtkMultiBlockDataSet::SafeDownCast(kind < all.GetNumberOfBlocks() ? all.GetBlock(kind) : nullptr);
    if (kinds == nullptr || index >= kinds->GetNumberOfBlocks()) return nullptr;
    return vtkUnstructuredGrid::SafeDownCast(kinds->GetBlock(index));
}

/// Points of every cell of a grid, all of which must exist.
void for_cells(const RawMesh& raw, vtkUnstructuredGrid& grid,
               const std::function<void(int type, vtkIdType count, const vtkIdType* points)>& visit) {
    for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        grid.GetCells()->GetCellAtId(c, count, points);
        for (vtkIdType i = 0; i < count; ++i)
            if (points[i] < 0 || points[i] >= static_cast<vtkIdType>(raw.points.size()))
                throw MeshError(raw.file, "a set has a node that does not exist");
        visit(grid.GetCellType(c), count, points);
    }
}

RawFace face_of(const std::string& file, const std::string& set, int type, vtkIdType count, const vtkIdType* points) {
    RawFace face;
    const FaceShape* const shape = find_face_shape([&](const FaceShape& s) { return s.vtk == type; });
    if (shape != nullptr) face.count = shape->nodes;
    if (shape == nullptr || face.count != count)
        throw MeshError(file, "side set '" + set + "' has faces that are neither triangles nor quadrilaterals");
    for (int i = 0; i < face.count; ++i) face.nodes[i] = static_cast<Index>(points[i]);
    return face;
}

} // namespace

RawMesh read_exodus(const std::filesystem::path& path) {
    if (!is_netcdf(path)) throw MeshError(path.string(), "not an Exodus II file");
    use_no_vtk_threads();
    const vtkNew<VtkErrors> errors;
    const vtkNew<vtkExodusIIReader> reader;
    errors->listen_to(*reader);
    reader->SetFileName(path.c_str());
    const WithoutTraps vtk;
    ex_opts(0); // prints nothing
    if (reader->CanReadFile(path.c_str()) == 0) throw MeshError(path.string(), "not an Exodus II file");
    reader->UpdateInformation();
    reader->SetSqueezePoints(false); // every block has all the points, so that numbers mean the same in all
    reader->SetApplyDisplacements(0);
    constexpr int blocks = vtkExodusIIReader::ELEM_BLOCK, node_sets = vtkExodusIIReader::NODE_SET,
                  side_sets = vtkExodusIIReader::SIDE_SET;
    for (const int kind : {blocks, node_sets, side_sets})
        for (int i = 0; i < reader->GetNumberOfObjects(kind); ++i) reader->SetObjectStatus(kind, i, 1);
    reader->Update();

    RawMesh raw;
    raw.file = path.string();
    if (const std::string reason = errors->reason(); !reason.empty()) throw MeshError(raw.file, reason);
    vtkMultiBlockDataSet& all = *reader->GetOutput();
    std::int64_t next = 1;
    // Kinds in VTK's order: element, face and edge blocks, element, side, face, edge and node sets.
    constexpr unsigned block_place = 0, side_place = 4, node_place = 7;
    for (int b = 0; b < reader->GetNumberOfObjects(blocks); ++b) {
        vtkUnstructuredGrid* grid = grid_of(all, block_place, b);
        if (grid == nullptr) continue;
        if (raw.points.empty()) add_points(raw, *grid, 1);
        std::vector<Index> part;
        for (const Index cell : add_cells(raw, *grid, next))
            if (cell >= 0) part.push_back(cell);
        next += grid->GetNumberOfCells();
        if (!part.empty()) raw.parts[name_of(*reader, blocks, b, "block")] = std::move(part);
    }
    if (raw.cells.empty()) throw MeshError(raw.file, "no volume cells");
    for (int s = 0; s < reader->GetNumberOfObjects(side_sets); ++s) {
        vtkUnstructuredGrid* grid = grid_of(all, side_place, s);
        if (grid == nullptr) continue;
        const std::string name = name_of(*reader, side_sets, s, "side_set");
        for_cells(raw, *grid, [&](int type, vtkIdType count, const vtkIdType* points) {
            raw.surfaces[name].push_back(face_of(raw.file, name, type, count, points));
        });
    }
    for (int s = 0; s < reader->GetNumberOfObjects(node_sets); ++s) {
        vtkUnstructuredGrid* grid = grid_of(all, node_place, s);
        if (grid == nullptr) continue;
        std::vector<Index>& set = raw.node_sets[name_of(*reader, node_sets, s, "node_set")];
        for_cells(raw, *grid, [&](int, vtkIdType count, const vtkIdType* points) {
            for (vtkIdType i = 0; i < count; ++i) set.push_back(static_cast<Index>(points[i]));
        });
    }
    return raw;
}

} // namespace osculate::vtk
