#include "osculate/output/vtk_lines.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/without_traps.hpp"
#include "output/files.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataWriter.h>

namespace osculate::output {

void write_lines(const std::filesystem::path& path, const std::vector<Vec3>& points,
                 const std::vector<std::vector<Index>>& lines, const std::vector<Array>& line_data) {
    vtkNew<vtkPoints> positions;
    positions->SetDataTypeToDouble();
    for (const Vec3& x : points) positions->InsertNextPoint(x.data());
    vtkNew<vtkCellArray> cells;
    for (const std::vector<Index>& line : lines) {
        cells->InsertNextCell(static_cast<int>(line.size()));
        for (const Index point : line) cells->InsertCellPoint(point);
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(positions);
    data->SetLines(cells);
    for (const Array& array : line_data) {
        require(array.values.size() == lines.size() * static_cast<std::size_t>(array.components),
                "an array's values must fit the lines it is written on");
        vtkSmartPointer<vtkDataArray> values;
        if (array.integer)
            values = vtkSmartPointer<vtkIntArray>::New();
        else
            values = vtkSmartPointer<vtkDoubleArray>::New();
        values->SetName(array.name.c_str());
        values->SetNumberOfComponents(array.components);
        values->SetNumberOfTuples(static_cast<vtkIdType>(lines.size()));
        for (std::size_t i = 0; i < array.values.size(); ++i) {
            const int n = array.components, k = static_cast<int>(i);
            values->SetComponent(k / n, k % n, array.values[i]);
        }
        data->GetCellData()->AddArray(values);
    }
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(data);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetHeaderTypeToUInt64();
    writer->SetCompressorTypeToLZ4();
    writer->WriteToOutputStringOn();
    const WithoutTraps vtk;
    if (writer->Write() != 1) throw std::runtime_error("cannot write " + path.string() + ": VTK refused the data");
    write_atomic(path, writer->GetOutputString());
}

} // namespace osculate::output
