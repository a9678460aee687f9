#pragma once
/// A study of surface approximations, read from a YAML file.

#include "osculate/core/error.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/scene/scene.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace osculate::scene {

struct SphereShape {
    Vec3 centre = Vec3::Zero();
    double radius = 1;
};

struct TorusShape {
    Vec3 centre = Vec3::Zero();
    double ring_radius = 2, tube_radius = 1;
};

struct SaddleShape {
    Vec3 centre = Vec3::Zero();
    double rise = 1, fall = 1;
};

/// Ratios of a published method's errors to those of the facets, for comparison with the study's own.
struct PublishedRatios {
    std::optional<double> position, normal;
};

struct StudySurface {
    std::variant<SphereShape, TorusShape, SaddleShape> shape;
    PublishedRatios published;
};

/// A JSON file {"meshes": [{"xy": [[x, y], ...], "facets": [[i, j, k], ...]}, ...]}, absolute path.
struct MeshFile {
    std::string path;
};

struct RefinedMeshes {
    int coarsest = 6, levels = 5;
    double factor = 1.5, irregularity = 0.1;
};

struct SurfaceStudy {
    std::string name; ///< the file's stem
    std::string title;
    Named<StudySurface> surfaces;
    std::variant<MeshFile, RefinedMeshes> meshes = RefinedMeshes{};
    std::vector<std::string> methods;
    int points = 12;
};

/// A mesh of the x1x2 plane; facets are counter-clockwise.
struct PlaneMesh {
    std::vector<Vec2> nodes;
    std::vector<mesh::Facet> facets;
};

/// @param methods  allowed names in `methods`
/// @throws SceneError with all faults
[[nodiscard]] SurfaceStudy read_surface_study(const std::string& path, const std::vector<std::string>& methods);
[[nodiscard]] std::vector<PlaneMesh> read_plane_meshes(const std::string& path);

} // namespace osculate::scene
