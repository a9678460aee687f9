#include "mesh/loaded_reader.hpp"

#include "osculate/mesh/mesh_error.hpp"

#include <dlfcn.h>

namespace osculate::mesh {

void* load_reader(const char* module, const char* name, const std::string& file, const char* remedy) {
    void* library = dlopen(("lib" + std::string(module) + ".so").c_str(), RTLD_NOW | RTLD_LOCAL); // never closed
    void* symbol = library == nullptr ? nullptr : dlsym(library, name);
    if (symbol != nullptr) return symbol;
    const char* reason = dlerror();
    throw MeshError(file, std::string(remedy) + " (" + (reason != nullptr ? reason : "not found") + ")");
}

} // namespace osculate::mesh
