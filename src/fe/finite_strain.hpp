#pragma once
/// Total Lagrangian kernels of hyperelastic elements at any strain and rotation.

#include "fe/solid_kernel.hpp"
#include "osculate/material/voigt.hpp"

#include <cmath>
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
    using Forces = Eigen::Matrix<double, 3, n>;
    using Stiffness = Eigen::Matrix<double, 3 * n, 3 * n>;
    using Row = Eigen::Matrix<double, 1, 3 * n>;
    using ConstPositions = Eigen::Ref<const Eigen::Matrix3Xd>;

public:
    explicit FiniteStrainKernel(const Material& material) : material_(material) {}

    [[nodiscard]] bool linear() const override { return false; }

    void stiffness(const ConstPositions& X, Eigen::Ref<Matrix> Ke) const override {
        const Positions rest = Positions::Zero();
        (void)tangent(X, rest, Ke); // J = 1
    }

    Deformation energy(const ConstPositions& X, const ConstPositions& u, double& W) const override {
        require(X.cols() == n && u.cols() == n, "energy: sizes do not match the element");
        W = 0;
        const Kinematics k(this->table_, X, u);
        if (!k.deformation.admissible()) return k.deformation;
        for (std::size_t q = 0; q < E::points; ++q) W += material_.energy(k.strain(q)) * k.points.volumes[q];
        if (std::isfinite(W)) return k.deformation;
        W = 0;
        return overflow;
    }

    Deformation internal_force(const ConstPositions& X, const ConstPositions& u,
                               Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        require(X.cols() == n && u.cols() == n && f.cols() == n, "internal_force: sizes do not match the element");
        f.setZero();
        const Kinematics k(this->table_, X, u);
        if (!k.deformation.admissible()) return k.deformation;
        Forces sum = Forces::Zero();
        double pressure = 0; // sum of p dV
        for (std::size_t q = 0; q < E::points; ++q) {
            const double dV = k.points.volumes[q];
            const Mat3 S = material_.pk2(k.strain(q));
            if constexpr (mean_dilatation) {
                // dW = (dev tau : grad du + p div-bar du) dV, tau = Fbar S Fbar^T, p = tr tau / 3
                Mat3 tau = k.scale_squared(q) * k.F(q) * S * k.F(q).transpose();
                const double p = tau.trace() / 3;
                tau.diagonal().array() -= p;
                pressure += p * dV;
                sum.noalias() += (tau * dV) * k.spatial_gradients(q).transpose();
            } else {
                sum.noalias() += (k.F(q) * S * dV) * k.points.gradients[q].transpose();
            }
        }
        if constexpr (mean_dilatation) sum.noalias() += pressure * k.mean_gradients().transpose();
        if (!sum.allFinite()) return overflow;
        f = sum;
        return k.deformation;
    }

    Deformation tangent(const ConstPositions& X, const ConstPositions& u, Eigen::Ref<Matrix> Ke) const override {
        require(X.cols() == n && u.cols() == n && Ke.rows() == 3 * n && Ke.cols() == 3 * n,
                "tangent: sizes do not match the element");
        Ke.setZero();
        const Kinematics k(this->table_, X, u);
        if (!k.deformation.admissible()) return k.deformation;
        Stiffness K = Stiffness::Zero();
        if constexpr (mean_dilatation) {
            add_mean_dilatation_tangent(k, K);
        } else {
            for (std::size_t q = 0; q < E::points; ++q) {
                const double dV = k.points.volumes[q];
                const Mat3 strain = k.strain(q);
                const auto B = strain_variation(k.F(q), k.points.gradients[q]);
                const Eigen::Matrix<double, 6, 3 * n> DB = material_.tangent(strain) * B * dV;
                K.noalias() += B.transpose() * DB;
                add_initial_stress(k.points.gradients[q], material_.pk2(strain) * dV, K);
            }
        }
        if (!K.allFinite()) return overflow;
        Ke = (K + K.transpose()) / 2;
        return k.deformation;
    }

    Deformation material_tangent(const ConstPositions& X, const ConstPositions& u,
                                 Eigen::Ref<Matrix> Ke) const override {
        require(X.cols() == n && u.cols() == n && Ke.rows() == 3 * n && Ke.cols() == 3 * n,
                "material_tangent: sizes do not match the element");
        Ke.setZero();
        const Kinematics k(this->table_, X, u);
        if (!k.deformation.admissible()) return k.deformation;
        Stiffness K = Stiffness::Zero();
        const Row mean = flat(k.mean_gradients());
        for (std::size_t q = 0; q < E::points; ++q) {
            const auto B = varied_strain(k, q, mean);
            const Eigen::Matrix<double, 6, 3 * n> DB = material_.tangent(k.strain(q)) * B * k.points.volumes[q];
            K.noalias() += B.transpose() * DB;
        }
        if (!K.allFinite()) return overflow;
        Ke = (K + K.transpose()) / 2;
        return k.deformation;
    }

    Deformation nodal_stress(const ConstPositions& X, const ConstPositions& u,
                             Eigen::Ref<Matrix> stress) const override {
        require(X.cols() == n && u.cols() == n && stress.rows() == 6 && stress.cols() == n,
                "nodal_stress: sizes do not match the element");
        stress.setZero();
        const Kinematics k(this->table_, X, u);
        if (!k.deformation.admissible()) return k.deformation;
        Eigen::Matrix<double, 6, E::points> sigma;
        for (std::size_t q = 0; q < E::points; ++q) {
            // sigma = Fbar S Fbar^T / Jbar
            const Mat3 S = material_.pk2(k.strain(q));
            const double J = 1 + (mean_dilatation ? k.mean_j : k.j[q]);
            sigma.col(static_cast<int>(q)) =
                material::stress_vector(k.scale_squared(q) / J * k.F(q) * S * k.F(q).transpose());
        }
        if (!sigma.allFinite()) return overflow;
        stress.noalias() = sigma * this->extrapolation_.transpose();
        return k.deformation;
    }

