/// Meshes of .vtu and legacy .vtk files.

#include "osculate/core/without_traps.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/vtk_threads.hpp"
#include "vtk/cell_translation.hpp"
#include "vtk/readers.hpp"
#include "vtk/vtk_errors.hpp"

#include <vtkNew.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osculate::vtk {

using namespace mesh;
namespace {

RawMesh translate(const std::filesystem::path& path, vtkUnstructuredGrid* grid, const VtkErrors& errors) {
    RawMesh raw;
    raw.file = path.string();
    raw.cell_word = "cell";
    raw.point_word = "point";
    raw.sets_are_surfaces = true;
    if (const std::string reason = errors.reason(); !reason.empty()) throw MeshError(raw.file, reason);
    if (grid == nullptr || grid->GetNumberOfCells() == 0) throw MeshError(raw.file, "no cells");
    add_points(raw, *grid, 0);
    const std::vector<Index> cells = add_cells(raw, *grid, 0);
    add_sets(raw, *grid, cells);
    return raw;
}

} // namespace

RawMesh read_vtu(const std::filesystem::path& path) {
    use_no_vtk_threads();
    const vtkNew<VtkErrors> errors;
    const vtkNew<vtkXMLUnstructuredGridReader> reader;
    errors->listen_to(*reader);
    reader->SetReaderErrorObserver(errors);
    reader->SetParserErrorObserver(errors);
    reader->SetFileName(path.c_str());
    const WithoutTraps vtk;
    reader->Update();
    return translate(path, reader->GetOutput(), *errors);
}

RawMesh read_legacy(const std::filesystem::path& path) {
    use_no_vtk_threads();
    const vtkNew<VtkErrors> errors;
    const vtkNew<vtkUnstructuredGridReader> reader;
    errors->listen_to(*reader);
    reader->SetFileName(path.c_str());
    reader->ReadAllScalarsOn();
    reader->ReadAllFieldsOn();
    const WithoutTraps vtk;
    if (reader->OpenVTKFile() != 0 && reader->ReadHeader() != 0) {
        const bool grid = reader->IsFileUnstructuredGrid() != 0;
        reader->CloseVTKFile();
        if (!grid && errors->reason().empty())
            throw MeshError(path.string(), "no UNSTRUCTURED_GRID, the only dataset of legacy VTK files that is read");
    }
    reader->Update();
    return translate(path, reader->GetOutput(), *errors);
}

} // namespace osculate::vtk
