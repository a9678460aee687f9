#include "osculate/mesh/gmsh.hpp"

#include "osculate/mesh/mesh_error.hpp"

#include <dlfcn.h>

namespace osculate::mesh {
namespace {

using Read = void (*)(const std::string* path, RawMesh* mesh);
using Cad = void (*)(const CadOptions* options, RawMesh* mesh);

void* load(const char* name, const std::string& file) {
    static void* module = dlopen("libosculate_gmsh.so", RTLD_NOW | RTLD_LOCAL); // never closed
    void* symbol = module == nullptr ? nullptr : dlsym(module, name);
    if (symbol == nullptr) {
        const char* reason = dlerror();
        throw MeshError(file, std::string("needs Gmsh's library, and this build cannot load it; install the package "
                                          "libgmsh-dev and build again (") +
                                  (reason != nullptr ? reason : "not found") + ")");
    }
    return symbol;
}

} // namespace

RawMesh read_gmsh(const std::string& path) {
    RawMesh mesh;
    reinterpret_cast<Read>(load("osculate_gmsh_read", path))(&path, &mesh);
    return mesh;
}

RawMesh mesh_cad(const CadOptions& options) {
    RawMesh mesh;
    reinterpret_cast<Cad>(load("osculate_gmsh_mesh_cad", options.file))(&options, &mesh);
    return mesh;
}

} // namespace osculate::mesh
