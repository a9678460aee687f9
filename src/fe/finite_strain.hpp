#pragma once
/// Total Lagrangian kernels at any strain and rotation, of hyperelastic materials and of those with a memory.

#include "fe/finite_forces.hpp"
#include "fe/kernel_instances.hpp"
#include "fe/solid_kernel.hpp"
#include "osculate/core/error.hpp"
#include "osculate/material/voigt.hpp"

#include <algorithm>
#include <limits>

namespace osculate::fe {

/// W = sum_q psi(E_q) dV_q over reference volumes; force and tangent are its derivatives. With mean dilatation, F-bar,
/// the energy takes F-bar = (Jbar / J)^(1/3) F in place of F, Jbar = sum J dV / sum dV: the volume is felt in the mean
/// only, and the tangent stays symmetric. At small strain it is B-bar.
/// [de Souza Neto, Peric, Dutko, Owen 1996, Int. J. Solids Struct. 33, 3277; the mean in place of the centre after
/// Simo, Taylor, Pister 1985, Comput. Meth. Appl. Mech. Engng 51, 177]
template <ReferenceElement E, class Material, bool mean_dilatation>
class FiniteStrainKernel final : public SolidKernel<E> {
    static constexpr int n = E::nodes;
    using Positions = Eigen::Matrix<double, 3, n>;
    using Kinematics = FiniteKinematics<E, mean_dilatation>;
    using All = FiniteForces<E, mean_dilatation>;
    using Forces = typename All::Forces;
    using Stiffness = typename All::Stiffness;
    using Stresses = typename All::Stresses;
    using Moduli = typename All::Moduli;

public:
    FiniteStrainKernel(const Material& material, bool heated) : SolidKernel<E>(heated), material_(material) {}

    [[nodiscard]] bool linear() const override { return false; }
    [[nodiscard]] bool finite_strain() const override { return true; }
    [[nodiscard]] std::size_t history_size() const override { return E::points * stride(); }

    void stiffness(const Eigen::Ref<const Eigen::Matrix3Xd>& X, Eigen::Ref<Matrix> Ke) const override {
        const Positions rest = Positions::Zero();
        (void)tangent({X, rest, rest}, Ke); // J = 1
    }

    Deformation energy(const ElementState& state, double& W) const override {
        require(state.X.cols() == n && state.u.cols() == n, "energy: sizes do not match the element");
        W = 0;
        const Kinematics k(this->table_, state.X, state.u);
        if (!k.deformation.admissible()) return k.deformation;
        for (std::size_t q = 0; q < E::points; ++q)
            W += law(state.history, q).energy(k.strain(q)) * k.points.volumes[q];
        if (std::isfinite(W)) return k.deformation;
        W = 0;
        return overflow;
    }

    double dissipated(const ElementState& state) const override {
        double sum = 0;
        if constexpr (memory > 0) {
            const ElementPoints<E> points(this->table_, Positions(state.X));
            for (std::size_t q = 0; q < E::points; ++q)
                sum += material_.dissipated(of_point(state.history, q)) * points.volumes[q];
        }
        return sum;
    }

    bool nodal_plastic_strain(const ElementState& state, Eigen::Ref<Vector> values) const override {
        if constexpr (memory > 0) {
            Eigen::Matrix<double, E::points, 1> at;
            for (std::size_t q = 0; q < E::points; ++q)
                at(static_cast<Eigen::Index>(q)) = Material::plastic_strain(of_point(state.history, q));
            values = this->extrapolation_ * at;
        }
        return memory > 0;
    }

    Deformation update(const ElementStep& step, std::span<double> history,
                       Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        require(step.X.cols() == n && step.u.cols() == n && f.cols() == n, "update: sizes do not match the element");
        require(!step.mean || step.u_start.cols() == n, "update: a mean over a step wants its start");
        f.setZero();
        if (stride() > 0) std::ranges::copy(step.history_start, history.begin());
        if constexpr (memory > 0) {
            const Kinematics end(this->table_, step.X, step.u);
            for (std::size_t q = 0; q < E::points && end.deformation.admissible(); ++q)
                law(step.history_start, q).end(end.strain(q), history.subspan((q + 1) * stride() - memory, memory));
        }
        return step.mean ? mean_force({*this, step}, f)
                         : force(Kinematics(this->table_, step.X, step.u), step.history_start, f);
    }

    Deformation tangent(const ElementStep& step, Eigen::Ref<Matrix> Ke) const override {
        require(step.X.cols() == n && step.u.cols() == n && Ke.rows() == 3 * n && Ke.cols() == 3 * n,
                "tangent: sizes do not match the element");
        require(!step.mean || step.u_start.cols() == n, "tangent: a mean over a step wants its start");
        Ke.setZero();
        return step.mean ? mean_tangent({*this, step}, Ke)
                         : end_tangent(Kinematics(this->table_, step.X, step.u), step.history_start, Ke);
    }

