/// Parts of a plan: files, and what is computed for them alone.

#include "app/plan/plan_items.hpp"
#include "osculate/output/fields.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace osculate::app {

namespace {

using output::FieldPlace;

struct Place {
    FieldPlace where;
    const char* prefix;
    const std::vector<std::string>& asked;
    double points; ///< of all bodies, slave surfaces or masters
};

std::vector<Place> places(const scene::Output& out, const model::Model& model) {
    double slaves = 0, vertices = 0;
    for (const auto& pair : model.pairs) {
        slaves += pair->size();
        vertices += static_cast<double>(pair->master_nodes().size());
    }
    return {{FieldPlace::body, "field ", out.body_fields, static_cast<double>(model.nodes())},
            {FieldPlace::slave, "slave field ", out.slave_fields, slaves},
            {FieldPlace::master, "master field ", out.master_fields, vertices}};
}

bool names(const std::vector<std::string>& fields, const char* name) {
    return std::ranges::count(fields, name) > 0;
}

std::string not_named(const scene::Output& out) {
    return "not asked for: output template '" + out.template_name + "'";
}

/// What frames hold, field by field; bytes a frame of all of them.
double add_fields(const scene::Output& out, const model::Model& model, PlanList& list) {
    const std::string not_asked = not_named(out);
    double all = 0;
    for (const Place& place : places(out, model))
        for (const output::OutputField& field : output::all_fields()) {
            if (field.where != place.where) continue;
            const bool asked = names(place.asked, field.name), somewhere = place.points > 0;
            const bool present = asked && somewhere && out.frame_every > 0;
            const double bytes = place.points * field.components * static_cast<double>(sizeof(double));
            list.say(place.prefix + std::string(field.name), present,
                     present      ? "asked for"
                     : !somewhere ? "the scene has no pair"
                     : !asked     ? not_asked
                                  : "no frame is written",
                     {0, bytes, "B a frame"});
            all += present ? bytes : 0;
        }
    return all;
}

} // namespace

void add_output_items(const scene::Scene& scene, const Plan& plan, PlanList& list) {
    const scene::Output& out = scene.output;
    const model::Model& model = plan.model;
    const bool frames = out.frame_every > 0, contact = !model.pairs.empty() || model.general,
               dynamic = dynamic_stages(plan) > 0;
    const std::string not_asked = not_named(out);
    const double bytes = add_fields(out, model, list);
    list.say("frames", frames, frames ? fmt::format("every {} accepted step(s)", out.frame_every) : "frame_every is 0",
             {0, bytes, "B a frame"});
    const bool beside = frames && plan.stepper.threads > 1;
    list.say("frames on a second thread", beside,
             beside   ? "a second thread writes files during the next step"
             : frames ? "the run has one thread"
                      : "no frame is written");
    constexpr const char* of_stress[] = {"stress", "von_mises", "stress_max", "stress_mid", "stress_min"};
    const bool in_probes = std::ranges::any_of(plan.probes, [&](const PlannedProbe& probe) {
        return std::ranges::any_of(of_stress, [&](const char* field) { return probe.probe->reads(field); });
    });
    const bool stresses =
        in_probes ||
        (frames && std::ranges::any_of(of_stress, [&](const char* f) { return names(out.body_fields, f); }));
    double elements = 0;
    for (const model::Body& body : model.bodies) elements += static_cast<double>(body.mesh.element_count());
    list.say("nodal stresses", stresses,
             in_probes  ? "a probe needs them"
             : stresses ? "a field of frames needs them"
             : !frames  ? "no frame is written"
                        : not_asked,
             {0, elements, in_probes ? "elements a row" : "elements a frame"});

    const bool reactions = out.history_reactions && !plan.constrained_sets.empty();
    const bool in_frames = frames && names(out.body_fields, "reaction");
    const bool read =
        std::ranges::any_of(plan.probes, [](const PlannedProbe& p) { return p.probe->reads("reaction"); });
    list.say("nodal reactions", reactions || in_frames || read,
             reactions   ? "history.csv sums them"
             : read      ? "a probe needs them"
             : in_frames ? "a field of frames needs them"
                         : "neither history.csv nor a frame needs them",
             {0, static_cast<double>(model.nodes()), reactions || read ? "nodes a step" : "nodes a frame"});
    list.say("history.csv", true, "a row per accepted step", {0, 1, "row a step"});
    double slaves = 0;
    for (const auto& pair : plan.pairs_at_start()) slaves += pair->size();
    list.say("history of pairs", out.history_pairs && contact,
             !contact            ? "the scene has no pair"
             : out.history_pairs ? "asked for"
                                 : not_asked,
             {0, slaves, "slave nodes a step"});
    list.say("history of reactions", reactions,
             reactions               ? "asked for"
             : out.history_reactions ? "no set is held or driven"
                                     : not_asked,
             {0, 3 * static_cast<double>(plan.constrained_sets.size()), "columns"});
    list.say("history of energies", dynamic, dynamic ? "the energy ledger, in dynamic stages" : "every stage is static",
             {0, 14, "columns"});
    list.say("steps.csv", true, "a row per attempted step", {0, 1, "row an attempt"});
    list.say("iterations.csv", out.iterations, out.iterations ? "asked for" : "not asked for",
             {0, 1, "row an iteration"});
    list.say("checks", true, "balance of forces, penetration and, in dynamics, energies, into summary.json",
             {0, static_cast<double>(model.nodes()), "nodes a step"});
    double places = 0;
    for (const PlannedProbe& probe : plan.probes) places += probe.probe->places();
    list.say("probes", !plan.probes.empty(),
             plan.probes.empty() ? "none is asked for" : fmt::format("{} table(s) in probes/", plan.probes.size()),
             {0, places, "places a row"});
    list.say("derivatives", !out.derivatives.empty(),
             out.derivatives.empty() ? "none is asked for" : "two runs of a changed scene follow this one for each",
             {0, 2 * static_cast<double>(out.derivatives.size() * model.nodes()), "nodes a step"});
    std::size_t numbers = 0;
    for (const auto& [name, gradient] : out.gradients) numbers += gradient.by.size();
    list.say("gradients", numbers > 0,
             numbers == 0 ? "none is asked for"
                          : "the adjoint of the run, after it; two changed scenes for each number",
             {0, 2 * static_cast<double>(numbers) * static_cast<double>(model.nodes()), "nodes a step"});
    list.say("plots", !out.plots.empty(), out.plots.empty() ? "none is asked for" : "drawn at the end of the run",
             {0, static_cast<double>(out.plots.size()), "pictures"});
    list.say("show_in_paraview.py", frames && out.paraview,
             !frames        ? "no frame is written"
             : out.paraview ? "asked for"
                            : not_asked);
    list.say("report", out.report, out.report ? "asked for" : not_asked);
    list.say("expectation", scene.expect.has_value(),
             scene.expect ? "the scene says how it ends" : "the scene has no expect");
    list.say("post-mortem", false, "only if the run gives up");
    list.say("failed iterate", false, out.failed_iterate ? "only if the run gives up" : "output.failed_iterate is off");
}

} // namespace osculate::app
