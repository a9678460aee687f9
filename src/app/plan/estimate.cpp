#include "osculate/app/estimate.hpp"

#include "app/plan/plan_items.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/model/general_contact.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::app {

namespace {

/// Newton iterations that a step usually takes.
struct Habits {
    static constexpr double loading = 6; ///< first step of a stage with contact
    static constexpr double next = 3;    ///< each after it
    static constexpr double moving = 5;  ///< of dynamics: a trial and a solve
    static constexpr double alone = 1;   ///< linear bodies without contact
};

double iterations(const Plan& plan) {
    const bool linear = plan.model.pairs.empty() && !plan.model.general && plan.model.nonlinear == nullptr;
    double sum = 0;
    for (const time::Stage& stage : plan.stages)
        sum += linear ? Habits::alone * stage.steps
                      : Habits::loading + (stage.dynamics ? Habits::moving : Habits::next) * (stage.steps - 1);
    return sum;
}

double steps(const Plan& plan, bool dynamic) {
    double sum = 0;
    for (const time::Stage& stage : plan.stages) sum += stage.dynamics.has_value() == dynamic ? stage.steps : 0;
    return sum;
}

/// Slave nodes, each times the nodes of a patch of its master over those of two rings of quadrilaterals.
struct Slaves {
    double facets = 0, rpim = 0, blend = 0, all = 0;
};

Slaves slaves(const scene::Scene& scene, const Plan& plan) {
    constexpr double mortar = 2; // evaluations a node
    const auto patch = [](int ring) { return std::pow((2 * ring + 1) / 5.0, 2); };
    Slaves sum;
    for (const auto& pair : plan.model.pairs) {
        const scene::Pair& spec = *scene::find(scene.contact, pair->name());
        const double n = pair->size() * (pair->options().discretisation == Discretisation::mortar ? mortar : 1.0);
        if (const auto* rpim = std::get_if<scene::RpimSurface>(&spec.master.surface))
            sum.rpim += n * patch(rpim->ring);
        else if (const auto* blend = std::get_if<scene::BlendSurface>(&spec.master.surface))
            sum.blend += n * patch(blend->ring);
        else
            sum.facets += n;
        sum.all += pair->size();
    }
    for (const model::ContactHistory& history : plan.near_at_start) {
        const double n = history.pair->size();
        const auto master = static_cast<std::size_t>(plan.model.general->sides_of(*history.pair).second);
        (plan.model.general->surfaces()[master].smooth ? sum.blend : sum.facets) += n;
        sum.all += n;
    }
    return sum;
}

double nonlinear_elements(const Plan& plan) {
    double sum = 0;
    for (const model::Body& body : plan.model.bodies)
        if (std::ranges::any_of(body.kernels, [](const auto& kernel) { return !kernel->linear(); }))
            sum += body.mesh.element_count();
    return sum;
}

/// Bytes of a sparse factorisation of a solid of so many unknowns: `scripts/pages/growth` measured 92 to 147 times n^1.4.
double factor_bytes(double unknowns) {
    return 130 * std::pow(unknowns, 1.4);
}

/// Whether the nodes that are condensed on come as contact does.
bool grows(const Plan& plan) {
    return std::ranges::any_of(plan.stages, [](const time::Stage& s) { return s.tangent.grows; });
}

double bytes(const Plan& plan, bool multigrid, bool condensed) {
    constexpr double program = 2.8e7;     // libraries, before anything is read
    constexpr double by_multigrid = 2200; // an unknown: blocks in single precision, coarser grids, GMRES
    constexpr double element = 2000;      // mesh, surfaces, search
    double sum = program;
    for (const PlanItem& item : plan.items)
        if (item.present && item.part != "multigrid" && item.part != "condensation") sum += item.cost.bytes;
    for (const model::Body& body : plan.model.bodies) sum += element * body.mesh.element_count();
    const double unknowns = 3.0 * plan.model.nodes();
    if (multigrid) return sum + by_multigrid * unknowns;
    const auto cost = equilibrium::condensation_cost(plan.model, plan.pairs_at_start(), plan.scope());
    constexpr double copied = 1.2; // the part of the factors near contact, once more in single precision
    if (!condensed || (grows(plan) && !cost.pays())) return sum + copied * factor_bytes(unknowns);
    for (const model::Body& body : plan.model.bodies) sum += factor_bytes(3.0 * body.nodes());
    return sum + cost.bytes;
}

} // namespace