private:
    static constexpr Deformation overflow{-std::numeric_limits<double>::infinity()};
    /// Below this, C = 1 + 2 E, whose least eigenvalue can be J^2, has too few digits left: it counts as no volume.
    static constexpr double least_J = 1e-6;

    /// Deformation at the quadrature points, written in H = F - 1 and j = J - 1, so that small strains keep their digits.
    struct Kinematics {
        ElementPoints<E> points;
        std::array<Mat3, E::points> H;
        std::array<double, E::points> j;
        double mean_j = 0;       ///< Jbar - 1
        double volume = 0;       ///< current, sum of J dV, m^3
        Deformation deformation; ///< smallest J

        Kinematics(const ShapeTable<E>& table, const Positions& X, const Positions& u) : points(table, X) {
            double smallest = std::numeric_limits<double>::infinity(), reference = 0;
            for (std::size_t q = 0; q < E::points; ++q) {
                H[q].noalias() = u * points.gradients[q];
                const Mat3& h = H[q];
                const double trace = h.trace();
                // det(1 + H) - 1 = tr H + II_H + det H
                j[q] = trace + (trace * trace - h.cwiseProduct(h.transpose()).sum()) / 2 + h.determinant();
                smallest =
                    std::isfinite(j[q]) ? std::min(smallest, 1 + j[q]) : -std::numeric_limits<double>::infinity();
                mean_j += j[q] * points.volumes[q];
                volume += (1 + j[q]) * points.volumes[q];
                reference += points.volumes[q];
                if (!std::isfinite(j[q])) break;
            }
            mean_j /= reference;
            deformation.smallest_J = smallest < least_J ? std::min(smallest, 0.0) : smallest;
        }

        [[nodiscard]] Mat3 F(std::size_t q) const { return H[q] + Mat3::Identity(); }
        /// (Jbar / J)^(2/3) - 1
        [[nodiscard]] double scale_squared_less_one(std::size_t q) const {
            return mean_dilatation ? std::expm1(2.0 / 3 * (std::log1p(mean_j) - std::log1p(j[q]))) : 0;
        }
        [[nodiscard]] double scale_squared(std::size_t q) const { return 1 + scale_squared_less_one(q); }
        /// Green-Lagrange strain E = (H + H^T + H^T H) / 2, or that of F-bar, s^2 E + (s^2 - 1) / 2 1.
        [[nodiscard]] Mat3 strain(std::size_t q) const {
            Mat3 strain = (H[q] + H[q].transpose() + H[q].transpose() * H[q]) / 2;
            if constexpr (mean_dilatation) {
                const double s = scale_squared_less_one(q);
                strain *= 1 + s;
                strain.diagonal().array() += s / 2;
            }
            return strain;
        }
        /// g_a = F^-T dN_a/dX, so that d ln J = sum_a g_a . du_a
        [[nodiscard]] Gradients<n> spatial_gradients(std::size_t q) const {
            return points.gradients[q] * F(q).inverse();
        }
        /// Share of a point in the current volume.
        [[nodiscard]] double weight(std::size_t q) const { return (1 + j[q]) * points.volumes[q] / volume; }
        /// d ln Jbar = sum_a gbar_a . du_a, gbar the mean of g over the current volume
        [[nodiscard]] Gradients<n> mean_gradients() const {
            Gradients<n> mean = Gradients<n>::Zero();
            for (std::size_t q = 0; q < E::points; ++q) mean += weight(q) * spatial_gradients(q);
            return mean;
        }
    };

    /// dE = B du, engineering shear strains: dE = sym(F^T dF).
    static Eigen::Matrix<double, 6, 3 * n> strain_variation(const Mat3& F, const Gradients<n>& g) {
        Eigen::Matrix<double, 6, 3 * n> B;
        for (int a = 0; a < n; ++a) {
            const double x = g(a, 0), y = g(a, 1), z = g(a, 2);
            auto block = B.template middleCols<3>(3 * a);
            block.row(0) = F.col(0).transpose() * x;
            block.row(1) = F.col(1).transpose() * y;
            block.row(2) = F.col(2).transpose() * z;
            block.row(3) = F.col(0).transpose() * y + F.col(1).transpose() * x;
            block.row(4) = F.col(1).transpose() * z + F.col(2).transpose() * y;
            block.row(5) = F.col(2).transpose() * x + F.col(0).transpose() * z;
        }
        return B;
    }

    static Row flat(const Gradients<n>& g) { return g.transpose().reshaped().transpose(); }

    /// Variation of k.strain(q): dE, or dEbar = s^2 (dE + h C / 3), see add_mean_dilatation_tangent().
    static Eigen::Matrix<double, 6, 3 * n> varied_strain(const Kinematics& k, std::size_t q, const Row& mean) {
        const Mat3 F = k.F(q);
        Eigen::Matrix<double, 6, 3 * n> B = strain_variation(F, k.points.gradients[q]);
        if constexpr (mean_dilatation) {
            const Row h = mean - flat(k.spatial_gradients(q));
            B += material::strain_vector(F.transpose() * F) / 3 * h;
            B *= k.scale_squared(q);
        }
        return B;
    }

    /// S : d(dE), the part of the tangent that the stress has: dN_a/dX S dN_b/dX on the diagonal of block (a, b).
    static void add_initial_stress(const Gradients<n>& g, const Mat3& S, Stiffness& K) {
        const Eigen::Matrix<double, n, n> initial = g * S * g.transpose();
        for (int b = 0; b < n; ++b)
            for (int a = 0; a < n; ++a) K.template block<3, 3>(3 * a, 3 * b).diagonal().array() += initial(a, b);
    }

    /// With phi = ln Jbar - ln J, h = dphi, s^2 = exp(2/3 phi) and Ebar the strain of F-bar, p = S : (1 + 2 Ebar) / 3:
    ///   dEbar = s^2 (dE + h C / 3),
    ///   S : ddEbar = s^2 S : ddE + 2/3 (h r + r h) + 2/3 p h h + p ddphi,  r = s^2 S : dE,
    ///   dd ln J = -g_b g_a on block (a, b),  dd ln Jbar = sum_q w_q (g g + dd ln J)_q - gbar gbar.
    void add_mean_dilatation_tangent(const Kinematics& k, Stiffness& K) const {
        const Row mean = flat(k.mean_gradients());
        std::array<double, E::points> pdV;
        double pressure = 0;
        for (std::size_t q = 0; q < E::points; ++q) {
            const double dV = k.points.volumes[q], s2 = k.scale_squared(q);
            const Mat3 F = k.F(q), C = F.transpose() * F, strain = k.strain(q), S = material_.pk2(strain);
            const auto B = strain_variation(F, k.points.gradients[q]);
            const Row h = mean - flat(k.spatial_gradients(q));
            const Row r = s2 * material::stress_vector(S).transpose() * B;
            const auto Bbar = varied_strain(k, q, mean);
            const Eigen::Matrix<double, 6, 3 * n> DB = material_.tangent(strain) * Bbar * dV;
            const double p = s2 * S.cwiseProduct(C).sum() / 3;
            K.noalias() += Bbar.transpose() * DB;
            add_initial_stress(k.points.gradients[q], S * (s2 * dV), K);
            const Row cross = 2.0 / 3 * dV * (r + p / 2 * h); // h r + r h + p h h
            K.noalias() += h.transpose() * cross;
            K.noalias() += cross.transpose() * h;
            pdV[q] = p * dV;
            pressure += pdV[q];
        }
        for (std::size_t q = 0; q < E::points; ++q) {
            const Gradients<n> g = k.spatial_gradients(q);
            const Row row = flat(g);
            const double share = pressure * k.weight(q);
            K.noalias() += (share * row.transpose()) * row;
            for (int b = 0; b < n; ++b)
                for (int a = 0; a < n; ++a)
                    K.template block<3, 3>(3 * a, 3 * b).noalias() +=
                        (pdV[q] - share) * g.row(b).transpose() * g.row(a);
        }
        K.noalias() -= (pressure * mean.transpose()) * mean;
    }

    Material material_;
};

} // namespace osculate::fe
