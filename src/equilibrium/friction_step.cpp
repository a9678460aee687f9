#include "osculate/equilibrium/friction_step.hpp"

#include "osculate/linear/gathered.hpp"
#include "osculate/solve/by_components.hpp"
#include "osculate/solve/direct_on_first.hpp"
#include "osculate/solve/friction_problem.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

namespace osculate::equilibrium {

using linear::Constraints;

namespace {
constexpr double reach = 0.1;       ///< of a facet: nodes that far from the master may close
constexpr Index most_points = 1000; ///< their dense matrix takes 72 MB
constexpr Index batch = 64;         ///< right sides solved at a time
constexpr double tolerance = 1e-10; ///< of solve::friction_error()
} // namespace

FrictionStep::FrictionStep(const linear::Constraints& constraints, const linear::Unknowns& unknowns, BodyTerm& bodies,
                           ContactTerm& contact, const linear::Dependence* dependence)
    : constraints_(constraints), unknowns_(unknowns), bodies_(bodies), contact_(contact), dependence_(dependence),
      folded_(dependence != nullptr && linear::needs_folding(*dependence, bodies.bodies().tangent())
                  ? std::make_unique<linear::FoldedMatrix>(*dependence, bodies.bodies().tangent())
                  : nullptr),
      stiffness_(constraints, bodies.bodies().tangent()) {}

bool FrictionStep::factorise(const Iterate& at) {
    (void)bodies_.update_stiffness(at);
    if (folded_) folded_->fold(bodies_.bodies().tangent());
    const linear::BlockMatrix& tangent = folded_ ? folded_->matrix() : bodies_.bodies().tangent();
    std::optional<linear::BlockMatrix> whole; // each process solves by itself, and all get the same bits
    if (tangent.share() != nullptr) {
        if (tangent.rows() > solve::most_nodes_on_first) return false;
        whole = linear::gathered(tangent);
    }
    stiffness_.use(whole ? *whole : tangent);
    stiffness_.set_springs({}); // what reads it last
    const auto done = [&](std::unique_ptr<solve::DirectSolver>& solver, auto&& make) {
        if (!solver) solver = solve::make_by_components(make);
        solver_ = solver.get();
        ++factorisations_;
        return solver_->factorise(stiffness_.matrix()) == solve::FactorStatus::ok;
    };
    // at finite strain the stresses of an iterate may make K indefinite, though it is far from buckling
    return (bodies_.bodies().symmetric() && done(cholesky_, solve::make_cholesky)) || done(lu_, solve::make_lu);
}

void FrictionStep::add_force(Index any, const Vec3& all, VectorRef right) const {
    const auto add = [&](Index node, const Vec3& force) {
        const Vec3 local = constraints_.to_local(node, force);
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) right(e) += local(k);
    };
    add(any, all); // as far as it has equations of its own
    if (dependence_ == nullptr || !dependence_->depends(any)) return;
    for (const linear::Dependence::Carrier& carrier : dependence_->carriers(any))
        add(carrier.node, carrier.loads * all);
}

Vec3 FrictionStep::motion(Index any, const ConstVectorRef& du) const {
    const auto own = [&](Index node) {
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) local(k) = du(e);
        return constraints_.to_global(node, local);
    };
    Vec3 moved = own(any);
    if (dependence_ == nullptr || !dependence_->depends(any)) return moved;
    for (const linear::Dependence::Carrier& carrier : dependence_->carriers(any))
        moved += carrier.moves * own(carrier.node);
    return moved;
}

void FrictionStep::add_forces(const LinearisedContact& contact, const Vec3& r, VectorRef right) const {
    add_force(contact.slave, contact.axes * r, right);
    for (Index i = 0; i < contact.F.rows() / 3; ++i)
        add_force(contact.masters[static_cast<std::size_t>(i)], contact.F.middleRows<3>(3 * i) * r, right);
}

