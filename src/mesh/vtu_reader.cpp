#include "osculate/mesh/vtu_reader.hpp"

#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/quality.hpp"
#include "osculate/mesh/vtk_threads.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osculate::mesh {
namespace {

/// Takes VTK's errors and warnings, which would otherwise go to the terminal, and keeps the first error.
class ErrorCollector : public vtkCommand {
public:
    static ErrorCollector* New() { return new ErrorCollector; }
    vtkTypeMacro(ErrorCollector, vtkCommand)

        void Execute(vtkObject*, unsigned long event, void* text) override {
        if (event == vtkCommand::ErrorEvent && first_.empty() && text != nullptr) first_ = static_cast<char*>(text);
    }

    /// The first message without VTK's preamble of source file, line and address; empty when all went well.
    [[nodiscard]] std::string reason() const {
        std::string text = first_;
        if (const auto preamble = text.find("): "); preamble != std::string::npos) text.erase(0, preamble + 3);
        while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
        return first_.empty() || !text.empty() ? text : "VTK cannot read it";
    }

private:
    std::string first_;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
    throw std::runtime_error(path.string() + ": " + reason);
}

/// Our type of a VTK cell and the place of every node of ours among VTK's.
struct Translation {
    CellType type;
    std::array<int, 10> nodes;
};

constexpr Translation tet{CellType::tet4, {0, 1, 2, 3}};
constexpr Translation wedge{CellType::wedge6, {0, 1, 2, 3, 4, 5}};
constexpr Translation hex{CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}};
constexpr Translation quadratic_tet{CellType::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
constexpr Translation voxel{CellType::hex8, {0, 1, 3, 2, 4, 5, 7, 6}};

const Translation* translation(int vtk_type) {
    switch (vtk_type) {
    case VTK_TETRA: return &tet;
    case VTK_QUADRATIC_TETRA: return &quadratic_tet;
    case VTK_WEDGE: return &wedge;
    case VTK_HEXAHEDRON: return &hex;
    case VTK_VOXEL: return &voxel;
    default: return nullptr;
    }
}

bool is_volume(int vtk_type) {
    const vtkSmartPointer<vtkCell> cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(vtk_type));
    return cell != nullptr && cell->GetCellDimension() == 3;
}

/// Nodes of one cell in our order, with the volume checked.
std::vector<Index> cell_nodes(const std::filesystem::path& path, vtkIdType id, const Translation& to, vtkIdType count,
                              const vtkIdType* points, const std::vector<Vec3>& positions) {
    const int expected = nodes_per_cell(to.type);
    if (count != expected) fail(path, "cell " + std::to_string(id) + " has the wrong number of points");
    std::vector<Index> nodes(expected);
    for (int i = 0; i < expected; ++i) {
        const vtkIdType point = points[to.nodes[i]];
        if (point < 0 || point >= static_cast<vtkIdType>(positions.size()))
            fail(path, "cell " + std::to_string(id) + " has a point that does not exist");
        nodes[i] = static_cast<Index>(point);
    }
    double volume = cell_volume(to.type, nodes, positions);
    if (to.type == CellType::wedge6 && volume < 0) {
        // Many programs write the triangle (0, 1, 2) facing inward, against VTK's definition: the same solid.
        std::swap(nodes[1], nodes[2]);
        std::swap(nodes[4], nodes[5]);
        volume = -volume;
    }
    if (!(volume > 0)) fail(path, "cell " + std::to_string(id) + " is inverted or flat: its volume is not positive");
    return nodes;
}

/// Drops the nodes that no element uses; returns the new number of every old node, -1 for the dropped.
std::vector<Index> compact(Mesh& mesh) {
    std::vector<Index> number(mesh.nodes.size(), -1);
    for (const ElementBlock& block : mesh.blocks)
        for (const Index node : block.connectivity) number[node] = 0;
    Index count = 0;
    for (std::size_t n = 0; n < number.size(); ++n)
        if (number[n] == 0) {
            mesh.nodes[count] = mesh.nodes[n];
            number[n] = count++;
        }
    mesh.nodes.resize(count);
    for (ElementBlock& block : mesh.blocks)
        for (Index& node : block.connectivity) node = number[node];
    return number;
}

