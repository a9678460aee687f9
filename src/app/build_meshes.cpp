#include "app/fault.hpp"
#include "app/overloaded.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/mesh/vtu_reader.hpp"

#include <filesystem>

namespace osculate::app {

namespace {

mesh::Mesh generate(const scene::MeshSpec& spec, const std::string& directory) {
    mesh::Mesh m = std::visit(
        Overloaded{
            [](const scene::BlockMesh& b) {
                return mesh::make_block(b.origin, b.size, b.divisions, b.element, b.pattern, b.focus, b.crown);
            },
            [](const scene::HalfTubeMesh& t) {
                return mesh::make_half_tube(t.inner_radius, t.thickness, t.length, t.divisions, t.element);
            },
            [](const scene::ContactorMesh& c) {
                return mesh::make_contactor(c.radius, c.width, c.length, c.height, c.rear, c.divisions, c.element);
            },
            [](const scene::BallMesh& b) {
                return mesh::make_ball(b.radius, b.divisions, b.portion, b.grading, b.pole_refinement);
            },
            [](const scene::CylinderMesh& c) {
                return mesh::make_cylinder(c.radius, c.length, c.divisions, c.portion, c.grading);
            },
            [](const scene::TubeMesh& t) {
                return mesh::make_tube(t.inner_radius, t.thickness, t.length, t.divisions, t.portion);
            },
            [&](const scene::FileMesh& f) {
                return mesh::read_vtu((std::filesystem::path(directory) / f.path).string());
            },
        },
        spec.source);
    const scene::Placement& p = spec.placement;
    if (p.angle != 0 || p.scale != 1 || !p.translation.isZero(0))
        mesh::place(m, p.axis, p.angle, p.translation, p.scale);
    return m;
}

} // namespace

std::vector<mesh::Mesh> build_meshes(const scene::Scene& scene) {
    std::vector<mesh::Mesh> meshes;
    std::vector<Fault> faults;
    for (const auto& [name, body] : scene.bodies) try {
            meshes.push_back(generate(body.mesh, scene.directory));
        } catch (const std::exception& error) {
            faults.push_back(fault("bodies." + name + ".mesh", "a mesh that can be made", error.what()));
        }
    if (!faults.empty()) throw SceneError(std::move(faults));
    return meshes;
}

} // namespace osculate::app
