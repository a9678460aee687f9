#include "vtk/cell_translation.hpp"

#include "osculate/mesh/mesh_error.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkGenericCell.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

namespace osculate::vtk {

using namespace mesh;
namespace {

constexpr NodeOrder as_it_is = [] {
    NodeOrder order{};
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    return order;
}();
constexpr NodeOrder of_a_voxel{0, 1, 3, 2, 4, 5, 7, 6};

/// Our type of a VTK cell and the place of every node of ours among VTK's.
struct Translation {
    const CellInfo* to;
    const NodeOrder& nodes;
};

constexpr std::size_t most_values = 10000; // of an array whose values name parts

Translation translation(int vtk_type) {
    if (vtk_type == VTK_VOXEL) return {&cell_info(CellType::hex8), of_a_voxel};
    return {find_cell_type([&](const CellInfo& info) { return info.vtk == vtk_type; }), as_it_is};
}

bool is_volume(int vtk_type) {
    const vtkSmartPointer<vtkCell> cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(vtk_type));
    return cell != nullptr && cell->GetCellDimension() == 3;
}

/// An integer array that may name sets, or nullptr.
vtkDataArray* naming(vtkDataArray* array) {
    if (array == nullptr || array->GetNumberOfComponents() != 1 || array->GetName() == nullptr) return nullptr;
    if (std::strcmp(array->GetName(), "vtkGhostType") == 0) return nullptr;
    return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE ? nullptr : array;
}

bool is_membership(vtkDataArray& array) {
    for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i)
        if (const double value = array.GetComponent(i, 0); value != 0 && value != 1) return false;
    return true;
}

void add_parts(RawMesh& raw, vtkDataArray& array, const std::vector<Index>& cells) {
    const std::string name = array.GetName();
    const bool membership = is_membership(array);
    std::map<long long, std::vector<Index>> by_value;
    for (std::size_t c = 0; c < cells.size(); ++c)
        if (cells[c] >= 0) {
            by_value[static_cast<long long>(array.GetComponent(static_cast<vtkIdType>(c), 0))].push_back(cells[c]);
            if (by_value.size() > most_values) return; // numbers, not names
        }
    for (const auto& [value, list] : by_value) {
        if (membership && value == 1) raw.parts[name] = list;
        raw.parts[name + "=" + std::to_string(value)] = list;
    }
}

} // namespace

void add_points(RawMesh& raw, vtkUnstructuredGrid& grid, std::int64_t first_id) {
    if (grid.GetNumberOfPoints() > std::numeric_limits<Index>::max() / 3) throw MeshError(raw.file, "too many points");
    raw.points.resize(grid.GetNumberOfPoints());
    raw.point_ids.resize(raw.points.size());
    raw.elsewhere.assign(raw.points.size(), 0);
    for (vtkIdType p = 0; p < grid.GetNumberOfPoints(); ++p) {
        grid.GetPoint(p, raw.points[p].data());
        raw.point_ids[p] = first_id + p;
    }
}

std::vector<Index> add_cells(RawMesh& raw, vtkUnstructuredGrid& grid, std::int64_t first_id) {
    const auto points_in_all = static_cast<vtkIdType>(raw.points.size());
    std::vector<Index> numbers(grid.GetNumberOfCells(), -1);
    raw.cells.reserve(raw.cells.size() + numbers.size());
    std::array<signed char, 256> volume{}; // per type of VTK's: 0 not looked at yet, 1 yes, -1 no
    for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
        const int vtk_type = grid.GetCellType(c);
        const auto fail = [&](const std::string& what) {
            throw MeshError(raw.file, raw.cell_word + (" " + std::to_string(first_id + c)) + what);
        };
        const auto [to, order] = translation(vtk_type);
        if (to == nullptr) {
            signed char& known = volume[static_cast<unsigned char>(vtk_type)];
            if (known == 0) known = is_volume(vtk_type) ? 1 : -1;
            if (known > 0)
                fail(std::string(" is a ") + vtkCellTypes::GetClassNameFromTypeId(vtk_type) + " (type " +
                     std::to_string(vtk_type) + "); only " + cell_names("and", [](const CellInfo&) { return true; }) +
                     ", and voxels, are read");
        }
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        grid.GetCells()->GetCellAtId(c, count, points);
        if (to != nullptr && count != to->nodes) fail(" has the wrong number of points");
        if (std::any_of(points, points + count, [&](vtkIdType p) { return p < 0 || p >= points_in_all; }))
            fail(" has a point that does not exist");
        if (to == nullptr) {
            for (vtkIdType i = 0; i < count; ++i) raw.elsewhere[points[i]] = 1;
            continue;
        }
        RawCell& cell = raw.cells.emplace_back();
        cell.id = first_id + c;
        cell.type = to->type;
        for (int i = 0; i < cell.count(); ++i)
            cell.nodes[i] = static_cast<Index>(points[order[static_cast<std::size_t>(i)]]);
        numbers[c] = static_cast<Index>(raw.cells.size()) - 1;
    }
    return numbers;
}

void add_sets(RawMesh& raw, vtkUnstructuredGrid& grid, const std::vector<Index>& cells) {
    vtkPointData& points = *grid.GetPointData();
    for (int a = 0; a < points.GetNumberOfArrays(); ++a) {
        vtkDataArray* array = naming(points.GetArray(a));
        if (array == nullptr || !is_membership(*array)) continue;
        std::vector<Index>& set = raw.node_sets[array->GetName()];
        for (std::size_t p = 0; p < raw.points.size(); ++p)
            if (array->GetComponent(static_cast<vtkIdType>(p), 0) == 1) set.push_back(static_cast<Index>(p));
    }
    vtkCellData& data = *grid.GetCellData();
    for (int a = 0; a < data.GetNumberOfArrays(); ++a)
        if (vtkDataArray* array = naming(data.GetArray(a))) add_parts(raw, *array, cells);
}

} // namespace osculate::vtk
