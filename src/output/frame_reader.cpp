#include "osculate/output/frame_reader.hpp"

#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/vtk_threads.hpp"

#include <charconv>
#include <map>
#include <stdexcept>
#include <vtkCell.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osculate::output {

namespace fs = std::filesystem;

namespace {

Array copy_of(vtkDataArray& values) {
    Array array{values.GetName() == nullptr ? "" : values.GetName(), values.GetNumberOfComponents(), {}};
    for (vtkIdType i = 0; i < values.GetNumberOfTuples(); ++i)
        for (int c = 0; c < array.components; ++c) array.values.push_back(values.GetComponent(i, c));
    array.integer = vtkIntArray::SafeDownCast(&values) != nullptr;
    return array;
}

/// Reads a file and hands its content to `take`.
template <class Reader, class Take> auto read_by(const fs::path& path, const Take& take) {
    std::error_code none;
    if (!fs::is_regular_file(path, none)) throw std::runtime_error("cannot read " + path.string());
    mesh::use_no_vtk_threads();
    vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    const WithoutTraps vtk;
    reader->Update();
    vtkPointSet* data = reader->GetOutput();
    if (reader->GetErrorCode() != 0 || data == nullptr || data->GetNumberOfPoints() == 0)
        throw std::runtime_error("cannot read " + path.string() + ": not a frame of a run");
    return take(*data);
}

template <class Take> auto read(const fs::path& path, const Take& take) {
    return path.extension() == ".vtp" ? read_by<vtkXMLPolyDataReader>(path, take)
                                      : read_by<vtkXMLUnstructuredGridReader>(path, take);
}

Frame frame_of(vtkPointSet& data) {
    Frame frame;
    for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) {
        Vec3 point;
        data.GetPoint(i, point.data());
        frame.points.push_back(point);
    }
    for (int a = 0; a < data.GetPointData()->GetNumberOfArrays(); ++a)
        if (vtkDataArray* values = data.GetPointData()->GetArray(a)) frame.arrays.push_back(copy_of(*values));
    if (vtkDataArray* time = data.GetFieldData()->GetArray("TimeValue")) frame.time = time->GetComponent(0, 0);
    return frame;
}

std::vector<mesh::Facet> facets_of(vtkPointSet& data) {
    std::vector<mesh::Facet> polygons;
    std::map<mesh::CellType, mesh::ElementBlock> blocks;
    for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i) {
        vtkCell* cell = data.GetCell(i);
        const int count = static_cast<int>(cell->GetNumberOfPoints());
        const mesh::CellInfo* solid =
            mesh::find_cell_type([&](const mesh::CellInfo& info) { return info.vtk == cell->GetCellType(); });
        if (solid != nullptr) {
            mesh::ElementBlock& block = blocks[solid->type];
            block.type = solid->type;
            for (int c = 0; c < count; ++c) block.connectivity.push_back(static_cast<Index>(cell->GetPointId(c)));
        } else if (cell->GetCellDimension() == 2 && (count == 3 || count == 4)) {
            mesh::Facet& facet = polygons.emplace_back();
            facet.count = count;
            for (int c = 0; c < count; ++c)
                facet.nodes[static_cast<std::size_t>(c)] = static_cast<Index>(cell->GetPointId(c));
        }
    }
    if (blocks.empty()) return polygons;
    mesh::Mesh mesh;
    mesh.nodes.resize(static_cast<std::size_t>(data.GetNumberOfPoints()));
    for (auto& [type, block] : blocks) mesh.blocks.push_back(std::move(block));
    std::vector<mesh::Facet> exterior = mesh::exterior_facets(mesh);
    polygons.insert(polygons.end(), exterior.begin(), exterior.end());
    return polygons;
}

} // namespace

const Array* Frame::find(const std::string& name) const {
    for (const Array& array : arrays)
        if (array.name == name) return &array;
    return nullptr;
}

Frame read_frame(const fs::path& path) {
    return read(path, frame_of);
}

std::vector<mesh::Facet> read_facets(const fs::path& path) {
    return read(path, facets_of);
}

std::optional<fs::path> last_frame(const fs::path& folder, const std::string& part) {
    std::optional<fs::path> last;
    long largest = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "frames", error)) {
        const std::string stem = entry.path().stem().string(), extension = entry.path().extension().string();
        if (!stem.starts_with(part + "_") || (extension != ".vtp" && extension != ".vtu")) continue;
        long number = 0;
        const auto [end, problem] = std::from_chars(stem.data() + part.size() + 1, stem.data() + stem.size(), number);
        if (problem != std::errc{} || end != stem.data() + stem.size() || number <= largest) continue;
        largest = number;
        last = entry.path();
    }
    return last;
}

} // namespace osculate::output
