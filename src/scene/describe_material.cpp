#include "scene/describe_parts.hpp"

namespace osculate::scene {

namespace {

void describe_density(Visitor& v, ElasticConstants& m) {
    v.number({.name = "density",
              .meaning = "Mass per volume; 0 where the body has none.",
              .unit = dimension::density,
              .range = range::not_negative},
             m.density);
    v.number({.name = "expansion",
              .meaning = "Thermal expansion, see stages.<stage>.temperature.",
              .unit = dimension::expansion,
              .range = {.low = -1, .high = 1}},
             m.expansion);
}

void describe(Visitor& v, Orthotropic& m) {
    v.vector({.name = "E",
              .meaning = "Young's moduli along the three axes.",
              .unit = dimension::pressure,
              .range = range::positive,
              .required = true},
             m.moduli);
    v.vector(
        {.name = "nu",
         .meaning =
             "Poisson's ratios nu_12, nu_13, nu_23: of the contraction along the second axis under tension along the "
             "first.",
         .range = {.low = -100, .high = 100},
         .required = true},
        m.ratios);
    v.vector({.name = "G",
              .meaning = "Shear moduli G_12, G_13, G_23.",
              .unit = dimension::pressure,
              .range = range::positive,
              .required = true},
             m.shear);
    v.axes({.name = "axes", .meaning = "The first two axes, made orthonormal; the third is normal to both."}, m.axes);
    describe_density(v, m);
    m.E = m.moduli.maxCoeff();
    m.nu = 0.3;
}

void describe(Visitor& v, ElasticConstants& m) {
    v.number({.name = "E",
              .meaning = "Young's modulus.",
              .unit = dimension::pressure,
              .range = range::positive,
              .required = true},
             m.E);
    v.number({.name = "nu",
              .meaning = "Poisson's ratio.",
              .range = {.low = -1, .high = 0.5, .open_low = true, .open_high = true},
              .required = true},
             m.nu);
    describe_density(v, m);
}

void describe(Visitor& v, ElasticPlastic& m) {
    describe(v, static_cast<ElasticConstants&>(m));
    v.course({.name = "yield_stress",
              .meaning =
                  "Yield stress in uniaxial tension: a value, or a table whose first column is the equivalent plastic "
                  "strain, from 0, in place of time; constant after its last row.",
              .unit = dimension::pressure,
              .range = range::positive,
              .required = true},
             m.yield_stress);
}

} // namespace

void describe(Visitor& v, Material& material) {
    static const Words tags{"linear_elastic", "saint_venant_kirchhoff", "neo_hookean", "elastic_plastic",
                            "orthotropic"};
    one_of(v, tags,
           {"Isotropic linear elasticity at small strain: no large rotations.",
            "Hooke's law at finite strain: large rotations, small strains.",
            "Compressible neo-Hookean elasticity: large rotations, large strains.",
            "Von Mises plasticity with isotropic hardening: large rotations, large strains.",
            "Linear elasticity with three axes of its own at small strain: no large rotations."},
           true, material, [&v](auto& alternative) { describe(v, alternative); });
}

void describe(Visitor& v, Section& section) {
    static const Words tags{"elements", "box"};
    v.one_of({.tags = tags,
              .active = section.elements.index(),
              .required = true,
              .choose = [&](std::size_t i) { emplace(section.elements, i, std::make_index_sequence<2>{}); },
              .describe =
                  [&](std::size_t i) {
                      if (i == 0)
                          v.text({.name = "elements",
                                  .meaning = "A part that the mesh file names: an element set, block or volume. Where "
                                             "several sections have an element, the last of them counts.",
                                  .required = true},
                                 std::get<std::string>(section.elements));
                      else
                          v.group({.name = "box", .meaning = "Elements whose centre is inside a box."},
                                  [&] { describe(v, std::get<SelectBox>(section.elements)); });
                  }});
    v.group({.name = "material", .meaning = "Constitutive law of these elements.", .required = true},
            [&] { describe(v, section.material); });
}

} // namespace osculate::scene
