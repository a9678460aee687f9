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

} // namespace

void describe(Visitor& v, Pair& pair) {
    v.text({.name = "slave",
            .meaning = "Slave surface: its nodes carry the contact.",
            .required = true,
            .names = Names::set,
            .instead = "between"},
           pair.slave);
    v.group({.name = "master", .meaning = "Master side.", .required = true, .instead = "between"},
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
    v.group({.name = "pressure_overclosure",
             .meaning = "How deep the surfaces give way under pressure.",
             .bare_word = true},
            [&] {
                static const Words tags{"exact", "linear"};
                one_of(v, tags, {"They touch and do not overlap.", "As springs would, in statics."}, true,
                       pair.pressure_overclosure, [&v](auto& alternative) { describe(v, alternative); });
            });
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
    v.number({.name = "stiffness_scale",
              .meaning = "Factor on the complementarity function's constant; results do not depend on it.",
              .range = {.low = 1e-6, .high = 1e6}},
             pair.stiffness_scale);
}

void describe(Visitor& v, GeneralContact& general) {
    v.number(
        {.name = "friction", .meaning = "Coulomb's coefficient mu between all bodies.", .range = range::not_negative},
        general.friction);
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
                  v.flag({.name = "contact", .meaning = "false: they do not meet, and pass through one another."},
                         rule.contact);
              });
          });
}

namespace {

void describe(Visitor& v, GeneralisedAlpha& s) {
    v.number(
        {.name = "rho_inf",
         .meaning = "Spectral radius at infinite frequency: 1 keeps all vibrations, 0 damps the fastest ones at once.",
         .range = range::fraction},
        s.rho_inf);
}
void describe(Visitor& v, Newmark& s) {
    v.number({.name = "beta",
              .meaning = "Share of the new acceleration in the displacement.",
              .range = {.low = 0, .high = 1, .open_low = true}},
             s.beta);
    v.number({.name = "gamma",
              .meaning = "Share of the new acceleration in the velocity.",
              .range = {.low = 0.5, .high = 1}},
             s.gamma);
}
void describe(Visitor& v, Hht& s) {
    v.number({.name = "alpha",
              .meaning = "Share of forces at the start of the step, negative.",
              .range = {.low = -1.0 / 3, .high = 0}},
             s.alpha);
}
void describe(Visitor& /*v*/, BackwardEuler& /*s*/) {}

void describe(Visitor& /*v*/, StaticAnalysis& /*s*/) {}
void describe(Visitor& v, DynamicAnalysis& s) {
    v.group({.name = "integrator", .meaning = "Integration in time.", .bare_word = true}, [&] {
        static const Words tags{"generalised_alpha", "newmark", "hht", "backward_euler"};
        one_of(v, tags,
               {"Generalised-alpha of Chung and Hulbert.", "Newmark's method.", "Hilber, Hughes and Taylor's method.",
                "Backward Euler: first order, damps strongly."},
               true, s.integrator, [&v](auto& alternative) { describe(v, alternative); });
    });
    static const Words masses{"consistent", "lumped"};
    word(v, {.name = "mass", .meaning = "Mass matrix."}, masses, s.mass);
    static const Words places{"kept", "redistributed"};
    word(v,
         {.name = "contact_mass",
          .meaning = "Mass of slave nodes: kept, or given to the nodes behind them, so that contact neither adds nor "
                     "removes energy and its forces do not oscillate. The same in all dynamic stages."},
         places, s.contact_mass);
    v.number({.name = "mass_damping",
              .meaning = "Rayleigh damping proportional to mass.",
              .unit = dimension::rate,
              .range = range::not_negative},
             s.mass_damping);
    v.optional_number({.name = "stiffness_damping",
                       .meaning = "Rayleigh damping proportional to stiffness.",
                       .unit = dimension::time,
                       .range = range::not_negative,
                       .default_text = "a tenth of the stage's step where impacts are inelastic, else 0"},
                      s.stiffness_damping);
    static const Words impacts{"automatic", "resolved", "inelastic"};
    word(v,
         {.name = "impacts",
          .meaning = "Impacts shorter than a step. resolved: steps are cut until they follow the rebound. inelastic: "
                     "such a step is one of backward Euler, after which bodies stay together; what it takes is counted "
                     "as damping. automatic: inelastic with general contact, unless the integrator keeps all energy "
                     "(rho_inf 1, alpha 0, gamma 1/2) or control.error_tolerance is given."},
         impacts, s.impacts);
}

} // namespace

