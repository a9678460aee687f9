#include "osculate/mesh/vtk_reader.hpp"

#include "mesh/loaded_reader.hpp"

namespace osculate::mesh {
namespace {

RawMesh read_by_vtk(const char* reader, const std::filesystem::path& path) {
    using Read = void (*)(const std::filesystem::path*, RawMesh*);
    RawMesh mesh;
    reinterpret_cast<Read>(load_reader("osculate_vtk", reader, path.string(), "VTK's readers cannot be loaded"))(&path,
                                                                                                                 &mesh);
    return mesh;
}

} // namespace

RawMesh read_vtu_cells(const std::filesystem::path& path) {
    return read_by_vtk("osculate_read_vtu", path);
}
RawMesh read_vtk_cells(const std::filesystem::path& path) {
    return read_by_vtk("osculate_read_legacy_vtk", path);
}
RawMesh read_exodus_cells(const std::filesystem::path& path) {
    return read_by_vtk("osculate_read_exodus", path);
}

} // namespace osculate::mesh