    Deformation nodal_stress(const ElementState& state, Eigen::Ref<Matrix> stress) const override {
        require(state.X.cols() == n && state.u.cols() == n && stress.rows() == 6 && stress.cols() == n,
                "nodal_stress: sizes do not match the element");
        stress.setZero();
        const Kinematics k(this->table_, state.X, state.u);
        if (!k.deformation.admissible()) return k.deformation;
        Eigen::Matrix<double, 6, E::points> sigma;
        for (std::size_t q = 0; q < E::points; ++q) {
            // sigma = Fbar S Fbar^T / Jbar
            const Mat3 S = law(state.history, q).pk2(k.strain(q));
            const double J = 1 + (mean_dilatation ? k.mean_j : k.j[q]);
            sigma.col(static_cast<int>(q)) =
                material::stress_vector(k.scale_squared(q) / J * k.F(q) * S * k.F(q).transpose());
        }
        if (!sigma.allFinite()) return overflow;
        stress.noalias() = sigma * this->extrapolation_.transpose();
        return k.deformation;
    }

private:
    /// Numbers that the material remembers at a point.
    static constexpr std::size_t memory = [] {
        if constexpr (requires { Material::memory; }) return Material::memory;
        return std::size_t{0};
    }();
    /// All numbers of a point: the thermal strain, if there is one, then those.
    [[nodiscard]] std::size_t stride() const { return memory + (this->heated_ ? 1 : 0); }
    /// What the material remembers of a point; nothing in the undeformed initial state if `history` is empty.
    std::span<const double> of_point(std::span<const double> history, std::size_t q) const {
        return history.empty() ? history : history.subspan((q + 1) * stride() - memory, memory);
    }

    /// The law of a point that has grown by a factor s without stress: F = s F_m, E = s^2 E_m + (s^2 - 1)/2 1, and energy,
    /// per volume before it grew, of E_m alone.
    template <class Law> struct Grown {
        Law law;
        double square, grown; ///< s^2, (s^2 - 1)/2

        Grown(Law own, double thermal)
            : law(own), square((1 + thermal) * (1 + thermal)), grown(thermal + thermal * thermal / 2) {}

        [[nodiscard]] Mat3 mechanical(const Mat3& E_all) const {
            return grown == 0 ? E_all : Mat3((E_all - grown * Mat3::Identity()) / square);
        }
        [[nodiscard]] double energy(const Mat3& E_all) const { return law.energy(mechanical(E_all)); }
        /// Energy whose derivative is the stress of a step.
        [[nodiscard]] double potential(const Mat3& E_all) const {
            if constexpr (memory > 0)
                return law.potential(mechanical(E_all));
            else
                return law.energy(mechanical(E_all));
        }
        [[nodiscard]] Mat3 pk2(const Mat3& E_all) const { return law.pk2(mechanical(E_all)) / square; }
        [[nodiscard]] Mat6 tangent(const Mat3& E_all) const {
            return law.tangent(mechanical(E_all)) / (square * square);
        }
        void end(const Mat3& E_all, std::span<double> remembered) const { law.end(mechanical(E_all), remembered); }
    };
    /// The law of a point in a step that begins with a history.
    [[nodiscard]] auto law(std::span<const double> history, std::size_t q) const {
        const double thermal = this->thermal_strain(history, q);
        if constexpr (memory > 0)
            return Grown<typename Material::At>(material_.at(of_point(history, q)), thermal);
        else
            return Grown<const Material&>(material_, thermal);
    }

    static constexpr Deformation overflow{-std::numeric_limits<double>::infinity()};

    [[nodiscard]] Stresses stresses(const Kinematics& k, std::span<const double> history) const {
        Stresses S;
        for (std::size_t q = 0; q < E::points; ++q) S[q] = law(history, q).pk2(k.strain(q));
        return S;
    }
    [[nodiscard]] Moduli moduli(const Kinematics& k, std::span<const double> history) const {
        Moduli D;
        for (std::size_t q = 0; q < E::points; ++q) D[q] = law(history, q).tangent(k.strain(q));
        return D;
    }

    /// Forces over a step from u0 to u1: strains at both ends, their mean stress, and the configuration it acts in,
    /// u = w u1 + (1 - w) u0. S does the work of the energy's difference,
    ///     S = (S0 + S1)/2 + g DE + (w - 1/2)(S1 - S0) + viscosity D0 : DE,  g = (DW - (S0 + S1)/2 : DE)/|DE|^2,
    /// where w = 1/2 without viscosity: S : DE = DW. [Gonzalez 2000, Comput. Meth. Appl. Mech. Engng 190, 1763]
    struct Step {
        /// Below this strain increment g, of the order of |DE|^2 in the stress, would be a quotient of round-off.
        static constexpr double least_increment = 1e-5;

        std::span<const double> history; ///< at the start
        Kinematics start, end, mean;
        StepMean weights;
        Stresses S, S_difference, DE;
        std::array<double, E::points> g;

