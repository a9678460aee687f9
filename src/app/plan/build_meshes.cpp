#include "app/fault.hpp"
#include "app/overloaded.hpp"
#include "app/plan/contact_triangles.hpp"
#include "app/plan/mesh_share.hpp"
#include "app/plan/rigid_surface.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <filesystem>
#include <map>

namespace osculate::app {

namespace {

/// Files and geometries that several bodies are parts of are read and meshed once.
struct Sources {
    std::map<std::string, mesh::RawMesh> files;
    std::vector<std::pair<mesh::CadOptions, mesh::RawMesh>> geometries;

    const mesh::RawMesh& file(const std::string& path) {
        const auto found = files.find(path);
        return found != files.end() ? found->second : files.emplace(path, mesh::read_mesh_file(path)).first->second;
    }
    const mesh::RawMesh& geometry(const mesh::CadOptions& options) {
        for (const auto& [known, raw] : geometries)
            if (known == options) return raw;
        return geometries.emplace_back(options, mesh::mesh_cad(options)).second;
    }
};

/// Names of parts of the mesh file that are sections, in order.
std::vector<std::string> named_sections(const scene::Body& body) {
    std::vector<std::string> names;
    for (const auto& [name, section] : body.sections)
        if (const auto* part = std::get_if<std::string>(&section.elements)) names.push_back(*part);
    return names;
}

/// Numbers sections as the scene does, those of boxes among them.
void number_sections(const scene::Body& body, mesh::Mesh& m) {
    if (body.sections.empty()) return;
    std::vector<int> of_name{0}; // scene's number of the file's
    for (std::size_t s = 0; s < body.sections.size(); ++s)
        if (body.sections[s].second.elements.index() == 0) of_name.push_back(static_cast<int>(s) + 1);
    std::vector<std::vector<int>> section;
    for (const mesh::ElementBlock& block : m.blocks) {
        const int n = mesh::nodes_per_cell(block.type);
        std::vector<int>& own = section.emplace_back(static_cast<std::size_t>(block.size()),
                                                     of_name[static_cast<std::size_t>(block.section)]);
        for (Index e = 0; e < block.size(); ++e) {
            Vec3 centre = Vec3::Zero();
            for (int i = 0; i < n; ++i)
                centre += m.nodes[static_cast<std::size_t>(block.connectivity[static_cast<std::size_t>(e) * n + i])];
            centre /= n;
            int& number = own[static_cast<std::size_t>(e)];
            for (std::size_t s = 0; s < body.sections.size(); ++s)
                if (const auto* box = std::get_if<scene::SelectBox>(&body.sections[s].second.elements);
                    box != nullptr && Eigen::AlignedBox3d(box->min, box->max).contains(centre))
                    number = std::max(number, static_cast<int>(s) + 1);
        }
    }
    mesh::divide(m, section);
}

/// @param meeting  triangles of surfaces in contact, for geometries that are meshed anew
mesh::Mesh generate(const scene::Body& body, const std::string& directory, Sources& sources,
                    std::vector<std::string>& notes, const std::vector<std::array<Vec3, 3>>& meeting) {
    const scene::MeshSpec& spec = body.mesh;
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
                const auto path = (std::filesystem::path(directory) / f.path).string();
                return mesh::make_mesh(sources.file(path),
                                       {f.part, f.piece, repairs_of(f.repair), named_sections(body)}, &notes);
            },
            [&](const scene::CadMesh& c) {
                const mesh::CadOptions options{(std::filesystem::path(directory) / c.path).string(),
                                               c.size,
                                               c.smallest,
                                               c.per_circle,
                                               c.quadratic,
                                               c.focus,
                                               meeting.empty() ? mesh::CadContact{} : c.contact,
                                               meeting};
                return mesh::make_mesh(sources.geometry(options), {c.part, c.piece, {}, named_sections(body)}, &notes);
            },
        },
        spec.source);
    const scene::Placement& p = spec.placement;
    if (p.angle != 0 || p.scale != 1 || !p.translation.isZero(0))
        mesh::place(m, p.axis, p.angle, p.translation, p.scale);
    number_sections(body, m);
    return m;
}

/// Shells of exact surfaces, near all other bodies.
void add_shells(const scene::Scene& scene, std::vector<mesh::Mesh>& meshes, std::vector<Fault>& faults) {
    Eigen::AlignedBox3d near;
    for (const mesh::Mesh& m : meshes)
        for (const Vec3& X : m.nodes) near.extend(X);
    if (near.isEmpty()) near.extend(Vec3::Zero());
    if (!(near.diagonal().norm() > 0)) near.extend(near.center() + Vec3::Ones());
    for (std::size_t b = 0; b < meshes.size(); ++b) {
        const auto& [name, body] = scene.bodies[b];
        if (!body.rigid_surface) continue;
        try {
            meshes[b] = shell_of(exact_shape(*body.rigid_surface, Vec3::Zero()), near);
        } catch (const std::exception& error) {
            faults.push_back(fault("bodies." + name + ".rigid_surface.extruded", "a profile without cusps and overlaps",
                                   error.what()));
        }
    }
}

} // namespace

std::vector<mesh::Mesh> build_meshes(const scene::Scene& scene, std::vector<std::string>* notes) {
    std::vector<mesh::Mesh> meshes(scene.bodies.size());
    std::vector<Fault> faults;
    Sources sources;
    std::vector<std::vector<std::string>> of_body(scene.bodies.size());
    const auto make = [&](std::size_t b, const std::vector<std::array<Vec3, 3>>& meeting) {
        const auto& [name, body] = scene.bodies[b];
        try {
            if (body.rigid_surface) return;
            of_body[b].clear();
            meshes[b] = generate(body, scene.directory, sources, of_body[b], meeting);
        } catch (const mesh::MeshError& error) {
            for (const std::string& reason : error.reasons())
                faults.push_back(fault("bodies." + name + ".mesh", "a mesh fit for use", reason));
        } catch (const std::exception& error) {
            faults.push_back(fault("bodies." + name + ".mesh", "a mesh that can be made", error.what()));
        }
    };
    for (std::size_t b = 0; b < meshes.size(); ++b) make(b, {});
    if (faults.empty()) add_shells(scene, meshes, faults);
    if (faults.empty()) {
        const std::vector<std::vector<std::array<Vec3, 3>>> meeting = contact_triangles(scene, meshes, faults);
        for (std::size_t b = 0; b < meshes.size(); ++b)
            if (!meeting[b].empty()) make(b, meeting[b]);
    }
    if (!faults.empty()) throw SceneError(std::move(faults));
    for (std::size_t b = 0; b < meshes.size() && notes != nullptr; ++b)
        for (const std::string& note : of_body[b]) notes->push_back("body " + scene.bodies[b].first + ": " + note);
    return meshes;
}

} // namespace osculate::app
