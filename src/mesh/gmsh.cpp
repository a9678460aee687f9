#include "osculate/mesh/gmsh.hpp"

#include "mesh/loaded_reader.hpp"
#include "osculate/mesh/cad_listing.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

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

bool is_cad(const std::string& file) {
    std::string ending = std::filesystem::path(file).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::ranges::count(std::array{".step", ".stp", ".iges", ".igs", ".brep"}, ending) > 0;
}

CadListing list_cad(const std::string& file) {
    CadListing listing;
    load_gmsh<void(const std::string*, CadListing*)>("osculate_gmsh_list_cad", file)(&file, &listing);
    return listing;
}

} // namespace osculate::mesh
