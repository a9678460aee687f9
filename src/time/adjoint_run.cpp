#include "osculate/time/adjoint_run.hpp"

#include "time/number.hpp"
#include "time/run_context.hpp"
#include "time/stage_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace osculate::time {

namespace {
/// Of linear systems. Derivatives of forces of supports are small differences of large sums: those of what is held and of what moves.
constexpr double linear_tolerance = 1e-11, linear_tolerance_of_reactions = 1e-12;

/// What steps before one may still add to a derivative, over the derivative by then: less than the error of differences.
constexpr double negligible = 1e-9;
constexpr double cancelled = 1e-3; ///< of what has been added up: the least that counts as the derivative
constexpr double loosest = 1e-3;   ///< of systems whose solutions add little

using Sizes = equilibrium::WeightSizes;

Sizes sizes_of(const equilibrium::Weights& weights) {
    Sizes sizes;
    for (const Vec3& w : weights.nodes) sizes.nodes += w.squaredNorm();
    for (const Vec3& w : weights.couplings) sizes.couplings += w.squaredNorm();
    return {std::sqrt(sizes.nodes), std::sqrt(sizes.couplings)};
}

/// What is known of a derivative while the steps are gone through backwards.
struct Sum {
    double value = 0, sizes = 0; ///< so far; of what was added
};

/// The most that the steps before one may add to a derivative, over the derivative so far. That solutions grow backwards by no more than
/// they have done so far is an assumption.
/// @param w       of the step after them
/// @param before  (numbers) sums of the sizes of changes in those steps
double still_to_come(const Sizes& w, double growth, const std::vector<Sizes>& before, const std::vector<Sum>& sums) {
    double most = 0;
    for (std::size_t p = 0; p < sums.size(); ++p) {
        const double rest = growth * (w.nodes * before[p].nodes + w.couplings * before[p].couplings);
        const double known = std::max(std::abs(sums[p].value), cancelled * sums[p].sizes);
        if (rest > 0) most = std::max(most, known > 0 ? rest / known : std::numeric_limits<double>::infinity());
    }
    return most;
}

/// At least 1: how much larger one is than the other.
double growth_of(const Sizes& later, const Sizes& now) {
    double growth = 1;
    if (later.nodes > 0) growth = std::max(growth, now.nodes / later.nodes);
    if (later.couplings > 0) growth = std::max(growth, now.couplings / later.couplings);
    return growth;
}

bool is_zero(const equilibrium::StateWeights& weights) {
    const auto zero = [](const auto& list) {
        return std::ranges::all_of(list, [](const Vec3& w) { return w.isZero(0); });
    };
    return zero(weights.u) && zero(weights.v) && zero(weights.a) && zero(weights.couplings);
}

/// Components of a field at held directions, in the order of nodes and directions.
Vector held_components(const linear::Constraints& constraints, const Field& values) {
    std::vector<double> list;
    for (Index node = 0; node < constraints.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (constraints.constraint(node, k) != nullptr) list.push_back(constraints.to_local(node, values[node])(k));
    return Eigen::Map<const Vector>(list.data(), static_cast<Index>(list.size()));
}

/// The field without components of free directions.
Field held_part(const linear::Constraints& constraints, const Field& values) {
    Field held(values.size());
    for (Index node = 0; node < constraints.nodes(); ++node) held[node] = constraints.reaction(node, values[node]);
    return held;
}
} // namespace

struct AdjointRun::Number {
    std::unique_ptr<PerturbedRun> below, above;
    double dp = 0;
};

struct AdjointRun::Step {
    /// Derivatives by one number at fixed unknowns.
    struct Change {
        Vector residual; ///< (rows)
        equilibrium::WeightSizes residual_sizes;
        Vector reaction, prescribed; ///< (held directions) N, m
    };
    std::size_t stage = 0;
    model::State start;
    Field u; ///< at its end, m
    Vector z;
    equilibrium::Statuses statuses;
    std::vector<model::HeldFacets> facets; ///< (pairs)
    double time = 0, dt = 0, reference_force = 1;
    bool impact = false;
    std::vector<Change> by; ///< (numbers)
};

/// A stage, with means to solve with its transposed tangent.
struct AdjointRun::StageNow {
    StageNow(RunContext& context, const Stage& stage, const model::State& state)
        : constraints(constraints_of(context.model, stage)), dynamics(stage.dynamics),
          equilibrium(context.model, model::pairs_of(state.contact), constraints, dynamics ? &*dynamics : nullptr,
                      choice(stage), context.timings, context.options.threads) {
        for (model::ContactEvaluation& evaluation : equilibrium.contact()) evaluation.pass_over_far_nodes(true);
    }
    static equilibrium::TangentChoice choice(const Stage& stage) {
        equilibrium::TangentChoice choice = stage.tangent;
        choice.reduced = choice.grows = false;
        choice.preconditioned = choice.products = true;
        return choice;
    }
    linear::Constraints constraints;
    std::optional<equilibrium::Dynamics> dynamics; ///< of the step; none in statics
    equilibrium::Equilibrium equilibrium;
};

AdjointRun::AdjointRun(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings)
    : stages_(std::move(stages)), context_(new RunContext{model, options, timings}), progress_(at_rest(model)) {}

AdjointRun::~AdjointRun() = default;

void AdjointRun::add(std::unique_ptr<PerturbedRun> below, std::unique_ptr<PerturbedRun> above, double dp) {
    numbers_.push_back({std::move(below), std::move(above), dp});
}

void AdjointRun::begin_stage(std::size_t number) {
    if (!lost_.empty()) return;
    const Stage& stage = stages_.at(number);
    time::begin_stage(stage, constraints_of(context_->model, stage), progress_);
    begins_.resize(number + 1);
    begins_[number].stage_start = progress_.stage_start;
    begins_[number].displacement_start = progress_.displacement_start;
    for (const Number& one : numbers_) {
        one.below->begin_stage(number);
        one.above->begin_stage(number);
    }
    progress_.stage = number;
}

void AdjointRun::follow(const BesideStep& step, const LinearSolve&) {
    if (!lost_.empty()) return;
    Step& mine = steps_.emplace_back();
    mine.stage = progress_.stage;
    mine.start = step.start;
    mine.u = step.end.u;
    mine.z = step.z;
    mine.statuses = step.statuses;
    for (const model::ContactEvaluation& evaluation : step.contact) mine.facets.push_back(evaluation.held_facets());
    mine.time = step.time;
    mine.dt = step.dt;
    mine.reference_force = step.reference_force;
    mine.impact = step.impact;
    progress_.state = step.end;
    progress_.state.time = step.time;
    for (const Number& one : numbers_) {
        Step::Change& change = mine.by.emplace_back();
        Vector F;
        double sign = -0.5 / one.dp;
        for (PerturbedRun* side : {one.below.get(), one.above.get()}) {
            if (const std::string why = side->begin_step(step, F); !why.empty()) {
                lost_ = "step to " + number(step.time) + " s: " + why;
                return;
            }
            const equilibrium::Equilibrium& own = side->equilibrium();
            const auto add = [&](const Vector& more, Vector& sum) {
                if (sum.size() == 0) sum.setZero(more.size());
                sum += sign * more;
            };
            add(F, change.residual);
            add(held_components(own.constraints(), own.unbalanced()), change.reaction);
            side->end_step(step, step.z);
            add(held_components(own.constraints(), side->state().u), change.prescribed);
            sign = -sign;
        }
        equilibrium::Weights rows;
        one.above->equilibrium().unpack_rows(change.residual, rows);
        change.residual_sizes = sizes_of(rows);
    }
    first_coupling_.assign(1, 0);
    for (const model::ContactEvaluation& evaluation : step.contact)
        first_coupling_.push_back(first_coupling_.back() + evaluation.pair().size());
}

std::vector<std::vector<double>> AdjointRun::gradients(const std::vector<FinalQuantity>& quantities) {
    std::vector<std::vector<double>> gradients(quantities.size(), std::vector<double>(numbers_.size(), 0.0));
    const auto add = [&](std::size_t q, double factor, const Vector& weights, const Step& step, auto of_change) {
        for (std::size_t p = 0; p < numbers_.size(); ++p)
            gradients[q][p] += factor * weights.dot(step.by[p].*of_change);
    };
    std::optional<StageNow> now;
    std::size_t stage = stages_.size();
    const auto nothing = [&] {
        const auto nodes = static_cast<std::size_t>(context_->model.nodes());
        equilibrium::StateWeights none{Field(nodes), {}, {}, std::vector<Vec3>(first_coupling_.back(), Vec3::Zero())};
        if (now->dynamics) none.v = none.a = none.u;
        return none;
    };
    std::vector<equilibrium::StateWeights> end; // (quantities) of the state at the end of a step
    std::vector<std::vector<Sum>> sums(quantities.size(), std::vector<Sum>(numbers_.size()));
    std::vector<Sizes> solved(quantities.size()); // w of the step after
    double growth = 1;
    std::vector<std::vector<Sizes>> before(steps_.size() + 1,
                                           std::vector<Sizes>(numbers_.size())); // sums over the first steps
    for (std::size_t n = 0; n < steps_.size(); ++n)
        for (std::size_t p = 0; p < numbers_.size(); ++p) {
            const Sizes& own = steps_[n].by[p].residual_sizes;
            before[n + 1][p] = {before[n][p].nodes + own.nodes, before[n][p].couplings + own.couplings};
        }
    for (std::size_t n = steps_.size(); n-- > 0;) {
        const Step& step = steps_[n];
        if (stage != step.stage) now.emplace(*context_, stages_[step.stage], step.start);
        stage = step.stage;
        equilibrium::Equilibrium& equilibrium = now->equilibrium;
        if (!open(step, *now)) return {};
        const bool last = n + 1 == steps_.size();
        equilibrium.linearise_transposed();
        bool done = !now->dynamics; // in motion nothing shrinks, and errors add up
        for (std::size_t q = 0; q < quantities.size(); ++q) {
            const bool reacts = last && !quantities[q].reactions.empty();
            if (last) {
                end.push_back(nothing());
                end[q].u = quantities[q].weights.nodes;
                end[q].couplings = quantities[q].weights.couplings;
                add(q, 1, held_components(now->constraints, end[q].u), step, &Step::Change::prescribed);
            }
            equilibrium::Weights by{end[q].u, end[q].couplings}, of, reactions;
            if (now->dynamics) equilibrium.bodies().add_weights_of_motion(end[q], by.nodes);
            if (reacts) {
                reactions = {held_part(now->constraints, quantities[q].reactions),
                             std::vector<Vec3>(by.couplings.size(), Vec3::Zero())};
                add(q, 1, held_components(now->constraints, reactions.nodes), step, &Step::Change::reaction);
                equilibrium.add_transposed(reactions, by);
            }
            Vector w;
            const double tolerance = quantities[q].reactions.empty() ? linear_tolerance : linear_tolerance_of_reactions;
            double part = 1; // that this step may add
            if (!last && !now->dynamics) part = still_to_come(solved[q], growth, before[n + 1], sums[q]);
            const double here = part > tolerance / loosest ? std::max(tolerance, tolerance / part) : loosest;
            if (!equilibrium.solve_transposed(by, w, of, here)) return {};
            add(q, -1, w, step, &Step::Change::residual);
            const Sizes size = sizes_of(of);
            if (!last) growth = std::max(growth, growth_of(solved[q], size));
            solved[q] = size;
            for (std::size_t p = 0; p < numbers_.size(); ++p) {
                sums[q][p].value = gradients[q][p];
                sums[q][p].sizes += std::abs(w.dot(step.by[p].residual));
            }
            done = done && still_to_come(size, growth, before[n], sums[q]) <= negligible;
            // the next one backwards; what is held there is in the differences
            if (reacts) of.nodes.add(-1, reactions.nodes);
            equilibrium::StateWeights start = nothing();
            for (Vec3& weight : of.nodes.values()) weight = -weight;
            for (Vec3& weight : of.couplings) weight = -weight;
            equilibrium.add_transposed_of_start(of, end[q], start);
            end[q] = std::move(start);
        }
        if (done || std::ranges::all_of(end, is_zero)) break;
        equilibrium.commit();
    }
    return gradients;
}

bool AdjointRun::open(const Step& step, StageNow& now) {
    Progress& at = begins_[step.stage];
    at.state.time = step.start.time;
    const Stage& stage = stages_[step.stage];
    equilibrium::Equilibrium& equilibrium = now.equilibrium;
    if (now.dynamics)
        now.dynamics->integrator = step.impact ? equilibrium::backward_euler() : stage.dynamics->integrator;
    equilibrium.set_reference_force(step.reference_force);
    equilibrium.begin_attempt(
        step.start,
        mean_load(context_->model, stage, now.constraints, now.dynamics ? &*now.dynamics : nullptr, at, step.time),
        step.dt);
    equilibrium.set_statuses(step.statuses, equilibrium::StatusRule::frozen, false);
    for (std::size_t p = 0; p < step.facets.size(); ++p) equilibrium.contact()[p].take_facets(step.facets[p]);
    Vector F(step.z.size());
    return equilibrium.residual(step.z, F) != solve::NonlinearProblem::Verdict::shorten;
}

} // namespace osculate::time