Vec3 FrictionStep::relative(const LinearisedContact& contact, const ConstVectorRef& du) const {
    Vec3 w = contact.A.leftCols<3>() * motion(contact.slave, du);
    for (std::size_t i = 0; i < contact.masters.size(); ++i)
        w += contact.A.middleCols<3>(3 + 3 * static_cast<Index>(i)) * motion(contact.masters[i], du);
    return w;
}

bool FrictionStep::advance(const Iterate& at, const Field& unbalanced, Vector& z) {
    const std::vector<LinearisedContact> contacts = contact_.linearise_near(reach);
    const auto n = static_cast<Index>(contacts.size());
    if (n > most_points || !factorise(at)) return false;
    const Index equations = constraints_.equations();

    Field free = unbalanced, carried(unbalanced.size()); // f(u) - f_ext
    contact_.add_forces(carried);
    if (dependence_ != nullptr) dependence_->fold(carried);
    free.add(-1, carried);
    Vector right(equations), du(equations);
    constraints_.gather(free, right);
    right = -right;
    solver_->solve(right.data(), du.data());

    solve::FrictionProblem problem{Matrix(3 * n, 3 * n), Vector(3 * n), Vector(n)};
    Matrix columns, solved;
    for (Index begin = 0; begin < 3 * n; begin += batch) {
        const Index count = std::min(batch, 3 * n - begin);
        columns.setZero(equations, count);
        for (Index c = 0; c < count; ++c)
            add_forces(contacts[static_cast<std::size_t>((begin + c) / 3)], Vec3::Unit((begin + c) % 3),
                       columns.col(c));
        solver_->solve(columns, solved);
        for (Index j = 0; j < n; ++j)
            for (Index c = 0; c < count; ++c)
                problem.W.block<3, 1>(3 * j, begin + c) =
                    relative(contacts[static_cast<std::size_t>(j)], solved.col(c));
    }
    Vector drag = Vector::Zero(3 * n);
    for (Index j = 0; j < n; ++j) {
        const LinearisedContact& contact = contacts[static_cast<std::size_t>(j)];
        problem.mu(j) = contact.friction;
        problem.q.segment<3>(3 * j) = contact.w + relative(contact, du);
        drag.segment<2>(3 * j + 1).setConstant(contact.drag);
    }
    // u = W r + q with r = r_c - drag u:  u = (I + W drag)^-1 (W r_c + q)
    const bool resists = (drag.array() > 0).any();
    if (resists) {
        const Eigen::PartialPivLU<Matrix> factors(Matrix::Identity(3 * n, 3 * n) + problem.W * drag.asDiagonal());
        problem.W = factors.solve(problem.W).eval();
        problem.q = factors.solve(problem.q).eval();
    }
    const solve::FrictionProblem motion{resists ? problem.W : Matrix(), resists ? problem.q : Vector(), Vector()};
    for (Index j = 0; j < n; ++j) {
        const LinearisedContact& contact = contacts[static_cast<std::size_t>(j)];
        problem.W(3 * j, 3 * j) += contact.normal_compliance;
        for (int k = 1; k < 3; ++k) {
            problem.W(3 * j + k, 3 * j + k) += contact.compliance;
            problem.q(3 * j + k) -= contact.compliance * contact.anchor(k);
        }
    }
    if (!problem.W.allFinite() || !problem.q.allFinite()) return false;
    solve::FrictionSolution solution = solve::solve_friction(problem, tolerance);
    if (!solution.converged) return false;
    if (resists) solution.r -= drag.cwiseProduct(motion.W * solution.r + motion.q);

    for (Index j = 0; j < n; ++j)
        add_forces(contacts[static_cast<std::size_t>(j)], solution.r.segment<3>(3 * j), right);
    solver_->solve(right.data(), du.data());
    z.head(equations) += du;
    z.tail(z.size() - equations).setZero();
    for (Index j = 0; j < n; ++j) {
        const LinearisedContact& contact = contacts[static_cast<std::size_t>(j)];
        z.segment<3>(unknowns_.multiplier(contact.coupling)) =
            constraints_.to_local(contact.slave, Vec3(contact.axes * solution.r.segment<3>(3 * j)));
    }
    return true;
}

} // namespace osculate::equilibrium
