#pragma once
/// Deformation of an element at any strain and rotation, whatever its material.

#include "osculate/fe/element_block.hpp"
#include "osculate/fe/isoparametric_map.hpp"
#include "osculate/material/voigt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::fe {

/// dE = B du, engineering shear strains: dE = sym(F^T dF).
template <int n> Eigen::Matrix<double, 6, 3 * n> strain_variation(const Mat3& F, const Gradients<n>& g) {
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

/// Deformation at the quadrature points, written in H = F - 1 and j = J - 1, so that small strains keep their digits.
/// With mean dilatation, strains are those of F-bar = (Jbar / J)^(1/3) F, see FiniteStrainKernel.
template <ReferenceElement E, bool mean_dilatation> struct FiniteKinematics {
    static constexpr int n = E::nodes;
    using Positions = Eigen::Matrix<double, 3, n>;
    using Row = Eigen::Matrix<double, 1, 3 * n>;
    /// Below this, C = 1 + 2 E, whose least eigenvalue can be J^2, has too few digits left: it counts as no volume.
    static constexpr double least_J = 1e-6;

    ElementPoints<E> points;
    std::array<Mat3, E::points> H;
    std::array<double, E::points> j;
    double mean_j = 0;       ///< Jbar - 1
    double volume = 0;       ///< current, sum of J dV, m^3
    Deformation deformation; ///< smallest J

    FiniteKinematics(const ShapeTable<E>& table, const Positions& X, const Positions& u) : points(table, X) {
        double smallest = std::numeric_limits<double>::infinity(), reference = 0;
        for (std::size_t q = 0; q < E::points; ++q) {
            H[q].noalias() = u * points.gradients[q];
            const Mat3& h = H[q];
            const double trace = h.trace();
            // det(1 + H) - 1 = tr H + II_H + det H
            j[q] = trace + (trace * trace - h.cwiseProduct(h.transpose()).sum()) / 2 + h.determinant();
            smallest = std::isfinite(j[q]) ? std::min(smallest, 1 + j[q]) : -std::numeric_limits<double>::infinity();
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
    [[nodiscard]] Gradients<n> spatial_gradients(std::size_t q) const { return points.gradients[q] * F(q).inverse(); }
    /// Share of a point in the current volume.
    [[nodiscard]] double weight(std::size_t q) const { return (1 + j[q]) * points.volumes[q] / volume; }
    /// d ln Jbar = sum_a gbar_a . du_a, gbar the mean of g over the current volume
    [[nodiscard]] Gradients<n> mean_gradients() const {
        Gradients<n> mean = Gradients<n>::Zero();
        for (std::size_t q = 0; q < E::points; ++q) mean += weight(q) * spatial_gradients(q);
        return mean;
    }
    static Row flat(const Gradients<n>& g) { return g.transpose().reshaped().transpose(); }
    /// Variation of strain(q): dE, or dEbar = s^2 (dE + h C / 3), h = d ln Jbar - d ln J.
    [[nodiscard]] Eigen::Matrix<double, 6, 3 * n> varied_strain(std::size_t q, const Row& mean) const {
        const Mat3 Fq = F(q);
        Eigen::Matrix<double, 6, 3 * n> B = strain_variation<n>(Fq, points.gradients[q]);
        if constexpr (mean_dilatation) {
            const Row h = mean - flat(spatial_gradients(q));
            B += material::strain_vector(Fq.transpose() * Fq) / 3 * h;
            B *= scale_squared(q);
        }
        return B;
    }
};

} // namespace osculate::fe
