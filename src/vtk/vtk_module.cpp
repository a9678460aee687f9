/// mesh::read_vtu_cells, read_vtk_cells and read_exodus_cells by VTK: a module of its own, as VTK's reader of Exodus takes some
/// fifty libraries, which would be loaded at every start.

#include "vtk/readers.hpp"

using Path = std::filesystem::path;
using osculate::mesh::RawMesh;

extern "C" {
[[gnu::visibility("default")]] void osculate_read_vtu(const Path* path, RawMesh* mesh) {
    *mesh = osculate::vtk::read_vtu(*path);
}
[[gnu::visibility("default")]] void osculate_read_legacy_vtk(const Path* path, RawMesh* mesh) {
    *mesh = osculate::vtk::read_legacy(*path);
}
[[gnu::visibility("default")]] void osculate_read_exodus(const Path* path, RawMesh* mesh) {
    *mesh = osculate::vtk::read_exodus(*path);
}
}
