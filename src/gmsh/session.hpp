#pragma once
/// Gmsh while it is in use.

#include "osculate/mesh/mesh_error.hpp"

#include <array>
#include <functional>
#include <string>
#include <utility>

namespace osculate::mesh {

/// Gmsh while it is in use: silent, on one thread, without files or options of the user, with a model of its own. A host, such
/// as Python, may use Gmsh, too: its models and options are as before in the end. It is initialised once and never
/// finalised: each time would keep some memory, and ever more of it.
class Session {
public:
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

private:
    std::string before_;
    std::array<std::pair<const char*, double>, 4> options_{{{"General.Terminal", 0},
                                                            {"General.NumThreads", 1},
                                                            {"General.AbortOnError", 2}, // which throws
                                                            {"Mesh.MeshSizeFactor", 1}}};
};

/// What Gmsh throws, as MeshError.
void guarded(const std::string& file, const std::function<void()>& act);

void check_exists(const std::string& path);

/// Reads a file of geometry into the current model.
/// @returns  metres of a unit of length of the model
/// @throws MeshError where the ending is not that of geometry, or there is no solid
double open_geometry(const std::string& file);

} // namespace osculate::mesh