        Step(const FiniteStrainKernel& kernel, const ElementStep& step)
            : Step(kernel, step.X, step.u_start, step.u, *step.mean, step.history_start) {}
        Step(const FiniteStrainKernel& kernel, const Positions& X, const Positions& u0, const Positions& u1,
             const StepMean& w, std::span<const double> before)
            : history(before), start(kernel.table_, X, u0), end(kernel.table_, X, u1),
              mean(kernel.table_, X, w.end_weight * u1 + (1 - w.end_weight) * u0), weights(w) {
            if (!deformation().admissible()) return;
            for (std::size_t q = 0; q < E::points; ++q) {
                const auto law = kernel.law(history, q);
                const Mat3 E0 = start.strain(q), E1 = end.strain(q), S0 = law.pk2(E0), S1 = law.pk2(E1),
                           half = (S0 + S1) / 2;
                DE[q] = E1 - E0;
                S_difference[q] = S1 - S0;
                const double square = DE[q].squaredNorm();
                g[q] = 0;
                if (square > least_increment * least_increment)
                    g[q] = (law.potential(E1) - law.potential(E0) - half.cwiseProduct(DE[q]).sum()) / square;
                S[q] = half + g[q] * DE[q] + (w.end_weight - 0.5) * S_difference[q];
                if (w.viscosity > 0)
                    S[q] += w.viscosity * material::stress_matrix(law.tangent(E0) * material::strain_vector(DE[q]));
            }
        }
        /// The worst of the end and of what the mean needs.
        [[nodiscard]] const Deformation& deformation() const {
            const bool mean_counts = mean_dilatation && mean.deformation.smallest_J < end.deformation.smallest_J;
            return mean_counts ? mean.deformation : end.deformation;
        }
        /// dS/dE1
        [[nodiscard]] Moduli moduli(const FiniteStrainKernel& kernel) const {
            Moduli D;
            for (std::size_t q = 0; q < E::points; ++q) {
                const auto law = kernel.law(history, q);
                const Mat6 D1 = law.tangent(end.strain(q));
                D[q] = weights.end_weight * D1;
                if (weights.viscosity > 0) D[q] += weights.viscosity * law.tangent(start.strain(q));
                if (g[q] == 0) continue;
                // g 1 + DE dg, dg = ((S1 - S0)/2 - D1 : DE/2 - 2 g DE)/|DE|^2; 1 on symmetric tensors, Voigt
                D[q].diagonal() += g[q] * Vec6(1, 1, 1, 0.5, 0.5, 0.5);
                const Vec6 de = material::stress_vector(DE[q]);
                const Vec6 dg = (material::stress_vector(S_difference[q]) / 2 -
                                 D1 * material::strain_vector(DE[q]) / 2 - 2 * g[q] * de) /
                                DE[q].squaredNorm();
                D[q] += de * dg.transpose();
            }
            return D;
        }
    };

    [[nodiscard]] Deformation force(const Kinematics& k, std::span<const double> history,
                                    Eigen::Ref<Eigen::Matrix3Xd> f) const {
        if (!k.deformation.admissible()) return k.deformation;
        const Forces sum = All::forces(k, stresses(k, history));
        if (!sum.allFinite()) return overflow;
        f = sum;
        return k.deformation;
    }

    [[nodiscard]] Deformation end_tangent(const Kinematics& k, std::span<const double> history,
                                          Eigen::Ref<Matrix> Ke) const {
        if (!k.deformation.admissible()) return k.deformation;
        const Stiffness K =
            All::stress_tangent(k, stresses(k, history)) + All::material_tangent(k, k, moduli(k, history));
        if (!K.allFinite()) return overflow;
        Ke = (K + K.transpose()) / 2;
        return k.deformation;
    }

    [[nodiscard]] Deformation mean_force(const Step& step, Eigen::Ref<Eigen::Matrix3Xd> f) const {
        if (!step.deformation().admissible()) return step.deformation();
        const Forces sum = All::forces(step.mean, step.S);
        if (!sum.allFinite()) return overflow;
        f = sum;
        return step.deformation();
    }

    [[nodiscard]] Deformation mean_tangent(const Step& step, Eigen::Ref<Matrix> Ke) const {
        if (!step.deformation().admissible()) return step.deformation();
        const Stiffness K = step.weights.end_weight * All::stress_tangent(step.mean, step.S) +
                            All::material_tangent(step.mean, step.end, step.moduli(*this));
        if (!K.allFinite()) return overflow;
        Ke = K;
        return step.deformation();
    }

    Material material_;
};

template <class E, class Material, bool mean_dilatation>
std::unique_ptr<ElementKernel> make_finite_strain_kernel(const Material& material, bool heated) {
    return std::make_unique<FiniteStrainKernel<E, Material, mean_dilatation>>(material, heated);
}

} // namespace osculate::fe