std::vector<CostTerm> cost_terms(const scene::Scene& scene, const Plan& plan) {
    const bool multigrid = std::ranges::any_of(plan.stages, [](const time::Stage& s) { return s.tangent.multigrid; });
    const auto cost = equilibrium::condensation_cost(plan.model, plan.pairs_at_start(), plan.scope());
    const bool condensed = std::ranges::all_of(plan.stages, [](const time::Stage& s) { return s.tangent.condensed; }) &&
                           (!grows(plan) || cost.pays());
    const bool changing = plan.model.nonlinear != nullptr || !plan.model.pairs.empty() || plan.model.general;
    const double all = steps(plan, false) + steps(plan, true), solves = iterations(plan);
    const double nodes = plan.model.nodes(), blocks = plan.model.K.row_end(plan.model.K.rows() - 1);
    const Slaves s = slaves(scene, plan);
    double elements = 0;
    for (const model::Body& body : plan.model.bodies) elements += body.mesh.element_count();
    const double frames = scene.output.frame_every > 0 ? all / scene.output.frame_every : 0;
    const double fields = 1.0 + static_cast<double>(scene.output.body_fields.size());
    const bool lasts = std::ranges::all_of(plan.stages, [](const time::Stage& stage) { return stage.tangent.reduced; });
    constexpr double steps_served = 4; // by factors that last, about
    const double factorisations = condensed  ? 1
                                  : changing ? (lasts ? std::max(1.0, all / steps_served) : all)
                                             : static_cast<double>(plan.stages.size());
    return {
        {"start", 1, 0.019},
        {"elements", elements, 3e-5},
        {"steps", all, 1.3e-3},
        {"values in frames", frames * fields * nodes, 5e-7},
        {"evaluations of facets", solves * s.facets, 1e-6},
        {"evaluations of rpim", solves * s.rpim, 3.5e-5},
        {"evaluations of blend", solves * s.blend, 8.8e-5},
        {"operations of factorisations", multigrid ? 0 : factorisations * cost.factorising, 1.9e-11},
        // by docs/data/growth.md
        {"nodes in cycles", multigrid ? solves * nodes : 0, 5e-5},
        {"factors' bytes, GMRES", changing && !multigrid && !condensed ? solves * factor_bytes(3 * nodes) : 0, 1.1e-9},
        {"operations of condensation", condensed ? cost.condensed : 0, 7.2e-10},
        {"3x3 blocks, Newton", solves * blocks, 5e-8},
        {"3x3 blocks, dynamic steps", steps(plan, true) * blocks, 1e-7},
        {"nonlinear elements", solves * nonlinear_elements(plan), 1.7e-5}};
}

Estimate estimate(const scene::Scene& scene, const Plan& plan) {
    const auto any = [&](bool equilibrium::TangentChoice::*what) {
        return std::ranges::any_of(plan.stages, [&](const time::Stage& s) { return s.tangent.*what; });
    };
    Estimate result;
    result.steps = steps(plan, false) + steps(plan, true);
    for (const CostTerm& term : cost_terms(scene, plan)) result.seconds += term.count * term.seconds;
    result.bytes =
        bytes(plan, any(&equilibrium::TangentChoice::multigrid), any(&equilibrium::TangentChoice::condensed));
    // of each, two models and some half of a run, see docs/data/derivatives.md
    const auto derivatives = static_cast<double>(scene.output.derivatives.size());
    result.seconds *= 1 + 0.5 * derivatives;
    result.bytes *= 1 + derivatives;
    // the adjoint once more than a run, a fifth of one for each number, two models of each, and all steps until the end
    for (const auto& [name, gradient] : scene.output.gradients) {
        // of a step: its unknowns, and the state at its start, with velocities and accelerations
        const double vectors =
            std::ranges::any_of(plan.stages, [](const auto& one) { return one.dynamics.has_value(); }) ? 7 : 5;
        const auto numbers = static_cast<double>(gradient.by.size());
        result.seconds *= 2 + 0.2 * numbers;
        result.bytes *= 1 + numbers;
        result.bytes +=
            result.steps * (vectors + numbers) * 3 * static_cast<double>(plan.model.nodes()) * sizeof(double);
    }
    return result;
}

} // namespace osculate::app
