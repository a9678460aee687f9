#include "osculate/output/vtk_file.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/vtk_threads.hpp"
#include "output/files.hpp"

#include <array>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace osculate::output {

namespace {

vtkSmartPointer<vtkPoints> vtk_points(const std::vector<Vec3>& points) {
    auto result = vtkSmartPointer<vtkPoints>::New();
    result->SetDataTypeToDouble();
    result->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) result->SetPoint(static_cast<vtkIdType>(i), points[i].data());
    return result;
}

template <class VtkArray> vtkSmartPointer<VtkArray> vtk_array(const Array& array) {
    auto result = vtkSmartPointer<VtkArray>::New();
    using Value = typename VtkArray::ValueType;
    result->SetName(array.name.c_str());
    result->SetNumberOfComponents(array.components);
    result->SetNumberOfTuples(static_cast<vtkIdType>(array.values.size()) / array.components);
    for (std::size_t i = 0; i < array.values.size(); ++i)
        result->SetValue(static_cast<vtkIdType>(i), static_cast<Value>(array.values[i]));
    if (array.components == 6) { // the order of VTK's symmetric tensors is that of Voigt's here
        for (int c = 0; c < 6; ++c) result->SetComponentName(c, voigt_names[static_cast<std::size_t>(c)]);
    }
    if (!array.unit.empty()) result->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), array.unit.c_str());
    return result;
}

void add_data(vtkDataSet& data, const std::vector<Array>& point_data, double time) {
    for (const Array& array : point_data) {
        require(array.components == 1 || array.components == 3 || array.components == 6,
                "an array has 1, 3 or 6 components");
        require(array.values.size() == static_cast<std::size_t>(data.GetNumberOfPoints() * array.components),
                "an array's values must fit the points it is written on");
        if (array.integer)
            data.GetPointData()->AddArray(vtk_array<vtkIntArray>(array));
        else
            data.GetPointData()->AddArray(vtk_array<vtkDoubleArray>(array));
    }
    data.GetFieldData()->AddArray(vtk_array<vtkDoubleArray>({"TimeValue", 1, {time}, false, "s"}));
}

template <class Writer> void write(const std::filesystem::path& path, vtkDataObject& data) {
    mesh::use_no_vtk_threads();
    vtkNew<Writer> writer;
    writer->SetInputData(&data);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetHeaderTypeToUInt64();
    writer->SetCompressorTypeToLZ4();
    writer->WriteToOutputStringOn(); // VTK's own file output does not notice a disk that fills up on closing
    const WithoutTraps vtk;          // it takes the range of arrays that may hold no numbers
    if (writer->Write() != 1) throw std::runtime_error("cannot write " + path.string() + ": VTK refused the data");
    write_atomic(path, writer->GetOutputString());
}

} // namespace

void write_vtu(const std::filesystem::path& path, const std::vector<Vec3>& points,
               const std::vector<mesh::ElementBlock>& blocks, const std::vector<Array>& point_data, double time,
               const std::vector<Index>& numbers) {
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkUnsignedCharArray> types;
    std::array<vtkIdType, mesh::most_nodes_per_cell> nodes{};
    vtkIdType elements = 0, connectivity = 0;
    for (const mesh::ElementBlock& block : blocks) {
        elements += block.size();
        connectivity += static_cast<vtkIdType>(block.connectivity.size());
    }
    cells->AllocateExact(elements, connectivity);
    types->Allocate(elements);
    for (const mesh::ElementBlock& block : blocks) {
        const int count = nodes_per_cell(block.type);
        for (Index e = 0; e < block.size(); ++e) {
            for (int k = 0; k < count; ++k)
                nodes[static_cast<std::size_t>(k)] = block.connectivity[static_cast<std::size_t>(e * count + k)];
            cells->InsertNextCell(count, nodes.data());
            types->InsertNextValue(static_cast<unsigned char>(mesh::cell_info(block.type).vtk));
        }
    }
    vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(vtk_points(points));
    grid->SetCells(types, cells);
    add_data(*grid, point_data, time);
    if (!numbers.empty()) {
        require(numbers.size() == points.size(), "each point of a piece has a number");
        vtkNew<vtkIdTypeArray> ids;
        ids->SetName(point_numbers);
        ids->Allocate(static_cast<vtkIdType>(numbers.size()));
        for (const Index number : numbers) ids->InsertNextValue(number);
        grid->GetPointData()->SetGlobalIds(ids);
    }
    write<vtkXMLUnstructuredGridWriter>(path, *grid);
}

void write_vtp(const std::filesystem::path& path, const std::vector<Vec3>& points,
               const std::vector<mesh::Facet>& facets, const std::vector<Array>& point_data, double time) {
    vtkNew<vtkCellArray> cells, lines; // two nodes of a facet are a line
    for (const mesh::Facet& facet : facets) {
        vtkCellArray& kind = facet.count == 2 ? *lines : *cells;
        kind.InsertNextCell(facet.count);
        for (const Index node : facet) kind.InsertCellPoint(node);
    }
    vtkNew<vtkPolyData> surface;
    surface->SetPoints(vtk_points(points));
    surface->SetPolys(cells);
    if (lines->GetNumberOfCells() > 0) surface->SetLines(lines);
    add_data(*surface, point_data, time);
    write<vtkXMLPolyDataWriter>(path, *surface);
}

} // namespace osculate::output
