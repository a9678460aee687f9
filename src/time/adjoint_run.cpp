#include "osculate/time/adjoint_run.hpp"

#include "time/number.hpp"
#include "time/run_context.hpp"
#include "time/stage_state.hpp"

#include <optional>

namespace osculate::time {

namespace {
/// Of linear systems. Derivatives of forces of supports are small differences of large sums: those of what is held and of what moves.
constexpr double linear_tolerance = 1e-9, linear_tolerance_of_reactions = 1e-12;

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
        Vector residual;             ///< (rows)
        Vector reaction, prescribed; ///< (held directions) N, m
    };
    std::size_t stage = 0;
    model::State start;
    Field u; ///< at its end, m
    Vector z;
    equilibrium::Statuses statuses;
    std::vector<model::HeldFacets> facets; ///< (pairs)
    double time = 0, dt = 0, reference_force = 1;
    std::vector<Change> by; ///< (numbers)
};

/// A stage, with means to solve with its transposed tangent.
struct AdjointRun::StageNow {
    StageNow(RunContext& context, const Stage& stage, const model::State& state)
        : constraints(constraints_of(context.model, stage)),
          equilibrium(context.model, model::pairs_of(state.contact), constraints, nullptr, choice(stage),
                      context.timings, context.options.threads) {
        for (model::ContactEvaluation& evaluation : equilibrium.contact()) evaluation.pass_over_far_nodes(true);
    }
    static equilibrium::TangentChoice choice(const Stage& stage) {
        equilibrium::TangentChoice choice = stage.tangent;
        choice.condensed = choice.reduced = choice.grows = false;
        choice.preconditioned = choice.products = true;
        return choice;
    }
    linear::Constraints constraints;
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
    }
    first_coupling_.assign(1, 0);
    for (const model::ContactEvaluation& evaluation : step.contact)
        first_coupling_.push_back(first_coupling_.back() + evaluation.pair().size());
}

std::vector<std::vector<double>> AdjointRun::gradients(const std::vector<FinalQuantity>& quantities) {
    std::vector<std::vector<double>> gradients(quantities.size(), std::vector<double>(numbers_.size(), 0.0));
    std::vector<equilibrium::Weights> by;
    for (const FinalQuantity& quantity : quantities) by.push_back(quantity.weights);
    const auto add = [&](std::size_t q, double factor, const Vector& weights, const Step& step, auto of_change) {
        for (std::size_t p = 0; p < numbers_.size(); ++p)
            gradients[q][p] += factor * weights.dot(step.by[p].*of_change);
    };
    std::optional<StageNow> now;
    std::size_t stage = stages_.size();
    for (std::size_t n = steps_.size(); n-- > 0;) {
        const Step& step = steps_[n];
        if (stage != step.stage) now.emplace(*context_, stages_[step.stage], step.start);
        stage = step.stage;
        equilibrium::Equilibrium& equilibrium = now->equilibrium;
        if (!open(step, equilibrium, now->constraints)) return {};
        if (n + 1 == steps_.size())
            for (std::size_t q = 0; q < quantities.size(); ++q) {
                add(q, 1, held_components(now->constraints, by[q].nodes), step, &Step::Change::prescribed);
                if (quantities[q].reactions.empty()) continue;
                const equilibrium::Weights reactions{held_part(now->constraints, quantities[q].reactions),
                                                     std::vector<Vec3>(by[q].couplings.size(), Vec3::Zero())};
                add(q, 1, held_components(now->constraints, reactions.nodes), step, &Step::Change::reaction);
                equilibrium.add_transposed(reactions, by[q]);
            }
        equilibrium.linearise_transposed();
        for (std::size_t q = 0; q < quantities.size(); ++q) {
            Vector w;
            equilibrium::Weights of;
            const double tolerance = quantities[q].reactions.empty() ? linear_tolerance : linear_tolerance_of_reactions;
            if (!equilibrium.solve_transposed(by[q], w, of, tolerance)) return {};
            add(q, -1, w, step, &Step::Change::residual);
            // the next one backwards; what is held there is in the differences
            equilibrium::Weights start{Field(by[q].nodes.size()),
                                       std::vector<Vec3>(by[q].couplings.size(), Vec3::Zero())};
            equilibrium.add_transposed_of_start(of, start);
            for (Vec3& weight : start.nodes.values()) weight = -weight;
            for (Vec3& weight : start.couplings) weight = -weight;
            by[q] = std::move(start);
        }
        equilibrium.commit();
    }
    return gradients;
}

bool AdjointRun::open(const Step& step, equilibrium::Equilibrium& equilibrium, const linear::Constraints& constraints) {
    Progress& at = begins_[step.stage];
    at.state.time = step.start.time;
    equilibrium.set_reference_force(step.reference_force);
    equilibrium.begin_attempt(
        step.start, mean_load(context_->model, stages_[step.stage], constraints, nullptr, at, step.time), step.dt);
    equilibrium.set_statuses(step.statuses, equilibrium::StatusRule::frozen, false);
    for (std::size_t p = 0; p < step.facets.size(); ++p) equilibrium.contact()[p].take_facets(step.facets[p]);
    Vector F(step.z.size());
    return equilibrium.residual(step.z, F) != solve::NonlinearProblem::Verdict::shorten;
}

} // namespace osculate::time
