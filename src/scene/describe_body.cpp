#include "osculate/core/error.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/mesh/repair.hpp"
#include "scene/describe_parts.hpp"

#include <algorithm>

namespace osculate::scene {

namespace {

constexpr Range divisions_range{.low = 1, .high = 10000};
constexpr double most_elements = 2e7;

/// Element shape of a generated mesh, by the names of the types that generators make.
void describe_element(Visitor& v, mesh::CellType& element) {
    const auto types = mesh::generated_types();
    static const Words words = [&] {
        Words names;
        for (const mesh::CellType type : types) names.emplace_back(mesh::cell_info(type).name);
        return names;
    }();
    auto index = static_cast<std::size_t>(std::ranges::find(types, element) - types.begin());
    require(index < types.size(), "a generated mesh of a type that no generator makes");
    v.word({.name = "element", .meaning = "Element shape."}, words, index);
    element = types[index];
}

void describe(Visitor& v, mesh::Focus& f) {
    v.vector({.name = "point",
              .meaning = "Where elements are smallest; nodes stand on its coordinates.",
              .unit = dimension::length,
              .range = range::position},
             f.point);
    v.number({.name = "size",
              .meaning = "Edge length of the elements there, in place of divisions.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9},
              .default_text = "0, which divides into equal parts"},
             f.size);
    v.number({.name = "extent",
              .meaning = "How far from the point, along each axis, elements keep that size.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9}},
             f.extent);
    v.number({.name = "growth",
              .meaning = "Each further element is at most this many times longer than the one before.",
              .range = {.low = 1, .high = 10}},
             f.growth);
    std::vector<std::string> axes;
    for (std::size_t d = 0; d < 3; ++d)
        if (f.axes[d]) axes.push_back(axis_words[d]);
    v.words(
        {.name = "axes", .meaning = "Axes it acts on; the others keep their divisions.", .default_text = "[x, y, z]"},
        axis_words, axes);
    for (std::size_t d = 0; d < 3; ++d) f.axes[d] = std::ranges::count(axes, axis_words[d]) > 0;
}

void describe(Visitor& v, mesh::Crown& c) {
    v.number({.name = "radius",
              .meaning = "Radius of the underside.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9},
              .default_text = "0, which is flat"},
             c.radius);
    static const Words along{"none", "x", "y"};
    word(v, {.name = "along", .meaning = "Axis of the cylinder it is part of; none: part of a ball."}, along, c.along);
}

void describe(Visitor& v, BlockMesh& m) {
    v.vector({.name = "origin", .meaning = "Lower corner.", .unit = dimension::length, .range = range::position},
             m.origin);
    v.vector({.name = "size", .meaning = "Edge lengths.", .unit = dimension::length, .range = range::size}, m.size);
    v.divisions({.name = "divisions",
                 .meaning = "Elements along x, y, z.",
                 .range = divisions_range,
                 .largest_product = most_elements},
                m.divisions);
    describe_element(v, m.element);
    static const Words patterns{"quad", "triangle", "hybrid"};
    word(v,
         {.name = "pattern",
          .meaning = "How the top and every layer below is divided: triangle cuts the hexahedra into wedges, hybrid "
                     "half of them."},
         patterns, m.pattern);
    v.group({.name = "focus", .meaning = "Small elements around a point, growing away from it along each axis."},
            [&] { describe(v, m.focus); });
    v.group({.name = "crown",
             .meaning = "Round underside with its lowest point below the point of focus; the columns of elements above "
                        "are shortened in proportion."},
            [&] { describe(v, m.crown); });
}

void describe(Visitor& v, HalfTubeMesh& m) {
    v.number({.name = "inner_radius",
              .meaning = "Radius of the inner face.",
              .unit = dimension::length,
              .range = range::size},
             m.inner_radius);
    v.number({.name = "thickness", .meaning = "Wall thickness.", .unit = dimension::length, .range = range::size},
             m.thickness);
    v.number(
        {.name = "length", .meaning = "Length along y, from y = 0.", .unit = dimension::length, .range = range::size},
        m.length);
    v.divisions({.name = "divisions",
                 .meaning = "Elements around, along y, through the thickness.",
                 .range = divisions_range,
                 .largest_product = most_elements},
                m.divisions);
    describe_element(v, m.element);
}

void describe(Visitor& v, ContactorMesh& m) {
    v.number({.name = "radius",
              .meaning = "Radius of the underside, at least half the width.",
              .unit = dimension::length,
              .range = range::size},
             m.radius);
    v.number({.name = "width", .meaning = "Extent along x.", .unit = dimension::length, .range = range::size}, m.width);
    v.number({.name = "length", .meaning = "Extent along y.", .unit = dimension::length, .range = range::size},
             m.length);
    v.number({.name = "height",
              .meaning = "Extent along z at the centre line.",
              .unit = dimension::length,
              .range = range::size},
             m.height);
    v.number({.name = "rear", .meaning = "y of the rear face.", .unit = dimension::length, .range = range::position},
             m.rear);
    v.divisions({.name = "divisions",
                 .meaning = "Elements across x, along y, through z.",
                 .range = divisions_range,
                 .largest_product = most_elements},
                m.divisions);
    describe_element(v, m.element);
}

void describe_portion(Visitor& v, Portion& portion) {
    static const Words portions{"full", "half", "quarter"};
    word(v,
         {.name = "portion",
          .meaning = "All of the body, x >= 0 of it (cut surface x_min), or x >= 0 and y >= 0 (x_min and y_min)."},
         portions, portion);
}

void describe(Visitor& v, BallMesh& m) {
    v.number({.name = "radius", .meaning = "Radius.", .unit = dimension::length, .range = range::size}, m.radius);
    v.divisions({.name = "divisions",
                 .meaning = "Elements around a quarter of the equator (even), from the inner cube to the sphere, along "
                            "the cube's edges parallel to z.",
                 .range = divisions_range,
                 .largest_product = most_elements},
                m.divisions);
    describe_portion(v, m.portion);
    v.number({.name = "grading",
              .meaning = "How many times longer each element is than its neighbour towards the z axis, or towards the "
                         "sphere.",
              .range = {.low = 1, .high = 2}},
             m.grading);
    v.number({.name = "pole_refinement",
              .meaning = "How many times smaller the elements at the lowest point are; those at the highest grow as "
                         "much, angles stay.",
              .range = {.low = 1, .high = 100}},
             m.pole_refinement);
}

void describe(Visitor& v, CylinderMesh& m) {
    v.number({.name = "radius", .meaning = "Radius.", .unit = dimension::length, .range = range::size}, m.radius);
    v.number(
        {.name = "length", .meaning = "Length along z, from z = 0.", .unit = dimension::length, .range = range::size},
        m.length);
    v.divisions({.name = "divisions",
                 .meaning =
                     "Elements around a quarter of the circle (even), from the inner square to the circle, along "
                     "z.",
                 .range = divisions_range,
                 .largest_product = most_elements},
                m.divisions);
    describe_portion(v, m.portion);
    v.number({.name = "grading",
              .meaning = "How many times longer each layer along z is than the one below.",
              .range = {.low = 0.5, .high = 2}},
             m.grading);
}

void describe(Visitor& v, TubeMesh& m) {
    v.number({.name = "inner_radius", .meaning = "Inner radius.", .unit = dimension::length, .range = range::size},
             m.inner_radius);
    v.number(
        {.name = "thickness", .meaning = "Thickness of the wall.", .unit = dimension::length, .range = range::size},
        m.thickness);
    v.number(
        {.name = "length", .meaning = "Length along z, from z = 0.", .unit = dimension::length, .range = range::size},
        m.length);
    v.divisions({.name = "divisions",
                 .meaning = "Elements around the whole circle (3 or more, a multiple of 4 where it is cut), along z, "
                            "through the wall.",
                 .range = divisions_range,
                 .largest_product = most_elements},
                m.divisions);
    describe_portion(v, m.portion);
}

/// What is taken of a file, whoever reads it.
template <class FileSpec> void describe_share(Visitor& v, FileSpec& m) {
    v.text({.name = "part",
            .meaning = "Element set, block or group of volumes that is the body.",
            .default_text = "all of the file"},
           m.part);
    v.integer({.name = "piece",
               .meaning = "Which connected piece of that is the body, counted in the file's order; 0: all of them.",
               .range = {.low = 0, .high = 1e9}},
              m.piece);
}

void describe(Visitor& v, FileMesh& m) {
    v.text({.name = "path",
            .meaning = "Mesh file: .vtu, .vtk, .msh (Gmsh), .inp (Abaqus, CalculiX), .e .ex2 .exo .exii .g (Exodus); a "
                       "relative path starts at the scene's folder.",
            .required = true},
           m.path);
    describe_share(v, m);
    static const Words repairs = [] {
        Words words = mesh::repair_words();
        words.emplace_back("all");
        return words;
    }();
    v.words({.name = "repair",
             .meaning = "Faults of the mesh that are repaired, others are refused; all, or true for the list: all but "
                        "coincident_nodes and keep_non_manifold.",
             .default_text = "[]"},
            repairs, m.repair);
}

void describe(Visitor& v, mesh::CadFocus& f) {
    v.vector({.name = "point",
              .meaning = "Where elements are smallest, in the coordinates of the file.",
              .unit = dimension::length,
              .range = range::position},
             f.point);
    v.number({.name = "size",
              .meaning = "Edge length of the elements there.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9},
              .default_text = "0, which is that of all elements"},
             f.size);
    v.number({.name = "extent",
              .meaning = "How far from the point elements keep that size.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9}},
             f.extent);
    v.number({.name = "growth",
              .meaning = "Each further element is at most about this many times longer than the one before.",
              .range = {.low = 1, .high = 10}},
             f.growth);
}

void describe(Visitor& v, mesh::CadContact& c) {
    v.number({.name = "size",
              .meaning = "Edge length of the elements there.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9},
              .default_text = "0, which is that of all elements"},
             c.size);
    v.number({.name = "growth",
              .meaning = "Each further element is at most about this many times longer than the one before.",
              .range = {.low = 1, .high = 10}},
             c.growth);
}

void describe(Visitor& v, CadMesh& m) {
    v.text({.name = "path",
            .meaning = "Geometry: .step .stp .iges .igs, whose own units count, or .brep, in metres; a relative path "
                       "starts at the scene's folder.",
            .required = true},
           m.path);
    v.number({.name = "size",
              .meaning = "Largest edge length of the elements.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9},
              .default_text = "0, a tenth of the geometry's diagonal"},
             m.size);
    v.number({.name = "smallest",
              .meaning = "Smallest edge length of the elements.",
              .unit = dimension::length,
              .range = {.low = 0, .high = 1e9}},
             m.smallest);
    v.integer({.name = "per_circle",
               .meaning = "Least number of elements along a full circle of a curved face; 0: curvature does not count.",
               .range = {.low = 0, .high = 1000}},
              m.per_circle);
    v.flag({.name = "quadratic", .meaning = "Tetrahedra of ten nodes, with their middle nodes on the geometry."},
           m.quadratic);
    v.group({.name = "focus", .meaning = "Small elements around a point, growing away from it in all directions."},
            [&] { describe(v, m.focus); });
    v.group({.name = "contact",
             .meaning = "Small elements at the body's sets in contact pairs, growing away from them. The geometry is "
                        "meshed twice: "
                        "without them first, to find the sets."},
            [&] { describe(v, m.contact); });
    describe_share(v, m);
}

void describe(Visitor& v, MeshSpec& mesh) {
    static const Words tags{"block", "half_tube", "contactor", "ball", "cylinder", "tube", "file", "cad"};
    one_of(v, tags,
           {"Axis-parallel block; surfaces x_min x_max y_min y_max z_min z_max.",
            "Lower half of a tube along y, open towards +z; surfaces inner outer y_min y_max rim_left rim_right.",
            "Block with a cylindrical underside along y; surfaces bottom top rear front left right.",
            "Solid ball about the origin; surface outer.", "Solid cylinder along z; surfaces z_min z_max outer.",
            "Tube along z; surfaces inner outer z_min z_max.", "Mesh from a file of another program.",
            "Tetrahedra in a geometry, by Gmsh; surfaces face_<number>."},
           true, mesh.source, [&v](auto& alternative) { describe(v, alternative); });
    Placement& p = mesh.placement;
    v.number({.name = "scale",
              .meaning = "Size factor; applied with the rotation, before the translation.",
              .range = {.low = 1e-12, .high = 1e12}},
             p.scale);
    v.group({.name = "rotate", .meaning = "Rotation about an axis through the origin."}, [&] {
        v.vector({.name = "axis", .meaning = "Direction of the axis.", .range = range::direction, .direction = true},
                 p.axis);
        v.number({.name = "angle",
                  .meaning = "Right-handed angle.",
                  .unit = dimension::angle,
                  .range = {.low = -100, .high = 100}},
                 p.angle);
    });
    v.vector({.name = "translate", .meaning = "Translation.", .unit = dimension::length, .range = range::position},
             p.translation);
}

} // namespace

void describe(Visitor& v, Slice& slice) {
    static const Words kinds{"plane_strain", "plane_stress", "axisymmetric"};
    word(v,
         {.name = "kind",
          .meaning = "plane_strain: no displacement along the normal. plane_stress: free to thicken or thin. "
                     "axisymmetric: a thin wedge of a body of revolution that does not twist.",
          .required = true},
         kinds, slice.kind);
    v.vector({.name = "axis",
              .meaning = "Normal of the plane, or the axis of revolution.",
              .range = range::direction,
              .direction = true},
             slice.axis);
    v.vector({.name = "point",
              .meaning = "A point of the axis of revolution.",
              .unit = dimension::length,
              .range = range::position},
             slice.point);
}

void describe(Visitor& v, Body& body) {
    v.optional_group({.name = "mesh",
                      .meaning = "A generator or a file, and its placement.",
                      .required = true,
                      .instead = "rigid_surface"},
                     body.has_mesh, [&] { describe(v, body.mesh); });
    bool is_exact = body.rigid_surface.has_value();
    RigidSurface exact = body.rigid_surface.value_or(RigidSurface{});
    v.optional_group({.name = "rigid_surface",
                      .meaning = "The exact surface of a rigid body without a mesh, which pairs name as "
                                 "master.rigid_surface."},
                     is_exact, [&] { describe(v, exact); });
    body.rigid_surface = is_exact ? std::optional(std::move(exact)) : std::nullopt;
    bool is_rigid = body.rigid.has_value();
    Rigid rigid = body.rigid.value_or(Rigid{});
    v.optional_group({.name = "rigid",
                      .meaning = "The body does not deform: it moves and turns as one. true: with its mass from volume "
                                 "and density.",
                      .bare_flag = true},
                     is_rigid, [&] { describe(v, rigid); });
    body.rigid = is_rigid || is_exact ? std::optional(rigid) : std::nullopt;
    bool is_slice = body.slice.has_value();
    Slice slice = body.slice.value_or(Slice{});
    v.optional_group({.name = "slice",
                      .meaning =
                          "The body is one layer of elements, whose nodes above one another move alike: it stands "
                          "for a plane body, or for one of revolution."},
                     is_slice, [&] { describe(v, slice); });
    body.slice = is_slice ? std::optional(slice) : std::nullopt;
    const Key law{.name = "material",
                  .meaning = "Constitutive law. Of that of a rigid body only the density counts.",
                  .required = true,
                  .instead = "rigid"};
    bool has_material = body.has_material;
    v.optional_group(law, has_material, [&] { describe(v, body.material); });
    body.has_material = has_material;
    named(v, {.name = "sections", .meaning = "Parts of the body that are of other materials.", .item = "section"},
          body.sections,
          [&v](const std::string& name, Section& section) { v.group({.name = name}, [&] { describe(v, section); }); });
    static const Words formulations{"full", "b_bar", "incompatible_modes", "reduced"};
    word(v,
         {.name = "hex_formulation",
          .meaning = "Formulation of the body's hexahedra. b_bar and incompatible_modes: of hex8; reduced: of hex20."},
         formulations, body.hex_formulation);
    v.text({.name = "finish",
            .meaning = "Name of its surface, for the friction between finishes in contact.general.pairs.",
            .names = Names::identifier},
           body.finish);
    v.vector({.name = "initial_velocity",
              .meaning = "Velocity of every point at the start.",
              .unit = dimension::velocity,
              .range = range::position},
             body.initial_velocity);
    v.vector({.name = "initial_spin",
              .meaning = "Angular velocity at the start, about the centre of mass, on top of initial_velocity.",
              .unit = dimension::spin,
              .range = range::position},
             body.initial_spin);
}

} // namespace osculate::scene
