#include "osculate/scene/surface_study.hpp"

#include "scene/describe.hpp"
#include "scene/describe_parts.hpp"
#include "scene/tree_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace osculate::scene {

namespace {

namespace fs = std::filesystem;

constexpr Dimension curvature{-1, 0, 0, 0};

void centre(Visitor& v, Vec3& value) {
    v.vector({.name = "centre", .meaning = "Centre.", .unit = dimension::length, .range = range::position}, value);
}

void radius(Visitor& v, const char* name, const char* meaning, double& value) {
    v.number({.name = name, .meaning = meaning, .unit = dimension::length, .range = range::size}, value);
}

void describe(Visitor& v, SphereShape& s) {
    centre(v, s.centre);
    radius(v, "radius", "Radius.", s.radius);
}

void describe(Visitor& v, TorusShape& s) {
    centre(v, s.centre);
    radius(v, "ring_radius", "Radius of the circle in the middle of the tube.", s.ring_radius);
    radius(v, "tube_radius", "Radius of the tube.", s.tube_radius);
}

void describe(Visitor& v, SaddleShape& s) {
    centre(v, s.centre);
    v.number({.name = "rise", .meaning = "Of x3 = rise x1^2 - fall x2^2.", .unit = curvature}, s.rise);
    v.number({.name = "fall", .meaning = "Of x3 = rise x1^2 - fall x2^2.", .unit = curvature}, s.fall);
}

void describe(Visitor& v, StudySurface& surface) {
    v.group({.name = "shape", .meaning = "The exact surface.", .required = true}, [&] {
        static const Words tags{"sphere", "torus", "saddle"};
        one_of(v, tags, {"Sphere.", "Torus around the z axis.", "Hyperbolic paraboloid."}, true, surface.shape,
               [&v](auto& shape) { describe(v, shape); });
    });
    v.group({.name = "published", .meaning = "Published ratios of errors to those of the facets."}, [&] {
        v.optional_number({.name = "position", .meaning = "Of the position.", .range = range::not_negative},
                          surface.published.position);
        v.optional_number({.name = "normal", .meaning = "Of the normal.", .range = range::not_negative},
                          surface.published.normal);
    });
}

void describe(Visitor& v, MeshFile& m) {
    v.text({.name = "path",
            .meaning = "JSON file of plane meshes to be lifted onto the surfaces; relative to the study.",
            .required = true},
           m.path);
}

void describe(Visitor& v, RefinedMeshes& m) {
    v.integer({.name = "coarsest", .meaning = "Facets along an edge, coarsest mesh.", .range = {.low = 3, .high = 200}},
              m.coarsest);
    v.integer({.name = "levels", .meaning = "Number of meshes.", .range = {.low = 2, .high = 10}}, m.levels);
    v.number({.name = "factor", .meaning = "Between the edges of successive meshes.", .range = {.low = 1.1, .high = 4}},
             m.factor);
    v.number({.name = "irregularity",
              .meaning = "Largest displacement of the nodes, in edge lengths.",
              .range = {.low = 0, .high = 0.2}},
             m.irregularity);
}

} // namespace

void describe(Visitor& v, SurfaceStudy& study, const Words& methods) {
    v.text({.name = "title", .meaning = "Heading of the report."}, study.title);
    named(v,
          {.name = "surfaces",
           .meaning = "Exact surfaces by name.",
           .required = true,
           .names = Names::identifier,
           .item = "surface"},
          study.surfaces, [&](const std::string& name, StudySurface& surface) {
              v.group({.name = name, .meaning = "A surface."}, [&] { describe(v, surface); });
          });
    v.group({.name = "meshes", .meaning = "Meshes whose nodes lie on the surfaces.", .required = true}, [&] {
        static const Words tags{"file", "refined"};
        one_of(v, tags, {"Given meshes.", "Hybrid meshes, each finer than the last."}, true, study.meshes,
               [&v](auto& source) { describe(v, source); });
    });
    v.words({.name = "methods", .meaning = "Approximations to compare.", .required = true}, methods, study.methods);
    v.integer({.name = "points",
               .meaning = "Every facet is sampled in points x points parts.",
               .range = {.low = 1, .high = 100}},
              study.points);
}

namespace {

/// A list of numbers; empty, with a fault, where it is something else.
std::vector<double> numbers(const Tree& list, const std::string& key, std::vector<Fault>& faults) {
    std::vector<double> values;
    for (const Tree& item : list.children) {
        const Quantity q = parse_quantity(item.scalar);
        if (item.kind != Tree::Kind::scalar || !q.problem.empty() || q.has_unit || !std::isfinite(q.value)) {
            faults.push_back(fault_at(item.place, key, "a number", item.found()));
            return {};
        }
        values.push_back(q.value);
    }
    return values;
}

PlaneMesh plane_mesh(const Tree& tree, std::vector<Fault>& faults) {
    PlaneMesh mesh;
    const Tree *xy = tree.find("xy"), *facets = tree.find("facets");
    if (xy == nullptr || facets == nullptr) {
        faults.push_back(fault_at(tree.place, "meshes", "a map with xy and facets", tree.found()));
        return mesh;
    }
    for (const Tree& item : xy->children) {
        const auto p = numbers(item, "xy", faults);
        if (p.size() == 2)
            mesh.nodes.emplace_back(p[0], p[1]);
        else
            faults.push_back(fault_at(item.place, "xy", "two coordinates", item.found()));
    }
    for (const Tree& item : facets->children) {
        const auto nodes = numbers(item, "facets", faults);
        const auto known = [&](double n) {
            return n == std::floor(n) && n >= 0 && n < static_cast<double>(mesh.nodes.size());
        };
        if ((nodes.size() != 3 && nodes.size() != 4) || !std::ranges::all_of(nodes, known)) {
            faults.push_back(fault_at(item.place, "facets", "three or four nodes of xy", item.found()));
            continue;
        }
        mesh::Facet facet;
        for (const double n : nodes) facet.nodes[static_cast<std::size_t>(facet.count++)] = static_cast<Index>(n);
        mesh.facets.push_back(facet);
    }
    return mesh;
}

} // namespace

SurfaceStudy read_surface_study(const std::string& path, const std::vector<std::string>& methods) {
    std::vector<Fault> faults;
    const Tree tree = read_yaml(path, faults);
    SurfaceStudy study;
    if (faults.empty()) {
        study.name = study.title = fs::path(path).stem().string();
        const KnownNames none;
        TreeReader reader(none, faults);
        reader.read(tree, [&] { describe(reader, study, methods); });
        if (auto* file = std::get_if<MeshFile>(&study.meshes))
            file->path = (fs::absolute(path).parent_path() / file->path).lexically_normal().string();
    }
    if (!faults.empty()) throw SceneError(std::move(faults));
    return study;
}

std::vector<PlaneMesh> read_plane_meshes(const std::string& path) {
    std::vector<Fault> faults;
    const Tree tree = read_yaml(path, faults); // JSON is YAML
    std::vector<PlaneMesh> meshes;
    if (const Tree* list = tree.find("meshes"); list != nullptr && list->kind == Tree::Kind::list)
        for (const Tree& item : list->children) meshes.push_back(plane_mesh(item, faults));
    if (meshes.empty() && faults.empty())
        faults.push_back(fault_at(tree.place, "meshes", "a list of meshes", tree.found()));
    if (!faults.empty()) throw SceneError(std::move(faults));
    return meshes;
}

} // namespace osculate::scene
