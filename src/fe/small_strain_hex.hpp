#pragma once
/// Small-strain formulations of the trilinear hexahedron, against locking.

#include "fe/small_strain.hpp"

#include <Eigen/Cholesky>

namespace osculate::fe {

/// B-bar with the mean dilatation: the volumetric part of B is replaced by its average over the element.
/// [Hughes 1980, Int. J. Numer. Meth. Engng 15, 1413]
struct BBarHex {
    using Element = Hex8;

    explicit BBarHex(const Mat6&) {}

    void operator()(const ShapeTable<Hex8>& table, const Hex8::Positions& X, StrainPoints<Hex8>& out) const {
        const ElementPoints<Hex8> points(table, X);
        out.volumes = points.volumes;
        Hex8::Gradient mean = Hex8::Gradient::Zero();
        double volume = 0;
        for (std::size_t q = 0; q < out.B.size(); ++q) {
            mean += points.gradients[q] * points.volumes[q];
            volume += points.volumes[q];
        }
        mean /= volume;
        for (std::size_t q = 0; q < out.B.size(); ++q) {
            out.B[q] = strain_operator<8>(points.gradients[q]);
            // each normal strain gains (mean dilatation - dilatation) / 3
            const Hex8::Gradient correction = (mean - points.gradients[q]) / 3;
            for (int a = 0; a < 8; ++a) {
                out.B[q].block<3, 3>(0, 3 * a).rowwise() += correction.row(a);
            }
        }
    }
};

/// Incompatible modes M_i = 1 - xi_i^2, i = 1..3, on each displacement component, condensed out of the element. Their
/// gradients take the Jacobian at the centre, scaled by det J_0 / det J, so that constant strain leaves them at rest.
/// [Wilson, Taylor, Doherty, Ghaboussi 1973; Taylor, Beresford, Wilson 1976, Int. J. Numer. Meth. Engng 10, 1211]
struct IncompatibleModesHex {
    using Element = Hex8;

    explicit IncompatibleModesHex(const Mat6& stiffness) : D_(stiffness) {}

    void operator()(const ShapeTable<Hex8>& table, const Hex8::Positions& X, StrainPoints<Hex8>& out) const {
        const ElementPoints<Hex8> points(table, X);
        out.volumes = points.volumes;
        const Jacobian centre = jacobian<8>(X, Hex8::gradient(Vec3::Zero()));
        const Mat3 inverse = centre.J.inverse();

        // K_aa alpha + K_au u = 0 makes the modes follow the nodes: alpha = -K_aa^-1 K_au u
        std::array<Eigen::Matrix<double, 6, 9>, Hex8::points> G;
        Eigen::Matrix<double, 9, 9> K_aa = Eigen::Matrix<double, 9, 9>::Zero();
        Eigen::Matrix<double, 9, 24> alpha = Eigen::Matrix<double, 9, 24>::Zero();
        for (std::size_t q = 0; q < out.B.size(); ++q) {
            const double det = points.volumes[q] / table.rule[q].weight;
            const Vec3 dM = -2 * (centre.det / det) * table.rule[q].xi;
            G[q] = strain_operator<3>(Gradients<3>(dM.asDiagonal() * inverse));
            out.B[q] = strain_operator<8>(points.gradients[q]);
            const Eigen::Matrix<double, 9, 6> GtD = G[q].transpose() * D_ * points.volumes[q];
            K_aa.noalias() += GtD * G[q];
            alpha.noalias() -= GtD * out.B[q];
        }
        K_aa.llt().solveInPlace(alpha);
        for (std::size_t q = 0; q < out.B.size(); ++q) out.B[q].noalias() += G[q] * alpha;
    }

private:
    Mat6 D_;
};

} // namespace osculate::fe
