/// Keys of stages.

#include "scene/describe.hpp"
#include "scene/describe_parts.hpp"

#include <algorithm>

namespace osculate::scene {

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
          {.name = "pressure_overclosure",
           .meaning = "Law of contact pairs from this stage on, instead of contact.<pair>.pressure_overclosure.",
           .names = Names::pair,
           .item = "pair"},
          stage.pressure_overclosure, [&](const std::string& pair, PressureOverclosure& value) {
              describe_overclosure(
                  v, {.name = pair, .meaning = "How deep its surfaces give way under pressure.", .bare_word = true},
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
          {.name = "centrifugal",
           .meaning = "Centrifugal force on bodies that turn about an axis, reached at the end of the stage.",
           .names = Names::body,
           .item = "body"},
          stage.centrifugal, [&](const std::string& body, Centrifugal& value) {
              v.group(
                  {.name = body, .meaning = "Of the undeformed body, with its density; seen from axes that turn."},
                  [&] {
                      describe(v, value.axis);
                      v.number(
                          {.name = "speed",
                           .meaning = "Angular speed; the force grows with its square, and ramps as loads do. 0: none.",
                           .unit = dimension::spin,
                           .range = {.low = 0, .high = 1e9},
                           .required = true},
                          value.speed);
                  });
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

} // namespace osculate::scene
