#pragma once
/// Total Lagrangian kernels at any strain and rotation, of hyperelastic materials and of those with a memory.

#include "fe/kernel_instances.hpp"
#include "fe/solid_kernel.hpp"
#include "osculate/material/voigt.hpp"

#include <algorithm>
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
    using Stresses = std::array<Mat3, E::points>;
    using Moduli = std::array<Mat6, E::points>;

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

    /// Variation of k.strain(q): dE, or dEbar = s^2 (dE + h C / 3), h = d ln Jbar - d ln J.
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
            mean_varied = flat(varied.mean_gradients());
            mean_moved = flat(moved.mean_gradients());
        }
        const auto stress_variation = [&](std::size_t q) -> Eigen::Matrix<double, 6, 3 * n> {
            return D[q] * varied_strain(moved, q, mean_moved) * moved.points.volumes[q];
        };
        if constexpr (n <= 8) {
            for (std::size_t q = 0; q < E::points; ++q)
                K.noalias() += varied_strain(varied, q, mean_varied).transpose() * stress_variation(q);
        } else { // many points of many nodes: one product of all of them is several times as quick
            Eigen::Matrix<double, 6 * E::points, 3 * n> B, DB;
            for (std::size_t q = 0; q < E::points; ++q) {
                const auto row = static_cast<Eigen::Index>(6 * q);
                B.template middleRows<6>(row) = varied_strain(varied, q, mean_varied);
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

    /// With phi = ln Jbar - ln J, h = dphi, s^2 = exp(2/3 phi), p = s^2 S : C / 3, r = s^2 S : dE:
    ///   S : ddEbar = s^2 S : ddE + 2/3 (h r + r h) + 2/3 p h h + p ddphi,
    ///   dd ln J = -g_b g_a on block (a, b),  dd ln Jbar = sum_q w_q (g g + dd ln J)_q - gbar gbar.
    static void add_mean_dilatation(const Kinematics& k, const Stresses& S, Stiffness& K) {
        const Row mean = flat(k.mean_gradients());
        std::array<double, E::points> pdV;
        double pressure = 0;
        for (std::size_t q = 0; q < E::points; ++q) {
            const double dV = k.points.volumes[q], s2 = k.scale_squared(q);
            const Mat3 F = k.F(q);
            const auto B = strain_variation(F, k.points.gradients[q]);
            const Row h = mean - flat(k.spatial_gradients(q));
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

    [[nodiscard]] Deformation force(const Kinematics& k, std::span<const double> history,
                                    Eigen::Ref<Eigen::Matrix3Xd> f) const {
        if (!k.deformation.admissible()) return k.deformation;
        const Forces sum = forces(k, stresses(k, history));
        if (!sum.allFinite()) return overflow;
        f = sum;
        return k.deformation;
    }

    [[nodiscard]] Deformation end_tangent(const Kinematics& k, std::span<const double> history,
                                          Eigen::Ref<Matrix> Ke) const {
        if (!k.deformation.admissible()) return k.deformation;
        const Stiffness K = stress_tangent(k, stresses(k, history)) + material_tangent(k, k, moduli(k, history));
        if (!K.allFinite()) return overflow;
        Ke = (K + K.transpose()) / 2;
        return k.deformation;
    }

    [[nodiscard]] Deformation mean_force(const Step& step, Eigen::Ref<Eigen::Matrix3Xd> f) const {
        if (!step.deformation().admissible()) return step.deformation();
        const Forces sum = forces(step.mean, step.S);
        if (!sum.allFinite()) return overflow;
        f = sum;
        return step.deformation();
    }

    [[nodiscard]] Deformation mean_tangent(const Step& step, Eigen::Ref<Matrix> Ke) const {
        if (!step.deformation().admissible()) return step.deformation();
        const Stiffness K = step.weights.end_weight * stress_tangent(step.mean, step.S) +
                            material_tangent(step.mean, step.end, step.moduli(*this));
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
