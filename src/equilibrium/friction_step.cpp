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
    if (bodies_.bodies().symmetric() && done(cholesky_, solve::make_cholesky)) return true;
    // at finite strain the stresses of an iterate may make K indefinite, though it is far from buckling
    return !bodies_.bodies().semidefinite() && done(lu_, solve::make_lu);
}

template <class Each> void FrictionStep::for_carriers(Index node, Each&& each) const {
    each(node, Mat3::Identity(), Mat3::Identity()); // as far as it has equations of its own
    if (dependence_ == nullptr || !dependence_->depends(node)) return;
    for (const linear::Dependence::Carrier& carrier : dependence_->carriers(node))
        each(carrier.node, carrier.moves, carrier.loads);
}

FrictionStep::Couplings FrictionStep::couplings(const std::vector<LinearisedContact>& contacts) const {
    using Entry = Eigen::Triplet<double>;
    std::vector<Entry> moving, loading;
    const auto add_motion = [&](Index row, Index any, const Mat3& weight) {
        for_carriers(any, [&](Index node, const Mat3& moves, const Mat3&) {
            const Mat3 local = weight * moves * constraints_.frame(node);
            for (int k = 0; k < 3; ++k)
                if (const Index e = constraints_.equation(node, k); e != Constraints::held)
                    for (int i = 0; i < 3; ++i) moving.emplace_back(row + i, e, local(i, k));
        });
    };
    const auto add_force = [&](Index column, Index any, const Mat3& force) {
        for_carriers(any, [&](Index node, const Mat3&, const Mat3& loads) {
            const Mat3 local = constraints_.frame(node).transpose() * loads * force;
            for (int k = 0; k < 3; ++k)
                if (const Index e = constraints_.equation(node, k); e != Constraints::held)
                    for (int i = 0; i < 3; ++i) loading.emplace_back(e, column + i, local(k, i));
        });
    };
    for (std::size_t j = 0; j < contacts.size(); ++j) {
        const LinearisedContact& contact = contacts[j];
        const Index first = 3 * static_cast<Index>(j);
        add_motion(first, contact.slave, contact.A.leftCols<3>());
        for (std::size_t i = 0; i < contact.masters.size(); ++i)
            add_motion(first, contact.masters[i], contact.A.middleCols<3>(3 + 3 * static_cast<Index>(i)));
        add_force(first, contact.slave, contact.axes);
        for (Index i = 0; i < contact.F.rows() / 3; ++i)
            add_force(first, contact.masters[static_cast<std::size_t>(i)], contact.F.middleRows<3>(3 * i));
    }
    const auto rows = static_cast<Index>(3 * contacts.size());
    Couplings couplings{{rows, constraints_.equations()}, {constraints_.equations(), rows}};
    couplings.motion.setFromTriplets(moving.begin(), moving.end());
    couplings.load.setFromTriplets(loading.begin(), loading.end());
    return couplings;
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
    const Couplings couplings = this->couplings(contacts);
    Matrix solved;
    for (Index begin = 0; begin < 3 * n; begin += batch) {
        const Index count = std::min(batch, 3 * n - begin);
        solver_->solve(Matrix(couplings.load.middleCols(begin, count)), solved);
        problem.W.middleCols(begin, count).noalias() = couplings.motion * solved;
    }
    const Vector moved = couplings.motion * du;
    Vector drag = Vector::Zero(3 * n);
    for (Index j = 0; j < n; ++j) {
        const LinearisedContact& contact = contacts[static_cast<std::size_t>(j)];
        problem.mu(j) = contact.friction;
        problem.q.segment<3>(3 * j) = contact.w + moved.segment<3>(3 * j);
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

    right += couplings.load * solution.r;
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