namespace {
void describe(Visitor& v, StepControl& s) {
    v.optional_relative_length(
        {.name = "allowed_interpenetration",
         .meaning =
             "A step whose trial takes an open slave node deeper than this is cut. A number without unit counts facet "
             "sizes. In dynamics the depth is never more than a quarter of the thickness of the master's body.",
         .range = {.low = 0, .high = 1, .open_low = true},
         .default_text = "0.05 in dynamics, 0.5 in statics"},
        s.allowed_interpenetration);
    static const Words sizes{"controlled", "fixed"};
    word(v,
         {.name = "step_size",
          .meaning = "controlled: dynamic steps are cut, down to solver.smallest_step, until they keep velocity_error "
                     "(or error_tolerance) and closing_energy. fixed: they are as long as contact and the solver "
                     "allow, and summary.json warns of the energy that closing gaps take."},
         sizes, s.step_size);
    v.number({.name = "velocity_error",
              .meaning =
                  "Estimated error that one dynamic step may make in the velocities of the bodies' centres, as a "
                  "fraction of the speed that all energy so far would give; a step with a larger error is cut.",
              .range = range::positive},
             s.velocity_error);
    v.number({.name = "closing_energy",
              .meaning = "Energy that closing gaps may take in one dynamic step, as a fraction of all energy so far; a "
                         "step that takes more is cut.",
              .range = range::positive},
             s.closing_energy);
    v.optional_number(
        {.name = "error_tolerance",
         .meaning = "Estimated error that one dynamic step may make in the displacement of any node; a step with a "
                    "larger error is cut, and at the smallest step the run gives up. It replaces velocity_error.",
         .unit = dimension::length,
         .range = range::positive,
         .default_text = "no bound"},
        s.error_tolerance);
    v.number({.name = "energy_tolerance",
              .meaning = "Rise of kinetic plus strain energy beyond external work that contact may cause in one "
                         "dynamic step, as a fraction of that energy; a step with a larger rise is cut.",
              .range = range::positive},
             s.energy_tolerance);
    v.number({.name = "growth",
              .meaning = "Factor by which dt grows after an easy step, up to the stage's step.",
              .range = {.low = 1, .high = 10}},
             s.growth);
}
} // namespace

