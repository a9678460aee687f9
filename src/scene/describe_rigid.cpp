/// Descriptions of what moves as one: rigid bodies and couplings.

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

void describe(Visitor& v, Coupling& coupling) {
    v.text({.name = "set",
            .meaning = "Nodes that follow the reference point as one: displacement and rotation, however large.",
            .required = true,
            .names = Names::set},
           coupling.set);
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

} // namespace osculate::scene
