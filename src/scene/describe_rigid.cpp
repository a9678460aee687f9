/// Descriptions of what moves as one: rigid bodies, couplings and ties.

#include "scene/describe_parts.hpp"

#include <algorithm>

namespace osculate::scene {

namespace {
void describe_fixed(Visitor& v, const char* meaning, std::array<bool, 6>& components) {
    std::vector<std::string> fixed;
    for (std::size_t a = 0; a < motion_words.size(); ++a)
        if (components[a]) fixed.push_back(motion_words[a]);
    v.words({.name = "fix", .meaning = meaning, .default_text = "none"}, motion_words, fixed);
    for (std::size_t a = 0; a < motion_words.size(); ++a)
        components[a] = std::ranges::count(fixed, motion_words[a]) > 0;
}
} // namespace

void describe(Visitor& v, Rigid& rigid) {
    v.number({.name = "density",
              .meaning = "Mass per volume; 0: that of the material, if there is one.",
              .unit = dimension::density,
              .range = range::not_negative},
             rigid.density);
    v.optional_number({.name = "mass",
                       .meaning = "Mass, in place of the density's; inertia belongs to it.",
                       .unit = dimension::mass,
                       .range = range::positive,
                       .default_text = "density times volume"},
                      rigid.mass);
    v.optional_vector({.name = "centre",
                       .meaning = "Centre of mass, after the mesh is placed.",
                       .unit = dimension::length,
                       .range = range::position,
                       .default_text = "the centre of the volume"},
                      rigid.centre);
    v.optional_vector({.name = "inertia",
                       .meaning = "Moments of inertia J_xx, J_yy, J_zz about the centre of mass.",
                       .unit = dimension::inertia,
                       .range = range::positive,
                       .default_text = "those of the volume"},
                      rigid.inertia);
    v.optional_vector({.name = "products",
                       .meaning = "J_xy, J_yz, J_xz of the same tensor: J_xy is the integral of -x y over the mass.",
                       .unit = dimension::inertia,
                       .range = {},
                       .default_text = "0 beside inertia"},
                      rigid.products);
    v.optional_vector({.name = "reference_point",
                       .meaning = "Point that fix, motion, force and moment speak of; it moves with the body.",
                       .unit = dimension::length,
                       .range = range::position,
                       .default_text = "the centre of mass"},
                      rigid.reference_point);
    describe_fixed(v,
                   "Components of the reference point's displacement (x, y, z) and of the body's rotation (rx, ry, "
                   "rz) held at zero for the whole run.",
                   rigid.fixed);
}

namespace {

void point_of_surface(Visitor& v, const char* name, const char* meaning, Vec3& value) {
    v.vector({.name = name, .meaning = meaning, .unit = dimension::length, .range = range::position, .required = true},
             value);
}

void direction_of_surface(Visitor& v, const char* name, const char* meaning, Vec3& value) {
    v.vector({.name = name, .meaning = meaning, .range = range::direction, .required = true, .direction = true}, value);
}

void radius_of_surface(Visitor& v, double& value) {
    v.number(
        {.name = "radius", .meaning = "Radius.", .unit = dimension::length, .range = range::size, .required = true},
        value);
}

void describe(Visitor& v, PlaneSurface& s) {
    point_of_surface(v, "point", "A point of it.", s.point);
    direction_of_surface(v, "normal", "Out of the solid, to the side on which slaves are.", s.normal);
}
void describe(Visitor& v, CylinderSurface& s) {
    point_of_surface(v, "axis_point", "A point of its axis.", s.axis_point);
    direction_of_surface(v, "axis_direction", "Direction of its axis.", s.axis_direction);
    radius_of_surface(v, s.radius);
    v.flag({.name = "inside", .meaning = "It is a bore, and slaves are in it."}, s.inside);
}
void describe(Visitor& v, SphereSurface& s) {
    point_of_surface(v, "centre", "Its centre.", s.centre);
    radius_of_surface(v, s.radius);
    v.flag({.name = "inside", .meaning = "It is a hollow, and slaves are in it."}, s.inside);
}
void describe(Visitor& v, ConeSurface& s) {
    point_of_surface(v, "apex", "Its tip.", s.apex);
    direction_of_surface(v, "axis_direction", "From the apex into the cone.", s.axis_direction);
    v.number({.name = "half_angle",
              .meaning = "Between axis and surface.",
              .unit = dimension::angle,
              .range = {.low = 0.001, .high = 1.57},
              .required = true},
             s.half_angle);
    v.flag({.name = "inside", .meaning = "It is a hollow, and slaves are in it."}, s.inside);
}
void describe(Visitor& v, ExtrudedSurface& s) {
    v.points({.name = "points",
              .meaning = "Profile, point by point; the first point again at the end closes it. Beyond the ends of an "
                         "open one nothing is met.",
              .unit = dimension::length,
              .range = range::position,
              .required = true},
             s.points);
    direction_of_surface(v, "direction", "Along which the profile is extruded, without end; points are taken along it.",
                         s.direction);
    direction_of_surface(v, "outward", "To the side of the profile's beginning on which slaves are.", s.outward);
    v.number({.name = "fillet",
              .meaning = "Radius that rounds the corners between lines; 0: they are sharp.",
              .unit = dimension::length,
              .range = range::not_negative},
             s.fillet);
    v.flag({.name = "smooth", .meaning = "A smooth curve of circular arcs through the points instead of lines."},
           s.smooth);
}

} // namespace

void describe(Visitor& v, RigidSurface& surface) {
    static const Words tags{"plane", "cylinder", "sphere", "cone", "extruded"};
    one_of(v, tags,
           {"A half-space.", "A circular cylinder without ends.", "A sphere.", "A circular cone without an end.",
            "A plane curve moved along a direction."},
           true, surface, [&v](auto& alternative) { describe(v, alternative); });
}

void describe(Visitor& v, Coupling& coupling) {
    v.text(
        {.name = "set", .meaning = "Nodes that belong to the reference point.", .required = true, .names = Names::set},
        coupling.set);
    static const Words kinds{"rigid", "distributing"};
    word(v,
         {.name = "kind",
          .meaning =
              "rigid: the nodes follow the reference point as one, displacement and rotation, however large. "
              "distributing: force and moment at the reference point are a traction on the set that is linear in "
              "the place, of the undeformed body, and the nodes move as they do."},
         kinds, coupling.kind);
    v.optional_vector({.name = "reference_point",
                       .meaning = "Point that fix, motion, force and moment speak of; it moves with the nodes.",
                       .unit = dimension::length,
                       .range = range::position,
                       .default_text = "the mean of the nodes"},
                      coupling.reference_point);
    describe_fixed(v,
                   "Components of the reference point's displacement (x, y, z) and of the rotation (rx, ry, rz) held "
                   "at zero for the whole run.",
                   coupling.fixed);
}

void describe(Visitor& v, Tie& tie) {
    v.text({.name = "slave",
            .meaning = "Surface whose nodes follow the other: that of the finer or softer body.",
            .required = true,
            .names = Names::set},
           tie.slave);
    v.text({.name = "master", .meaning = "Surface that they follow.", .required = true, .names = Names::set},
           tie.master);
    v.optional_number(
        {.name = "distance",
         .meaning = "Nodes that are farther from the master are not tied. Others are moved onto it, without strain.",
         .unit = dimension::length,
         .range = range::positive,
         .default_text = "a quarter of the master's facet size"},
        tie.distance);
}

void describe(Visitor& v, CyclicSymmetry& symmetry) {
    v.text({.name = "slave",
            .meaning = "Nodes at one end of the sector: they move as those at the other end do, turned by one sector.",
            .required = true,
            .names = Names::set},
           symmetry.slave);
    v.text({.name = "master",
            .meaning = "Nodes at the other end, one for each node of the slave.",
            .required = true,
            .names = Names::set},
           symmetry.master);
    describe(v, symmetry.axis);
    v.integer({.name = "sectors",
               .meaning = "Number of sectors in the whole ring.",
               .range = {.low = 2, .high = 1e6},
               .required = true},
              symmetry.sectors);
    v.optional_number({.name = "distance",
                       .meaning = "How far a node may be from the turned place of its like; it is moved there.",
                       .unit = dimension::length,
                       .range = range::positive,
                       .default_text = "1 % of the master's shortest distance between nodes"},
                      symmetry.distance);
}

void describe(Visitor& v, Equation& equation) {
    named(v,
          {.name = "terms",
           .meaning = "Sets of nodes of bodies that deform: factors times displacements sum to zero.",
           .required = true,
           .names = Names::set,
           .item = "set"},
          equation.terms, [&](const std::string& set, Vec3& factors) {
              v.vector({.name = set,
                        .meaning = "Factors of the x, y and z displacement of its node, or of the mean of its nodes.",
                        .required = true},
                       factors);
          });
    v.text({.name = "each",
            .meaning = "The set of the terms for each of whose nodes there is one such equation.",
            .names = Names::set,
            .default_text = "one equation, with the means of all sets"},
           equation.each);
}

} // namespace osculate::scene
