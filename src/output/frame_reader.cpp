#include "osculate/output/frame_reader.hpp"

#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/vtk_threads.hpp"
#include "osculate/output/vtk_pieces.hpp"

#include <algorithm>
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

bool is_in_pieces(const fs::path& path) {
    return path.extension() == ".pvtu";
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

/// What a file has of a mesh.
struct Cells {
    std::vector<mesh::Facet> polygons;
    std::map<mesh::CellType, mesh::ElementBlock> blocks;
    Index points = 0;
};

/// @param number_of  a point, the number it goes by
template <class Number> void add_cells(vtkPointSet& data, const Number& number_of, Cells& cells) {
    for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i) {
        vtkCell* cell = data.GetCell(i);
        const int count = static_cast<int>(cell->GetNumberOfPoints());
        const mesh::CellInfo* solid =
            mesh::find_cell_type([&](const mesh::CellInfo& info) { return info.vtk == cell->GetCellType(); });
        if (solid != nullptr) {
            mesh::ElementBlock& block = cells.blocks[solid->type];
            block.type = solid->type;
            for (int c = 0; c < count; ++c) block.connectivity.push_back(number_of(cell->GetPointId(c)));
        } else if (cell->GetCellDimension() == 2 && (count == 3 || count == 4)) {
            mesh::Facet& facet = cells.polygons.emplace_back();
            facet.count = count;
            for (int c = 0; c < count; ++c) facet.nodes[static_cast<std::size_t>(c)] = number_of(cell->GetPointId(c));
        }
    }
    for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) cells.points = std::max(cells.points, number_of(i) + 1);
}

std::vector<mesh::Facet> facets_of(Cells cells) {
    if (cells.blocks.empty()) return std::move(cells.polygons);
    mesh::Mesh mesh;
    mesh.nodes.resize(static_cast<std::size_t>(cells.points));
    for (auto& [type, block] : cells.blocks) mesh.blocks.push_back(std::move(block));
    std::vector<mesh::Facet> exterior = mesh::exterior_facets(mesh);
    cells.polygons.insert(cells.polygons.end(), exterior.begin(), exterior.end());
    return std::move(cells.polygons);
}

/// Takes each piece of a list. @param take  piece, numbers of its points in the whole
template <class Take> void read_pieces(const fs::path& path, const Take& take) {
    for (const fs::path& piece : pieces_in(path))
        read(piece, [&](vtkPointSet& data) {
            vtkDataArray* ids = data.GetPointData()->GetGlobalIds();
            if (ids == nullptr) throw std::runtime_error("cannot read " + path.string() + ": a piece without numbers");
            const Array numbers = copy_of(*ids);
            take(data,
                 [&](vtkIdType point) { return static_cast<Index>(numbers.values[static_cast<std::size_t>(point)]); });
        });
}

Frame merged(const fs::path& path) {
    Frame whole;
    read_pieces(path, [&](vtkPointSet& data, const auto& number_of) {
        Frame piece = frame_of(data);
        std::erase_if(piece.arrays, [](const Array& array) { return array.name == point_numbers; });
        whole.time = piece.time;
        std::size_t most = whole.points.size();
        for (std::size_t i = 0; i < piece.points.size(); ++i)
            most = std::max(most, static_cast<std::size_t>(number_of(static_cast<vtkIdType>(i))) + 1);
        whole.points.resize(most);
        if (whole.arrays.empty())
            for (const Array& array : piece.arrays)
                whole.arrays.push_back({array.name, array.components, {}, array.integer, array.unit});
        for (Array& array : whole.arrays) {
            const Array* values = piece.find(array.name);
            if (values == nullptr || values->components != array.components)
                throw std::runtime_error("cannot read " + path.string() + ": pieces hold different arrays");
            array.values.resize(most * static_cast<std::size_t>(array.components));
            const auto n = static_cast<std::ptrdiff_t>(array.components);
            for (std::size_t i = 0; i < piece.points.size(); ++i)
                std::copy_n(values->values.begin() + n * static_cast<std::ptrdiff_t>(i), n,
                            array.values.begin() + n * number_of(static_cast<vtkIdType>(i)));
        }
        for (std::size_t i = 0; i < piece.points.size(); ++i)
            whole.points[static_cast<std::size_t>(number_of(static_cast<vtkIdType>(i)))] = piece.points[i];
    });
    if (whole.points.empty()) throw std::runtime_error("cannot read " + path.string() + ": not a frame of a run");
    return whole;
}

} // namespace

const Array* Frame::find(const std::string& name) const {
    for (const Array& array : arrays)
        if (array.name == name) return &array;
    return nullptr;
}

Frame read_frame(const fs::path& path) {
    return is_in_pieces(path) ? merged(path) : read(path, frame_of);
}

std::vector<mesh::Facet> read_facets(const fs::path& path) {
    Cells cells;
    if (is_in_pieces(path))
        read_pieces(path, [&](vtkPointSet& data, const auto& number_of) { add_cells(data, number_of, cells); });
    else
        read(path, [&](vtkPointSet& data) {
            add_cells(
                data, [](vtkIdType point) { return static_cast<Index>(point); }, cells);
        });
    return facets_of(std::move(cells));
}

std::optional<fs::path> last_frame(const fs::path& folder, const std::string& part) {
    std::optional<fs::path> last;
    long largest = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "frames", error)) {
        const std::string stem = entry.path().stem().string(), extension = entry.path().extension().string();
        if (!stem.starts_with(part + "_") || (extension != ".vtp" && extension != ".vtu" && extension != ".pvtu"))
            continue;
        long number = 0;
        const auto [end, problem] = std::from_chars(stem.data() + part.size() + 1, stem.data() + stem.size(), number);
        if (problem != std::errc{} || end != stem.data() + stem.size() || number <= largest) continue;
        largest = number;
        last = entry.path();
    }
    return last;
}

} // namespace osculate::output
