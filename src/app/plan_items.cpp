#include "app/plan_items.hpp"

#include "osculate/time/collision_check.hpp"
#include "osculate/time/linear_solver.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace osculate::app {

std::vector<PlanItem> plan_items(const scene::Scene& scene, const Plan& plan) {
    std::vector<PlanItem> items;
    const auto say = [&](std::string part, bool present, std::string reason) {
        items.push_back({std::move(part), present, std::move(reason)});
    };
    const bool contact = !plan.model.pairs.empty();
    bool friction = false, smooth = false;
    for (const auto& [name, pair] : scene.contact) {
        friction = friction || pair.friction > 0;
        smooth = smooth || !std::holds_alternative<scene::FacetsSurface>(pair.master.surface);
    }
    const bool finite = plan.model.finite_strain != nullptr;
    say("stiffness", true, finite ? "of the bodies at small strain, assembled once" : "assembled once: constant");
    say("finite strain", finite, finite ? "forces and tangent anew at every iterate" : "every body is linear");
    const auto dynamic = std::count_if(plan.stages.begin(), plan.stages.end(),
                                       [](const time::Stage& s) { return s.dynamics.has_value(); });
    say("inertia, damping", dynamic > 0,
        dynamic > 0 ? std::to_string(dynamic) + " dynamic stage(s)" : "every stage is static");
    const auto courses = std::accumulate(plan.stages.begin(), plan.stages.end(), std::size_t{0},
                                         [](std::size_t sum, const time::Stage& s) { return sum + s.courses.size(); });
    const bool follows = std::any_of(plan.stages.begin(), plan.stages.end(),
                                     [](const time::Stage& s) { return !s.follower_pressures.empty(); });
    say("follower pressure", follows, follows ? "forces and tangent anew at every iterate" : "no pressure follows");
    say("courses over time", courses > 0,
        courses > 0 ? std::to_string(courses) + " load(s) and motion(s) by tables or expressions"
                    : "every load and motion ramps or jumps to its value");
    say("contact", contact, contact ? std::to_string(scene.contact.size()) + " pair(s)" : "the scene has no pair");
    double finest = std::numeric_limits<double>::infinity();
    for (const auto& pair : plan.model.pairs) finest = std::min(finest, pair->finest());
    const bool paths = std::ranges::any_of(plan.stages, &time::Stage::follow_paths);
    say("collision check", paths,
        paths ? fmt::format(
                    "paths of open nodes, in steps that move them by {:.3g} m or more against a master, or in which "
                    "they lose it",
                    time::CollisionCheck::reach * finest)
              : (contact ? "every stage is static" : "the scene has no pair"));
    say("friction", friction, friction ? "a pair has mu > 0" : "no pair has mu > 0");
    const bool mortar = std::ranges::any_of(
        scene.contact, [](const auto& pair) { return pair.second.discretisation == scene::Discretisation::mortar; });
    say("mortar weighting", mortar,
        mortar ? "a pair averages gaps over its slave facets" : "no pair asks for discretisation: mortar");
    say("smooth master surface", smooth,
        smooth ? "frozen patches by radial point interpolation" : "no pair asks for one");
    const bool unsymmetric = contact || follows || (finite && dynamic > 0);
    const time::LinearSolver asked = plan.stepper.linear_solver;
    const auto cost = time::condensation_cost(plan.model);
    const bool condensed = time::condenses(plan.model, asked, follows);
    const bool multigrid = time::goes_by_multigrid(plan.model, asked);
    const bool direct = unsymmetric && asked == time::LinearSolver::direct;
    say("multigrid", multigrid,
        multigrid ? fmt::format("cycles over {} nodes in place of factors", plan.model.nodes())
                  : "fewer nodes than cycles pay for, or another solver is asked for");
    say("condensation", condensed,
        !contact            ? "the scene has no pair"
        : multigrid         ? "multigrid is used"
        : finite || follows ? "the tangent of the bodies is not constant"
        : condensed ? fmt::format("on the contact nodes: {:.2g} operations once, a factorisation of all takes {:.2g}",
                                  cost.condensed, cost.factorising)
        : asked == time::LinearSolver::automatic
            ? fmt::format("on so many contact nodes it takes {:.2g} operations and {:.2g} GB, a factorisation of all "
                          "{:.2g} operations",
                          cost.condensed, 1e-9 * cost.bytes, cost.factorising)
            : "another solver is asked for");
    say("LU factorisation", direct, direct ? "asked for, in every iteration" : "only where GMRES gets nowhere");
    say("Cholesky factorisation", !direct && !multigrid,
        direct        ? "the tangent itself is factorised"
        : multigrid   ? "cycles take its place"
        : condensed   ? "of each body, its contact nodes last"
        : contact     ? "of the stiffness with softened contact, to precondition GMRES"
        : unsymmetric ? "of a triangle of the tangent, to precondition GMRES"
                      : "the tangent is symmetric positive definite");
    say("GMRES", multigrid || (unsymmetric && !direct),
        direct        ? "the tangent is factorised"
        : multigrid   ? "with the whole tangent, preconditioned by cycles"
        : condensed   ? "on contact nodes and forces alone"
        : contact     ? "unsymmetric tangent with contact"
        : follows     ? "unsymmetric tangent of follower pressures"
        : unsymmetric ? "unsymmetric tangent of finite strain in dynamics"
                      : "the tangent is symmetric");
    const scene::Output& out = scene.output;
    say("nodal stresses",
        std::any_of(out.body_fields.begin(), out.body_fields.end(),
                    [](const std::string& f) { return f == "stress" || f == "von_mises"; }),
        "output template '" + out.template_name + "'");
    say("frames", out.frame_every > 0, "every " + std::to_string(out.frame_every) + " accepted step(s)");
    say("iterations.csv", out.iterations, out.iterations ? "asked for" : "not asked for");
    return items;
}

} // namespace osculate::app
