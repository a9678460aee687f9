/// Gmsh's meshes, from any bytes: our look at the file, and Gmsh's library, which has no sanitizers, behind it.

#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/mesh_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace osculate::mesh;
    static const std::string path =
        (std::filesystem::temp_directory_path() / ("osculate_fuzz_" + std::to_string(getpid()) + ".msh")).string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        (void)make_mesh(read_gmsh(path));
    } catch (const MeshError&) { // as it should
    }
    return 0;
}
