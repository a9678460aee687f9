/// Keys of contact pairs and general contact.

#include "scene/describe.hpp"
#include "scene/describe_parts.hpp"

#include <algorithm>

namespace osculate::scene {

namespace {

constexpr const char* hysteresis_meaning = "A facet is left only for one closer by this fraction of its size.";
constexpr Range hysteresis_range{.low = 0, .high = 1, .open_high = true};

void describe(Visitor& /*v*/, AutomaticSurface& /*s*/) {}

void describe(Visitor& v, FacetsSurface& s) {
    v.number({.name = "hysteresis", .meaning = hysteresis_meaning, .range = hysteresis_range}, s.hysteresis);
}

/// What all surfaces through radial point interpolation have in common.
template <class Surface> void describe_patches(Visitor& v, Surface& s, const char* ring_meaning) {
    v.integer({.name = "ring", .meaning = ring_meaning, .range = {.low = 1, .high = 3}}, s.ring);
    static const Words bases{"automatic", "multiquadric", "r3", "r5"};
    word(v,
         {.name = "basis",
          .meaning =
              "Radial functions: multiquadric, or polyharmonic r^3 or r^5, which have no R and q. automatic: with "
              "petrov_galerkin r5 in patches that resolve the surface, at most 20 degrees a facet, and r3 in others; "
              "with other discretisations, or if R or q is given, the multiquadric."},
         bases, s.basis);
    v.number({.name = "R",
              .meaning = "Shape parameter of the multiquadric, in mean nearest-neighbour distances of the patch.",
              .range = {.low = 0, .high = 4}},
             s.R);
    v.number({.name = "q",
              .meaning = "Exponent of the multiquadric; not a whole number.",
              .range = {.low = -4, .high = 3},
              .not_whole = true},
             s.q);
    static const Words sizes{"3", "6"};
    std::size_t index = s.m == 3 ? 0 : 1;
    v.word({.name = "m", .meaning = "Terms of the polynomial basis: 3 linear, 6 quadratic."}, sizes, index);
    s.m = index == 0 ? 3 : 6;
    static const Words coordinates{"tangential", "equal_length"};
    word(v, {.name = "coordinates", .meaning = "How patch nodes are laid out on the reference plane."}, coordinates,
         s.coordinates);
}

void describe(Visitor& v, RpimSurface& s) {
    describe_patches(v, s, "Rings of facets around the projection's facet whose nodes make its patch.");
    v.number({.name = "hysteresis", .meaning = hysteresis_meaning, .range = hysteresis_range}, s.hysteresis);
}

void describe(Visitor& v, BlendSurface& s) {
    describe_patches(v, s, "Rings of facets around a vertex whose nodes make its patch.");
}

void describe(Visitor& v, MasterSpec& master) {
    v.text({.name = "set",
            .meaning = "Master surface.",
            .required = true,
            .names = Names::set,
            .instead = "contact.<pair>.between or rigid_surface"},
           master.set);
    v.text({.name = "rigid_surface",
            .meaning = "Body with a rigid_surface, whose exact surface is the master, in place of set.",
            .names = Names::body},
           master.rigid_surface);
    if (!master.rigid_surface.empty()) return; // it is exact
    v.group({.name = "surface",
             .meaning = "Geometry of the master; contact.<pair>.surface is short for it.",
             .bare_word = true},
            [&] {
                static const Words tags{"automatic", "facets", "rpim", "blend"};
                one_of(v, tags,
                       {"Facets where every face of the master is plane, forces act at nodes and a stage is dynamic; "
                        "else blend.",
                        "The finite element surface as it is.",
                        "Smooth patches by radial point interpolation with a polynomial basis, one per facet.",
                        "Such patches around every vertex, with their gaps blended: smooth over all edges."},
                       true, master.surface, [&v](auto& alternative) { describe(v, alternative); });
            });
}

void describe(Visitor&, ExactContact&) {}

void describe(Visitor& v, LinearOverclosure& law) {
    v.number({.name = "stiffness",
              .meaning = "Contact pressure over overclosure.",
              .unit = dimension::force_per_volume,
              .range = range::positive,
              .required = true},
             law.stiffness);
}

void describe(Visitor& v, ExponentialOverclosure& law) {
    v.number({.name = "pressure",
              .meaning = "Contact pressure where the surfaces just touch.",
              .unit = dimension::pressure,
              .range = range::positive,
              .required = true},
             law.pressure);
    v.number({.name = "clearance",
              .meaning = "Gap at which the pressure is a hundredth of that; a little farther apart there is none.",
              .unit = dimension::length,
              .range = range::positive,
              .required = true},
             law.clearance);
}

void describe(Visitor& v, TabularOverclosure& law) {
    v.table({.name = "table",
             .meaning =
                 "Contact pressure over overclosure, a gap where it is negative: linear in between and beyond the "
                 "last row; the first row has no pressure, and pressures grow.",
             .unit = dimension::pressure,
             .range = range::not_negative,
             .required = true},
            {.name = "overclosure", .unit = dimension::length}, law.table);
}

} // namespace

void describe_overclosure(Visitor& v, const Key& key, PressureOverclosure& law) {
    v.group(key, [&] {
        static const Words tags{"exact", "linear", "exponential", "tabular"};
        one_of(v, tags,
               {"They touch and do not overlap.", "As springs would.",
                "By a pressure that grows a hundredfold over the clearance.", "By a table."},
               true, law, [&v](auto& alternative) { describe(v, alternative); });
    });
}

void describe(Visitor& v, Pair& pair) {
    v.text({.name = "slave",
            .meaning = "Slave surface: its nodes carry the contact.",
            .required = true,
            .names = Names::set,
            .instead = "between"},
           pair.slave);
    v.group({.name = "master",
             .meaning = "Master side; master: NAME is short for master: {set: NAME}.",
             .required = true,
             .instead = "between"},
            [&] { describe(v, pair.master); });
    v.two_names({.name = "between",
                 .meaning = "The two sides, in place of slave and master.set: the slave is the softer one if the other "
                            "is 100 times as stiff, else the finer one by 10 percent, else the softer one by as much, "
                            "else the first.",
                 .names = Names::set},
                pair.between);
    static const Words discretisations{"automatic", "node", "mortar", "petrov_galerkin"};
    std::size_t index = pair.discretisation ? 1 + static_cast<std::size_t>(*pair.discretisation) : 0;
    v.word({.name = "discretisation",
            .meaning =
                "Where gaps are measured and how forces reach the master. node: at the slave nodes alone, which "
                "conserves energy. mortar: gaps and forces are averaged over the slave facets with dual shape "
                "functions, which passes the patch test on any meshes. petrov_galerkin: gaps at the slave nodes, "
                "averaged forces; passes it too, and ripples least. automatic: petrov_galerkin if every stage is "
                "static, else node."},
           discretisations, index);
    pair.discretisation = index == 0 ? std::nullopt : std::optional(static_cast<Discretisation>(index - 1));
    v.number({.name = "friction", .meaning = "Coulomb's coefficient mu.", .range = range::not_negative}, pair.friction);
    v.optional_number({.name = "static_friction",
                       .meaning =
                           "Coulomb's coefficient of nodes that do not slide, no less than friction: a node that "
                           "slid in the last step has friction in this one. Without it they are the same.",
                       .range = range::positive},
                      pair.static_friction);
    describe_overclosure(v,
                         {.name = "pressure_overclosure",
                          .meaning = "How deep the surfaces give way under pressure.",
                          .bare_word = true},
                         pair.pressure_overclosure);
    v.number({.name = "damping",
              .meaning =
                  "Contact pressure over the speed at which the surfaces close, of a pair that gives way; in dynamics. "
                  "There is no tension where they part.",
              .unit = dimension::pressure_per_velocity,
              .range = range::not_negative},
             pair.damping);
    v.number({.name = "tangential_damping",
              .meaning = "Traction against sliding over its speed, beside friction; in dynamics.",
              .unit = dimension::pressure_per_velocity,
              .range = range::not_negative},
             pair.tangential_damping);
    v.optional_number({.name = "stick_stiffness",
                       .meaning = "Friction over elastic slip before it reaches Coulomb's bound, in statics; without "
                                  "it nodes stick exactly.",
                       .unit = dimension::force_per_volume,
                       .range = range::positive},
                      pair.stick_stiffness);
    v.optional_number({.name = "adjust",
                       .meaning =
                           "Slave nodes as near to the master's surface as this, outside or inside, are moved onto it "
                           "before the run, without strain.",
                       .unit = dimension::length,
                       .range = range::positive},
                      pair.adjust);
    v.number({.name = "closing_tolerance",
              .meaning = "The first solve closes nodes whose gap is smaller than this fraction of the facet size.",
              .range = range::fraction},
             pair.closing_tolerance);
    v.number({.name = "initial_overlap_limit",
              .meaning = "An initial overlap deeper than this fraction of the facet size is a fault.",
              .range = range::fraction},
             pair.initial_overlap_limit);
    v.number(
        {.name = "stiffness_scale",
         .meaning =
             "Factor on the complementarity function's constant. Results do not depend on it, but a little where slave "
             "nodes stick that are held or driven: they stick elastically.",
         .range = {.low = 1e-6, .high = 1e6}},
        pair.stiffness_scale);
}

void describe(Visitor& v, GeneralContact& general) {
    v.number(
        {.name = "friction", .meaning = "Coulomb's coefficient mu between all bodies.", .range = range::not_negative},
        general.friction);
    v.optional_number({.name = "static_friction", .meaning = "As for pairs.", .range = range::positive},
                      general.static_friction);
    static const Words surfaces{"automatic", "facets", "blend"};
    word(v,
         {.name = "surface",
          .meaning =
              "Geometry of the masters: as for pairs. automatic: facets for bodies all of whose faces are plane if "
              "a stage is dynamic, else blend."},
         surfaces, general.surface);
    static const Words discretisations{"automatic", "node", "petrov_galerkin"};
    std::size_t index = !general.discretisation ? 0 : *general.discretisation == Discretisation::node ? 1 : 2;
    v.word({.name = "discretisation", .meaning = "As for pairs."}, discretisations, index);
    if (index == 0)
        general.discretisation = std::nullopt;
    else
        general.discretisation = index == 1 ? Discretisation::node : Discretisation::petrov_galerkin;
    v.number({.name = "closing_tolerance", .meaning = "As for pairs.", .range = range::fraction},
             general.closing_tolerance);
    v.number({.name = "initial_overlap_limit", .meaning = "As for pairs.", .range = range::fraction},
             general.initial_overlap_limit);
    v.number({.name = "stiffness_scale", .meaning = "As for pairs.", .range = {.low = 1e-6, .high = 1e6}},
             general.stiffness_scale);
    named(v,
          {.name = "pairs",
           .meaning = "What differs between certain bodies; the last rule that names two bodies counts.",
           .item = "rule"},
          general.pairs, [&](const std::string& name, GeneralRule& rule) {
              v.group({.name = name}, [&] {
                  v.two_names(
                      {.name = "between", .meaning = "Two bodies, or two finishes, or one of each.", .required = true},
                      rule.between);
                  v.optional_number({.name = "friction",
                                     .meaning = "Coulomb's coefficient mu between them.",
                                     .range = range::not_negative,
                                     .default_text = "that of contact.general"},
                                    rule.friction);
                  v.optional_number({.name = "static_friction",
                                     .meaning = "Coulomb's coefficient of nodes that do not slide.",
                                     .range = range::positive,
                                     .default_text = "that of contact.general, or the rule's own friction"},
                                    rule.static_friction);
                  v.flag({.name = "contact", .meaning = "false: they do not meet, and pass through one another."},
                         rule.contact);
              });
          });
}

} // namespace osculate::scene