bool is_membership(vtkDataArray& array) {
    if (array.GetNumberOfComponents() != 1 || array.GetName() == nullptr) return false;
    if (std::strcmp(array.GetName(), "vtkGhostType") == 0) return false;
    if (array.GetDataType() == VTK_FLOAT || array.GetDataType() == VTK_DOUBLE) return false;
    for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i)
        if (const double value = array.GetComponent(i, 0); value != 0 && value != 1) return false;
    return true;
}

void name_sets(vtkPointData& data, const std::vector<Index>& number, Mesh& mesh) {
    const std::vector<Facet> exterior = exterior_facets(mesh);
    for (int a = 0; a < data.GetNumberOfArrays(); ++a) {
        vtkDataArray* array = data.GetArray(a);
        if (array == nullptr || !is_membership(*array)) continue;
        std::vector<char> member(mesh.nodes.size(), 0);
        auto& set = mesh.node_sets[array->GetName()];
        for (std::size_t n = 0; n < number.size(); ++n)
            if (number[n] >= 0 && array->GetComponent(static_cast<vtkIdType>(n), 0) == 1) {
                set.push_back(number[n]);
                member[number[n]] = 1;
            }
        for (const Facet& facet : exterior)
            if (std::all_of(facet.begin(), facet.end(), [&](Index node) { return member[node] != 0; }))
                mesh.surfaces[array->GetName()].push_back(facet);
    }
}

} // namespace

Mesh read_vtu(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) fail(path, "no such file");
    if (!std::filesystem::is_regular_file(path)) fail(path, "not a file");
    use_no_vtk_threads();
    const vtkNew<ErrorCollector> errors;
    const vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, errors);
    reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->SetReaderErrorObserver(errors);
    reader->SetParserErrorObserver(errors);
    reader->SetFileName(path.c_str());
    const WithoutTraps vtk;
    reader->Update();
    if (const std::string reason = errors->reason(); !reason.empty()) fail(path, reason);
    vtkUnstructuredGrid* grid = reader->GetOutput();
    if (grid == nullptr || grid->GetNumberOfCells() == 0) fail(path, "no cells");
    if (grid->GetNumberOfPoints() > std::numeric_limits<Index>::max() / 3) fail(path, "too many points");

    Mesh mesh;
    mesh.nodes.resize(grid->GetNumberOfPoints());
    for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p) grid->GetPoint(p, mesh.nodes[p].data());

    std::array<ElementBlock, 4> blocks{
        {{CellType::hex8, {}}, {CellType::wedge6, {}}, {CellType::tet4, {}}, {CellType::tet10, {}}}};
    for (vtkIdType id = 0; id < grid->GetNumberOfCells(); ++id) {
        const int vtk_type = grid->GetCellType(id);
        const Translation* to = translation(vtk_type);
        if (to == nullptr && is_volume(vtk_type))
            fail(path, "cell " + std::to_string(id) + " is a " + vtkCellTypes::GetClassNameFromTypeId(vtk_type) +
                           " (type " + std::to_string(vtk_type) +
                           "); only tetrahedra of 4 or 10 nodes, wedges, hexahedra and voxels are read");
        if (to == nullptr) continue;
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        grid->GetCells()->GetCellAtId(id, count, points);
        const std::vector<Index> nodes = cell_nodes(path, id, *to, count, points, mesh.nodes);
        for (ElementBlock& block : blocks)
            if (block.type == to->type) block.connectivity.insert(block.connectivity.end(), nodes.begin(), nodes.end());
    }
    for (ElementBlock& block : blocks)
        if (block.size() > 0) mesh.blocks.push_back(std::move(block));
    if (mesh.blocks.empty()) fail(path, "no volume cells");

    const std::vector<Index> number = compact(mesh);
    name_sets(*grid->GetPointData(), number, mesh);
    return mesh;
}

} // namespace osculate::mesh
