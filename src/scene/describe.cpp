#include "scene/describe.hpp"

#include "scene/describe_parts.hpp"

#include <algorithm>

namespace osculate::scene {

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
              "000 nodes, else condensed if it costs less, else multigrid above 10 000 nodes, else iterative."},
         linear_solvers, solver.linear_solver);
    v.flag({.name = "stabilisation",
            .meaning = "In statics, springs hold bodies that nothing else holds, until contact does; no step is "
                       "accepted with springs in place."},
           solver.stabilisation);
    v.flag({.name = "audit",
            .meaning = "After every solved step, look for nodes and edges inside another body or their own, and for "
                       "contact forces on nodes far from the other surface, by geometry alone, independent of contact; "
                       "the summary says if it is off."},
           solver.audit);
    v.number({.name = "audited_depth",
              .meaning =
                  "Fraction of the facet size: how deep a body may lie inside another, or how far a node may be "
                  "from the surface that presses on it, beyond what facets of smooth surfaces bulge by, before the "
                  "audit cuts the step.",
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
    named(v,
          {.name = "imperfections",
           .meaning = "Sets whose nodes are moved before the run, once all sets are known.",
           .names = Names::set,
           .item = "set"},
          scene.imperfections, [&v](const std::string& set, Vec3& by) {
              v.vector({.name = set,
                        .meaning = "By how much; a node of several sets is moved by their sum.",
                        .unit = dimension::length,
                        .range = range::position,
                        .required = true},
                       by);
          });
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
    named(v,
          {.name = "equations",
           .meaning = "Linear equations between displacements, for the whole run.",
           .item = "equation"},
          scene.equations, group);
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
