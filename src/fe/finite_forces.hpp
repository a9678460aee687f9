#pragma once
/// Forces and tangents of an element at any strain and rotation from its stresses and moduli, whatever its material.

#include "fe/finite_kinematics.hpp"

namespace osculate::fe {

template <ReferenceElement E, bool mean_dilatation> struct FiniteForces {
    static constexpr int n = E::nodes;
    using Kinematics = FiniteKinematics<E, mean_dilatation>;
    using Forces = Eigen::Matrix<double, 3, n>;
    using Stiffness = Eigen::Matrix<double, 3 * n, 3 * n>;
    using Row = typename Kinematics::Row;
    using Stresses = std::array<Mat3, E::points>; ///< second Piola-Kirchhoff, Pa
    using Moduli = std::array<Mat6, E::points>;   ///< derivatives of these by the strain, Pa

    /// f . du = sum S : dE dV, dE that of k. With mean dilatation (dev tau : grad du + p div-bar du) dV,
    /// tau = Fbar S Fbar^T, p = tr tau / 3.
    [[nodiscard]] static Forces forces(const Kinematics& k, const Stresses& S) {
        Forces sum = Forces::Zero();
        double pressure = 0; // sum of p dV
        for (std::size_t q = 0; q < E::points; ++q) {
            const double dV = k.points.volumes[q];
            if constexpr (mean_dilatation) {
                Mat3 tau = k.scale_squared(q) * k.F(q) * S[q] * k.F(q).transpose();
                const double p = tau.trace() / 3;
                tau.diagonal().array() -= p;
                pressure += p * dV;
                sum.noalias() += (tau * dV) * k.spatial_gradients(q).transpose();
            } else {
                sum.noalias() += (k.F(q) * S[q] * dV) * k.points.gradients[q].transpose();
            }
        }
        if constexpr (mean_dilatation) sum.noalias() += pressure * k.mean_gradients().transpose();
        return sum;
    }

    /// sum dE : D : dE dV, the first dE that of `varied`, the second that of `moved`, on the right.
    [[nodiscard]] static Stiffness material_tangent(const Kinematics& varied, const Kinematics& moved,
                                                    const Moduli& D) {
        Stiffness K = Stiffness::Zero();
        Row mean_varied, mean_moved;
        if constexpr (mean_dilatation) {
            mean_varied = Kinematics::flat(varied.mean_gradients());
            mean_moved = Kinematics::flat(moved.mean_gradients());
        }
        const auto stress_variation = [&](std::size_t q) -> Eigen::Matrix<double, 6, 3 * n> {
            return D[q] * moved.varied_strain(q, mean_moved) * moved.points.volumes[q];
        };
        if constexpr (n <= 8) {
            for (std::size_t q = 0; q < E::points; ++q)
                K.noalias() += varied.varied_strain(q, mean_varied).transpose() * stress_variation(q);
        } else { // many points of many nodes: one product of all of them is several times as quick
            Eigen::Matrix<double, 6 * E::points, 3 * n> B, DB;
            for (std::size_t q = 0; q < E::points; ++q) {
                const auto row = static_cast<Eigen::Index>(6 * q);
                B.template middleRows<6>(row) = varied.varied_strain(q, mean_varied);
                DB.template middleRows<6>(row) = stress_variation(q);
            }
            K.noalias() += B.transpose() * DB;
        }
        return K;
    }

    /// Derivative of forces(k, S) at constant S, symmetric.
    [[nodiscard]] static Stiffness stress_tangent(const Kinematics& k, const Stresses& S) {
        Stiffness K = Stiffness::Zero();
        if constexpr (mean_dilatation)
            add_mean_dilatation(k, S, K);
        else
            for (std::size_t q = 0; q < E::points; ++q)
                add_initial_stress(k.points.gradients[q], S[q] * k.points.volumes[q], K);
        return K;
    }

private:
    /// S : d(dE), the part of the tangent that the stress has: dN_a/dX S dN_b/dX on the diagonal of block (a, b).
    static void add_initial_stress(const Gradients<n>& g, const Mat3& S, Stiffness& K) {
        const Eigen::Matrix<double, n, n> initial = g * S * g.transpose();
        for (int b = 0; b < n; ++b)
            for (int a = 0; a < n; ++a) K.template block<3, 3>(3 * a, 3 * b).diagonal().array() += initial(a, b);
    }

    /// With phi = ln Jbar - ln J, h = dphi, s^2 = exp(2/3 phi), p = s^2 S : C / 3, r = s^2 S : dE:
    ///   S : ddEbar = s^2 S : ddE + 2/3 (h r + r h) + 2/3 p h h + p ddphi,
    ///   dd ln J = -g_b g_a on block (a, b),  dd ln Jbar = sum_q w_q (g g + dd ln J)_q - gbar gbar.
    static void add_mean_dilatation(const Kinematics& k, const Stresses& S, Stiffness& K) {
        const Row mean = Kinematics::flat(k.mean_gradients());
        std::array<double, E::points> pdV;
        double pressure = 0;
        for (std::size_t q = 0; q < E::points; ++q) {
            const double dV = k.points.volumes[q], s2 = k.scale_squared(q);
            const Mat3 F = k.F(q);
            const auto B = strain_variation<n>(F, k.points.gradients[q]);
            const Row h = mean - Kinematics::flat(k.spatial_gradients(q));
            const Row r = s2 * material::stress_vector(S[q]).transpose() * B;
            const double p = s2 * S[q].cwiseProduct(F.transpose() * F).sum() / 3;
            add_initial_stress(k.points.gradients[q], S[q] * (s2 * dV), K);
            const Row cross = 2.0 / 3 * dV * (r + p / 2 * h); // h r + r h + p h h
            K.noalias() += h.transpose() * cross;
            K.noalias() += cross.transpose() * h;
            pdV[q] = p * dV;
            pressure += pdV[q];
        }
        for (std::size_t q = 0; q < E::points; ++q) {
            const Gradients<n> g = k.spatial_gradients(q);
            const Row row = Kinematics::flat(g);
            const double share = pressure * k.weight(q);
            K.noalias() += (share * row.transpose()) * row;
            for (int b = 0; b < n; ++b)
                for (int a = 0; a < n; ++a)
                    K.template block<3, 3>(3 * a, 3 * b).noalias() +=
                        (pdV[q] - share) * g.row(b).transpose() * g.row(a);
        }
        K.noalias() -= (pressure * mean.transpose()) * mean;
    }
};

} // namespace osculate::fe
