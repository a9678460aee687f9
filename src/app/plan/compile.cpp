#include "osculate/app/compile.hpp"

#include "app/fault.hpp"
#include "app/plan/check_derivatives.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/draft_share.hpp"
#include "app/plan/plan_items.hpp"
#include "app/plan/planned_probe.hpp"
#include "app/plan/settle_pairs.hpp"
#include "app/plan/settling.hpp"
#include "app/plan/supports.hpp"
#include "app/report/plots.hpp"
#include "osculate/core/error.hpp"

#include <utility>

namespace osculate::app {

namespace {

void throw_faults(Draft& draft) {
    if (!draft.faults.empty()) throw SceneError(std::move(draft.faults));
}

void check_supports(Draft& draft) {
    if (std::all_of(draft.plan.stages.begin(), draft.plan.stages.end(),
                    [](const time::Stage& s) { return s.dynamics.has_value(); }))
        return; // inertia holds every body
    for (const std::string& body : unsupported_bodies(draft.plan))
        draft.faults.push_back(fault("bodies." + body, "supports or contact that hold the body",
                                     "free rigid-body motions: add supports, or a contact pair that touches it"));
}

void choose_tangents(Draft& draft) {
    const model::ContactPairs pairs = draft.plan.pairs_at_start();
    for (time::Stage& stage : draft.plan.stages) {
        stage.linear_solver = draft.scene.solver.linear_solver;
        stage.tangent =
            equilibrium::choose_tangent(draft.plan.model, pairs, stage.linear_solver, stage.dynamics.has_value(),
                                        !stage.follower_pressures.empty(), draft.plan.scope());
    }
}

/// Bodies, and their nodes where imperfections, ties, sectors and pairs put them.
void place_nodes(Draft& draft, std::vector<mesh::Mesh> meshes) {
    add_bodies(draft, std::move(meshes));
    throw_faults(draft); // nothing below can be trusted on a broken mesh
    add_sets(draft);
    throw_faults(draft);
    move_imperfect_sets(draft);
    throw_faults(draft);
    add_couplings(draft);
    throw_faults(draft);
    add_ties(draft);
    throw_faults(draft);
    add_cyclic_symmetry(draft);
    throw_faults(draft);
    draft.plan.settles_by_rule = settle_dynamics(draft.scene);
    settle_pairs(draft);
    adjust_slaves(draft);
    throw_faults(draft);
}

/// Whether anything places nodes on others.
bool places_nodes(const scene::Scene& scene) {
    return !scene.ties.empty() || !scene.cyclic.empty() ||
           std::ranges::any_of(scene.contact, [](const auto& pair) { return pair.second.adjust.has_value(); });
}

/// Whether what does so has left the imperfections.
void check_imperfections(Draft& draft, const scene::Scene& scene, std::vector<mesh::Mesh> meshes) {
    Draft plain{scene, draft.threads, draft.timings};
    plain.scene.imperfections.clear();
    try {
        place_nodes(plain, std::move(meshes));
    } catch (const SceneError&) {
        // without them a tie may find nothing: its nodes are then where the mesh has them
    }
    check_imperfect_sets(draft, plain);
    throw_faults(draft);
}

} // namespace

model::ContactPairs Plan::pairs_at_start() const {
    model::ContactPairs pairs = model.pairs;
    for (const model::ContactHistory& history : near_at_start) pairs.push_back(history.pair);
    return pairs;
}

const model::ContactScope* Plan::scope() const {
    return scope_at_start ? &*scope_at_start : nullptr;
}

Plan compile(const scene::Scene& scene, std::vector<mesh::Mesh> meshes, int threads, Timings& timings,
             std::shared_ptr<Ranks> ranks) {
    require(meshes.size() == scene.bodies.size(), "compile: one mesh per body");
    Draft draft{scene, threads, timings};
    draft.ranks = std::move(ranks);
    const bool may_undo = !scene.imperfections.empty() && places_nodes(scene);
    std::vector<mesh::Mesh> unmoved;
    if (may_undo) unmoved = meshes;
    place_nodes(draft, std::move(meshes));
    if (may_undo) check_imperfections(draft, scene, std::move(unmoved));
    add_skins(draft);
    throw_faults(draft);
    add_stages(draft);
    throw_faults(draft);
    add_equations(draft);
    check_sectors(draft);
    add_pairs(draft);
    throw_faults(draft);
    add_changes_of_pairs(draft);
    add_general_contact(draft);
    throw_faults(draft);
    check_supports(draft);
    check_gaps(draft);
    draft.plan.probes = make_probes(scene, draft.plan.model, draft.faults);
    throw_faults(draft);
    check_plots(scene, draft.plan, draft.faults);
    check_derivatives(scene, draft.ranks != nullptr, draft.faults);
    check_gradients(scene, draft.plan, draft.ranks != nullptr, draft.faults);
    throw_faults(draft);
    if (draft.ranks) check_distributed(draft);
    throw_faults(draft);
    add_matrices(draft);
    throw_faults(draft);
    choose_tangents(draft);
    draft.plan.stepper = {.tolerance = scene.solver.tolerance,
                          .max_iterations = scene.solver.max_iterations,
                          .predictor = scene.solver.predictor,
                          .stabilisation = scene.solver.stabilisation,
                          .threads = threads,
                          .audit = draft.audited()};
    draft.plan.items = plan_items(draft.scene, draft.plan);
    return std::move(draft.plan);
}

Plan compile(scene::Scene& scene, int threads, Timings& timings, std::shared_ptr<Ranks> ranks) {
    std::vector<std::string> notes;
    std::vector<mesh::Mesh> meshes = build_meshes(scene, &notes);
    Plan plan = compile(std::as_const(scene), std::move(meshes), threads, timings, std::move(ranks));
    plan.mesh_notes = std::move(notes);
    scene.contact = plan.contact;
    scene.general = plan.general;
    (void)settle_dynamics(scene);
    return plan;
}

} // namespace osculate::app
