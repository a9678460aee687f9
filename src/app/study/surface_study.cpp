#include "osculate/app/surface_study.hpp"

#include "app/overloaded.hpp"
#include "osculate/core/error.hpp"
#include "osculate/study/study_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace osculate::app {

namespace {

study::ExactSurface exact_surface(const scene::StudySurface& surface) {
    return std::visit(Overloaded{
                          [](const scene::SphereShape& s) -> study::ExactSurface {
                              return study::Sphere{s.centre, s.radius};
                          },
                          [](const scene::TorusShape& s) -> study::ExactSurface {
                              return study::Torus{s.centre, s.ring_radius, s.tube_radius};
                          },
                          [](const scene::SaddleShape& s) -> study::ExactSurface {
                              return study::Saddle{s.centre, s.rise, s.fall};
                          },
                      },
                      surface.shape);
}

std::vector<study::SurfaceMesh> meshes_on(const study::ExactSurface& exact, const scene::MeshFile& file) {
    std::vector<study::SurfaceMesh> meshes;
    for (const scene::PlaneMesh& plane : scene::read_plane_meshes(file.path)) try {
            meshes.push_back(study::lift(plane.nodes, plane.facets, exact));
        } catch (const std::runtime_error& error) {
            Fault fault;
            fault.file = file.path;
            fault.key = "meshes";
            fault.expected = "meshes that can be lifted onto the surface";
            fault.found = "mesh " + std::to_string(meshes.size() + 1) + ": " + error.what();
            throw SceneError({fault});
        }
    return meshes;
}

std::vector<study::SurfaceMesh> meshes_on(const study::ExactSurface& exact, const scene::RefinedMeshes& refined) {
    std::vector<study::SurfaceMesh> meshes;
    for (int level = 0; level < refined.levels; ++level) {
        const auto n = static_cast<int>(std::lround(refined.coarsest * std::pow(refined.factor, level)));
        meshes.push_back(study::refined_mesh(exact, n, refined.irregularity));
    }
    return meshes;
}

} // namespace

const StudyRow& StudyResult::row(const std::string& surface, int mesh, const std::string& method) const {
    const auto at = std::ranges::find_if(
        rows, [&](const StudyRow& r) { return r.surface == surface && r.mesh == mesh && r.method == method; });
    require(at != rows.end(), "a row of the study");
    return *at;
}

int StudyResult::meshes() const {
    int count = 0;
    for (const StudyRow& r : rows) count = std::max(count, r.mesh);
    return count;
}

const std::vector<ErrorKind>& error_kinds() {
    static const std::vector<ErrorKind> kinds{{"position", "m", &study::Errors::position},
                                              {"normal", "rad", &study::Errors::normal},
                                              {"curvature", "1/m", &study::Errors::curvature}};
    return kinds;
}

double fitted_order(const std::vector<const StudyRow*>& rows, const ErrorKind& kind) {
    double x = 0, y = 0, xx = 0, xy = 0;
    const auto n = static_cast<double>(rows.size());
    for (const StudyRow* row : rows) {
        const double a = std::log(row->size), b = std::log((row->errors.*kind.measure).mean);
        x += a / n;
        y += b / n;
        xx += a * a / n;
        xy += a * b / n;
    }
    return (xy - x * y) / (xx - x * x);
}

StudyResult run_surface_study(const scene::SurfaceStudy& study, int threads) {
    StudyResult result;
    for (const auto& [name, surface] : study.surfaces) {
        const study::ExactSurface exact = exact_surface(surface);
        const auto meshes = std::visit([&](const auto& source) { return meshes_on(exact, source); }, study.meshes);
        int number = 0;
        for (const study::SurfaceMesh& mesh : meshes) {
            ++number;
            for (const std::string& method : study.methods) {
                const std::clock_t start = std::clock();
                const auto approximation = study::make_approximation(method, mesh);
                const study::Errors errors = study::measure_errors(mesh, *approximation, exact, study.points, threads);
                const double cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
                result.rows.push_back({name, method, number, mesh.topology.facet_count(), mesh.topology.vertex_count(),
                                       mesh.topology.mean_facet_size(), errors, approximation->fallbacks(),
                                       cpu_seconds});
            }
        }
    }
    return result;
}

} // namespace osculate::app