void describe(Visitor& v, Stage& stage) {
    v.group({.name = "analysis", .meaning = "Statics, or dynamics with inertia.", .bare_word = true}, [&] {
        static const Words tags{"static", "dynamic"};
        one_of(v, tags, {"Equilibrium at the end of every step.", "Implicit dynamics; every body needs a density."},
               true, stage.analysis, [&v](auto& alternative) { describe(v, alternative); });
    });
    v.number({.name = "duration",
              .meaning = "Length of the stage.",
              .unit = dimension::time,
              .range = {.low = 1e-12, .high = 1e12}},
             stage.duration);
    v.integer({.name = "steps", .meaning = "Equal steps of the stage.", .range = {.low = 1, .high = 1e6}}, stage.steps);
    v.group({.name = "control", .meaning = "When a step is cut, and how it grows again."},
            [&] { describe(v, stage.control); });
    static const Words ramps{"linear", "step"};
    std::size_t ramp = stage.ramp ? 0 : 1;
    v.word({.name = "ramp", .meaning = "Values change linearly over the stage, or in full in its first step."}, ramps,
           ramp);
    stage.ramp = ramp == 0;
    named(v,
          {.name = "displacement",
           .meaning = "Displacement of sets reached at the end of the stage.",
           .names = Names::set,
           .item = "set"},
          stage.displacement, [&](const std::string& set, std::array<std::optional<Course>, 3>& components) {
              v.group(
                  {.name = set, .meaning = "Components along the set's axes; one left out stays free or as it was."},
                  [&] {
                      for (std::size_t a = 0; a < 3; ++a)
                          v.optional_course({.name = axis_words[a],
                                             .meaning = "Component from the reference position.",
                                             .unit = dimension::length,
                                             .range = range::position},
                                            components[a]);
                  });
          });
    named(v,
          {.name = "pressure",
           .meaning = "Dead pressure on sets, on the reference area, reached at the end of the stage.",
           .names = Names::set,
           .item = "set"},
          stage.pressure, [&](const std::string& set, Course& value) {
              v.course({.name = set,
                        .meaning = "Positive pushes into the body.",
                        .unit = dimension::pressure,
                        .required = true},
                       value);
          });
    named(v,
          {.name = "follower_pressure",
           .meaning = "Pressure on sets that turns and stretches with them, reached at the end of the stage.",
           .names = Names::set,
           .item = "set"},
          stage.follower_pressure, [&](const std::string& set, Course& value) {
              v.course({.name = set,
                        .meaning = "On the current area, against the current normal.",
                        .unit = dimension::pressure,
                        .required = true},
                       value);
          });
    named(v,
          {.name = "body_force",
           .meaning = "Force per volume on bodies, reached at the end of the stage.",
           .names = Names::body,
           .item = "body"},
          stage.body_force, [&](const std::string& body, std::array<Course, 3>& value) {
              v.courses({.name = body,
                         .meaning = "Force per reference volume.",
                         .unit = dimension::force_per_volume,
                         .required = true},
                        value);
          });
    named(v,
          {.name = "release",
           .meaning =
               "Components of sets that are held no longer, neither by supports nor by the displacement of earlier "
               "stages; their forces end with the stage before.",
           .names = Names::set,
           .item = "set"},
          stage.release, [&](const std::string& set, std::array<bool, 3>& value) {
              std::vector<std::string> released;
              for (std::size_t a = 0; a < 3; ++a)
                  if (value[a]) released.push_back(axis_words[a]);
              v.words({.name = set, .meaning = "Components, along the support's axes.", .required = true}, axis_words,
                      released);
              for (std::size_t a = 0; a < 3; ++a) value[a] = std::ranges::count(released, axis_words[a]) > 0;
          });
    named(
        v,
        {.name = "friction",
         .meaning = "Friction of contact pairs from this stage on, instead of contact.<pair>.friction.",
         .names = Names::pair,
         .item = "pair"},
        stage.friction, [&](const std::string& pair, double& value) {
            v.number(
                {.name = pair, .meaning = "Coulomb's coefficient.", .range = {.low = 0, .high = 10}, .required = true},
                value);
        });
    named(v,
          {.name = "pairs",
           .meaning = "Whether contact pairs are in force, from this stage on.",
           .names = Names::pair,
           .item = "pair"},
          stage.pairs, [&](const std::string& pair, bool& value) {
              v.flag({.name = pair,
                      .meaning = "false: the surfaces pass through each other, without a force and unwatched.",
                      .required = true},
                     value);
          });
    named(
        v,
        {.name = "temperature",
         .meaning =
             "Temperature of the nodes of bodies or sets, reached at the end of the stage; where several name a node, "
             "the last one counts.",
         .item = "part"},
        stage.temperature, [&](const std::string& part, Course& value) {
            v.course({.name = part,
                      .meaning = "Above the temperature at which the body has no thermal strain.",
                      .unit = dimension::temperature,
                      .range = {.low = -1e5, .high = 1e5},
                      .required = true},
                     value);
        });
    named(v,
          {.name = "nodal_force",
           .meaning = "Force on the nodes of sets, reached at the end of the stage.",
           .names = Names::set,
           .item = "set"},
          stage.nodal_force, [&](const std::string& set, std::array<Course, 3>& value) {
              v.courses({.name = set,
                         .meaning = "On each node of the set; it keeps its direction.",
                         .unit = dimension::force,
                         .required = true},
                        value);
          });
    named(v,
          {.name = "motion",
           .meaning = "Motion of rigid bodies and couplings reached at the end of the stage.",
           .names = Names::rigid,
           .item = "body"},
          stage.motion, [&](const std::string& body, std::array<std::optional<Course>, 6>& components) {
              v.group({.name = body,
                       .meaning =
                           "Displacement of the reference point and rotation; a component left out stays free or "
                           "as it was."},
                      [&] {
                          for (std::size_t a = 0; a < 6; ++a)
                              v.optional_course(
                                  {.name = motion_words[a],
                                   .meaning = a < 3 ? "Component from the reference position."
                                                    : "Rotation about the axis, the sum of what all steps turn by.",
                                   .unit = a < 3 ? dimension::length : dimension::angle,
                                   .range = range::position},
                                  components[a]);
                      });
          });
    const auto at_reference_point = [&](const char* name, const char* meaning, const char* component,
                                        const Dimension& unit, Named<std::array<Course, 3>>& values) {
        named(v, {.name = name, .meaning = meaning, .names = Names::rigid, .item = "body"}, values,
              [&v, component, unit](const std::string& body, std::array<Course, 3>& value) {
                  v.courses({.name = body, .meaning = component, .unit = unit, .required = true}, value);
              });
    };
    at_reference_point("force", "Force on rigid bodies and couplings, reached at the end of the stage.",
                       "At the reference point; it keeps its direction.", dimension::force, stage.force);
    at_reference_point("moment", "Moment on rigid bodies and couplings, reached at the end of the stage.",
                       "About the reference point, in N m; it keeps its direction.", dimension::moment, stage.moment);
}

