#pragma once
/// What a file of geometry holds: solids, faces and edges, with the numbers that surfaces of its mesh have.

#include "osculate/core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace osculate::mesh {

/// A solid, face or edge. Lengths in metres.
struct CadEntity {
    int tag = 0;
    std::string name{};         ///< of the file; may be empty
    std::string type{};         ///< as Gmsh has it: "Plane", "Cylinder", "Circle"; empty for solids
    double measure = 0;         ///< volume, area or length
    Vec3 centre = Vec3::Zero(); ///< of mass
    double radius = 0;          ///< of cylinders, spheres and circles; 0 elsewhere
    Vec3 axis = Vec3::Zero();   ///< unit vector along a cylinder or a circle's normal; zero elsewhere
    std::vector<int> of{};      ///< solids that a face bounds; faces that an edge bounds
};

struct CadListing {
    std::vector<CadEntity> solids, faces, edges;            ///< by tag
    std::vector<Vec3> points;                               ///< of a coarse triangulation of the faces
    std::vector<std::vector<std::array<int, 3>>> triangles; ///< by face, in the order of `faces`
};

/// Whether a file's ending is that of geometry: .step .stp .iges .igs .brep, in small or capital letters.
[[nodiscard]] bool is_cad(const std::string& file);

/// @throws MeshError
[[nodiscard]] CadListing list_cad(const std::string& file);

} // namespace osculate::mesh
