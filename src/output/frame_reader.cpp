#include "osculate/output/frame_reader.hpp"

#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/vtk_threads.hpp"

#include <charconv>
#include <stdexcept>
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

template <class Reader> Frame read(const fs::path& path) {
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
    Frame frame;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
        Vec3 point;
        data->GetPoint(i, point.data());
        frame.points.push_back(point);
    }
    for (int a = 0; a < data->GetPointData()->GetNumberOfArrays(); ++a)
        if (vtkDataArray* values = data->GetPointData()->GetArray(a)) frame.arrays.push_back(copy_of(*values));
    if (vtkDataArray* time = data->GetFieldData()->GetArray("TimeValue")) frame.time = time->GetComponent(0, 0);
    return frame;
}

} // namespace

const Array* Frame::find(const std::string& name) const {
    for (const Array& array : arrays)
        if (array.name == name) return &array;
    return nullptr;
}

Frame read_frame(const fs::path& path) {
    return path.extension() == ".vtp" ? read<vtkXMLPolyDataReader>(path) : read<vtkXMLUnstructuredGridReader>(path);
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