void describe(Visitor& v, Solver& solver) {
    v.number({.name = "tolerance",
              .meaning = "Largest residual over the step's reference force.",
              .range = {.low = 0, .high = 1e-2, .open_low = true}},
             solver.tolerance);
    v.integer({.name = "max_iterations",
               .meaning = "Newton iterations of one solve; an attempt may need several.",
               .range = {.low = 1, .high = 1000}},
              solver.max_iterations);
    v.number({.name = "smallest_step",
              .meaning = "Fraction of the stage's step: a run that needs a smaller step gives up.",
              .range = {.low = 0, .high = 1, .open_low = true}},
             solver.smallest_step);
    v.flag({.name = "predictor",
            .meaning = "Move driven bodies rigidly by the prescribed increment before the first iteration."},
           solver.predictor);
    static const Words linear_solvers{"automatic", "condensed", "iterative", "multigrid", "direct"};
    word(v,
         {.name = "linear_solver",
          .meaning =
              "How Newton's linear systems are solved. condensed: on the contact nodes alone, with bodies factorised "
              "once; iterative or multigrid: by GMRES with the whole tangent, preconditioned by a factorisation or by "
              "multigrid; direct: by a factorisation of the tangent in every iteration. automatic: multigrid above 50 "
              "000 nodes, else condensed if it costs less, else multigrid above 20 000 nodes, else iterative."},
         linear_solvers, solver.linear_solver);
    v.flag({.name = "stabilisation",
            .meaning = "In statics, springs hold bodies that nothing else holds, until contact does; no step is "
                       "accepted with springs in place."},
           solver.stabilisation);
    v.flag({.name = "audit",
            .meaning = "After every solved step, look for nodes and edges inside another body or their own, by "
                       "geometry alone, independent of contact; the summary says if it is off."},
           solver.audit);
    v.number({.name = "audited_depth",
              .meaning = "Fraction of the facet size: how deep a body may lie inside another, beyond what facets of "
                         "smooth surfaces bulge by, before the audit cuts the step.",
              .range = {.low = 0, .high = 1, .open_low = true}},
             solver.audited_depth);
}

void describe(Visitor& v, Scene& scene) {
    v.text({.name = "name",
            .meaning = "Name of the scene and of its output folder.",
            .names = Names::identifier,
            .default_text = "the file's name"},
           scene.name);
    v.text({.name = "description", .meaning = "Free text."}, scene.description);
    const auto group = [&v]<class T>(const std::string& name, T& value) {
        v.group({.name = name}, [&] { describe(v, value); });
    };
    named(v, {.name = "bodies", .meaning = "Bodies, deformable or rigid.", .required = true, .item = "body"},
          scene.bodies, group);
    named(v, {.name = "sets", .meaning = "Parts of a body's exterior, or of its nodes.", .item = "set"}, scene.sets,
          group);
    named(
        v,
        {.name = "supports", .meaning = "Constraints of sets, for the whole run.", .names = Names::set, .item = "set"},
        scene.supports, group);
    named(v,
          {.name = "couplings",
           .meaning = "Sets of nodes that follow reference points; stages move and load these by the couplings' names.",
           .item = "coupling"},
          scene.couplings, group);
    named(v, {.name = "ties", .meaning = "Surfaces that are glued to each other for the whole run.", .item = "tie"},
          scene.ties, group);
    named(v,
          {.name = "cyclic",
           .meaning = "Sectors that stand for whole rings: each end of a sector moves as the other.",
           .item = "ring"},
          scene.cyclic, group);
    Entries pairs = entries_of(scene.contact, group);
    bool general = scene.general.has_value();
    GeneralContact all = scene.general.value_or(GeneralContact{});
    pairs.reserved = {"general"};
    pairs.beside_present = [&] { return general; };
    pairs.beside = [&] {
        v.optional_group(
            {.name = "general", .meaning = "All outer surfaces may meet; pairs beside it treat their own surfaces."},
            general, [&] { describe(v, all); });
    };
    v.named({.name = "contact", .meaning = "General contact, and contact pairs.", .item = "pair"}, pairs);
    if (general) scene.general = std::move(all);
    v.vector({.name = "gravity",
              .meaning = "Acceleration of gravity, on every body with a density, in full from the start.",
              .unit = dimension::acceleration,
              .range = range::position},
             scene.gravity);
    named(v,
          {.name = "stages", .meaning = "Stages, in order; the state carries over.", .required = true, .item = "stage"},
          scene.stages, group);
    v.group({.name = "solver", .meaning = "Nonlinear solution."}, [&] { describe(v, scene.solver); });
    v.group({.name = "output", .meaning = "What the run writes."}, [&] {
        v.text({.name = "template",
                .meaning = "Output template: the name of a shipped one or of a file NAME.yaml, or a path to a .yaml "
                           "file; the keys beside it win over it."},
               scene.output.template_name);
        describe_output(v, scene.output);
    });
    bool expected = scene.expect.has_value();
    Expectation expect = scene.expect.value_or(Expectation{});
    v.optional_group({.name = "expect", .meaning = "How the run is expected to end; its summary says whether it did."},
                     expected, [&] { describe(v, expect); });
    if (expected) scene.expect = std::move(expect);
}

} // namespace osculate::scene
