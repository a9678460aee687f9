#include "time/initial_acceleration.hpp"

#include "osculate/core/error.hpp"
#include "osculate/equilibrium/coupling_start.hpp"
#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/linear/folded_matrix.hpp"
#include "osculate/linear/mass_iteration.hpp"
#include "osculate/linear/penalty_stiffness.hpp"

#include <algorithm>
#include <optional>

namespace osculate::time {
namespace {

/// (equations) M^-1 f with factors; nodes without mass have no acceleration of their own
std::optional<Vector> factorised_by_mass(const linear::BlockMatrix& M, const linear::Constraints& constraints,
                                         Vector right) {
    linear::PenaltyStiffness free_mass(constraints, M);
    free_mass.set_springs({});
    const auto solver = solve::make_cholesky();
    solve::SparseMatrix matrix = free_mass.matrix();
    const double heaviest = matrix.value.empty() ? 0 : *std::ranges::max_element(matrix.value);
    for (solve::SparseIndex i = 0; i < matrix.rows(); ++i)
        for (solve::SparseIndex k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k)
            if (matrix.column[k] == i && matrix.value[k] == 0) {
                matrix.value[k] = heaviest > 0 ? heaviest : 1;
                right(static_cast<Index>(i)) = 0;
            }
    if (solver->factorise(matrix) != solve::FactorStatus::ok) return std::nullopt;
    Vector a(right.size());
    solver->solve(right.data(), a.data());
    return a;
}

} // namespace

Field initial_acceleration(RunContext& context, const Stage& stage, const linear::Constraints& constraints,
                           const model::State& state, const Field& force, MassSolution how) {
    const model::Model& model = context.model;
    const equilibrium::Dynamics& dynamics = *stage.dynamics;
    const linear::BlockMatrix& all_mass = model.mass(dynamics.lumped_mass);
    const auto n = static_cast<std::size_t>(model.nodes());
    const Field own = equilibrium::body_forces(model, dynamics, state, context.options.threads);
    const Field x = sum(model.X, state.u);
    Field f = force;
    f.add(-1, own);
    for (std::size_t p = 0; p < state.contact.size(); ++p) {
        model::ContactEvaluation evaluation(*state.contact[p].pair);
        evaluation.begin_step(x, state.contact[p], context.timings, context.options.threads);
        evaluation.evaluate(x, context.timings, context.options.threads);
        for (Index j = 0; j < evaluation.pair().size(); ++j)
            evaluation.for_each_force(j, state.contact[p].lambda[j],
                                      [&](Index node, const Vec3& own_force) { f[node] += own_force; });
    }
    const linear::Dependence coupled = equilibrium::coupled_nodes(model, state);
    const Field turning = equilibrium::centripetal(model, state);
    std::optional<linear::FoldedMatrix> folded;
    if (!coupled.empty()) {
        Field for_turning(n);
        all_mass.multiply_add(turning, for_turning, context.options.threads);
        f.add(-1, for_turning);
        coupled.fold(f);
        folded.emplace(coupled, all_mass);
        folded->fold(all_mass);
    }
    const linear::BlockMatrix& M = folded ? folded->matrix() : all_mass;
    Vector right(constraints.equations());
    constraints.gather(f, right);
    const std::optional<Vector> a = how == MassSolution::by_factors
                                        ? factorised_by_mass(M, constraints, right)
                                        : linear::iterate_by_mass(M, constraints, right, context.options.threads);
    if (!a) throw RunFailure("stage '" + stage.name + "': the mass matrix is not positive definite");
    Field result(n);
    constraints.scatter(*a, Field(n), result);
    if (!coupled.empty()) {
        coupled.move(result);
        result.add(1, turning);
    }
    return result;
}

} // namespace osculate::time
