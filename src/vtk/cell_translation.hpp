#pragma once
/// From VTK's volume cells to ours, shared by the readers whose cells VTK knows.

#include "osculate/mesh/raw_mesh.hpp"

#include <string>
#include <vtkUnstructuredGrid.h>

namespace osculate::vtk {

/// Appends the points of a grid, numbered from `first_id`.
void add_points(mesh::RawMesh& raw, vtkUnstructuredGrid& grid, std::int64_t first_id);

/// Appends the volume cells of a grid whose points are those of `raw`; marks the points of the others. Cell c of the grid
/// has the id first_id + c.
/// @returns  per cell of the grid its number in `raw`, -1 for those that are no volume
/// Throws MeshError: another kind of volume cell, a wrong number of points, a point that does not exist.
std::vector<Index> add_cells(mesh::RawMesh& raw, vtkUnstructuredGrid& grid, std::int64_t first_id);

/// Sets from integer arrays with one component: of points, those of 0 and 1; of cells, as parts, those of 0 and 1 and
/// every value of the others as NAME=VALUE.
void add_sets(mesh::RawMesh& raw, vtkUnstructuredGrid& grid, const std::vector<Index>& cells);

} // namespace osculate::vtk
