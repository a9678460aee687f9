#include "osculate/mesh/gmsh.hpp"

#include "mesh/loaded_reader.hpp"

namespace osculate::mesh {
namespace {

template <class Function> Function* load_gmsh(const char* name, const std::string& file) {
    return reinterpret_cast<Function*>(load_reader(
        "osculate_gmsh", name, file,
        "needs Gmsh's library, and this build cannot load it; install the package libgmsh-dev and build again"));
}

} // namespace

RawMesh read_gmsh(const std::string& path) {
    RawMesh mesh;
    load_gmsh<void(const std::string*, RawMesh*)>("osculate_gmsh_read", path)(&path, &mesh);
    return mesh;
}

RawMesh mesh_cad(const CadOptions& options) {
    RawMesh mesh;
    load_gmsh<void(const CadOptions*, RawMesh*)>("osculate_gmsh_mesh_cad", options.file)(&options, &mesh);
    return mesh;
}

} // namespace osculate::mesh
