#include "app/plan/plan_items.hpp"

#include "osculate/equilibrium/tangent_choice.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace osculate::app {

void PlanList::say(std::string part, bool present, std::string reason, PlanCost cost) {
    items_.push_back({std::move(part), present, std::move(reason), present ? std::move(cost) : PlanCost{}});
}

void PlanList::set_cost(const std::string& part, PlanCost cost) {
    for (PlanItem& item : items_)
        if (item.part == part && item.present) item.cost = std::move(cost);
}

double bytes_of(const linear::BlockMatrix& matrix) {
    if (matrix.empty()) return 0;
    const double blocks = matrix.row_end(matrix.rows() - 1);
    return blocks * (sizeof(Mat3) + sizeof(Index)) + sizeof(Index) * static_cast<double>(matrix.rows() + 1);
}

std::size_t dynamic_stages(const Plan& plan) {
    return static_cast<std::size_t>(
        std::ranges::count_if(plan.stages, [](const time::Stage& stage) { return stage.dynamics.has_value(); }));
}

std::vector<PlanItem> plan_items(const scene::Scene& scene, const Plan& plan) {
    PlanList list;
    const auto say = [&](std::string part, bool present, std::string reason) {
        list.say(std::move(part), present, std::move(reason));
    };
    add_body_items(scene, plan, list);
    add_contact_items(scene, plan, list);

    const bool contact = !plan.model.pairs.empty() || plan.model.general, nonlinear = plan.model.nonlinear != nullptr;
    const bool follows = std::any_of(plan.stages.begin(), plan.stages.end(),
                                     [](const time::Stage& s) { return !s.follower_pressures.empty(); });
    const bool rigid = !plan.model.rigid.empty(),
               couplings = std::ranges::any_of(plan.model.rigid, &model::RigidBody::coupling);
    const bool tied = !plan.model.ties.empty() || !plan.model.cyclic.empty() || !plan.model.led.empty();
    const bool unsymmetric = couplings || contact || follows || tied || (nonlinear && dynamic_stages(plan) > 0);
    const LinearSolver asked = scene.solver.linear_solver;
    const auto cost = equilibrium::condensation_cost(plan.model, plan.pairs_at_start(), plan.scope());
    const bool condensed = std::ranges::any_of(plan.stages, [](const time::Stage& s) { return s.tangent.condensed; });
    const bool multigrid = std::ranges::any_of(plan.stages, [](const time::Stage& s) { return s.tangent.multigrid; });
    const bool direct = !multigrid && ((unsymmetric && asked == LinearSolver::direct) ||
                                       (rigid && !couplings && !contact && !follows && !tied));
    const char* bar = equilibrium::bars_multigrid(plan.model, asked);
    say("multigrid", multigrid,
        multigrid ? fmt::format("multigrid cycles over {} nodes instead of factors", plan.model.nodes())
        : bar     ? bar
                  : "the nodes are too few for it to pay off");
    const bool grows = std::ranges::any_of(plan.stages, [](const time::Stage& s) { return s.tangent.grows; });
    say("condensation", condensed,
        grows       ? std::string("on the contact nodes that bear, as long as it costs less than factorisations")
        : condensed ? fmt::format("on the contact nodes: {:.2g} operations once, a factorisation of all takes {:.2g}",
                                  cost.condensed, cost.factorising)
        : !contact  ? "the scene has no pair"
        : multigrid ? "multigrid is used"
        : nonlinear || follows || rigid ? "the tangent of the bodies is not constant"
        : tied                          ? "bodies whose nodes follow others have no compliance of their own"
        : asked == LinearSolver::automatic
            ? fmt::format("on so many contact nodes it takes {:.2g} operations and {:.2g} GB, a factorisation of all "
                          "{:.2g} operations",
                          cost.condensed, 1e-9 * cost.bytes, cost.factorising)
            : "the scene asks for another solver");
    say("LU factorisation", direct,
        direct ? asked == LinearSolver::direct ? "the scene asks for it, in every iteration"
                                               : "of the tangent with rigid bodies, which is not symmetric"
               : "only if GMRES does not converge");
    say("Cholesky factorisation", !direct && !multigrid,
        direct        ? "the tangent itself is factorised"
        : multigrid   ? "multigrid cycles replace it"
        : condensed   ? "of each body, its contact nodes last"
        : contact     ? "of the stiffness with softened contact, to precondition GMRES"
        : tied        ? "of the stiffness with nodes that follow others folded into it, to precondition GMRES"
        : unsymmetric ? "of a triangle of the tangent, to precondition GMRES"
                      : "the tangent is symmetric positive definite");
    say("GMRES", multigrid || (unsymmetric && !direct),
        direct        ? "the tangent is factorised"
        : multigrid   ? "with the whole tangent, preconditioned by multigrid cycles"
        : condensed   ? "on contact nodes and forces alone"
        : contact     ? "unsymmetric tangent with contact"
        : follows     ? "unsymmetric tangent of follower pressures"
        : couplings   ? "unsymmetric tangent of couplings under moments"
        : unsymmetric ? "unsymmetric tangent of finite strain in dynamics"
                      : "the tangent is symmetric");
    constexpr double copies = 2; // of the stiffness: blocks in single precision, interpolation, coarser ones
    list.set_cost("multigrid", {copies * bytes_of(plan.model.K), 0, {}});
    list.set_cost("condensation", {cost.bytes, cost.condensed, "operations once"});
    list.set_cost("Cholesky factorisation", {0, cost.factorising, "operations each"});
    const std::size_t statics = plan.stages.size() - dynamic_stages(plan);
    say("stabilisation springs", false,
        statics == 0                  ? "inertia holds every body"
        : !plan.stepper.stabilisation ? "solver.stabilisation is off"
                                      : "only if a tangent is singular, or as a last resort");
    const bool audit = plan.stepper.audit;
    list.say("audit of geometry", audit,
             audit                ? "bodies inside one another, by the boxes of their facets, after every solved step"
             : scene.solver.audit ? "a single body that deforms little touches nothing"
                                  : "solver.audit is off: nothing looks for bodies inside one another",
             {0, 0, {}});
    list.say("threads", plan.stepper.threads > 1,
             plan.stepper.threads > 1 ? "they share the slave nodes and the rows of matrices"
                                      : "one thread does all the work",
             {0, static_cast<double>(plan.stepper.threads), "threads"});
    add_output_items(scene, plan, list);
    return list.take();
}

} // namespace osculate::app
