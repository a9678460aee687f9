#pragma once
/// What every parametric patch must do, whatever its basis: an instance of these checks comes with each new one.

#include "osculate/contact/surface_patch.hpp"
#include "support/differences.hpp"

#include <gtest/gtest.h>

namespace osculate::contact::fixtures {

/// The natural coordinates of a patch's nodes, and points to look at.
struct PatchCase {
    MatrixX2 nodes;
    std::vector<Vec2> samples;
    double tolerance;            ///< round-off of the weights: machine epsilon times the condition of the patch
    double difference_step;      ///< in natural coordinates
    double difference_tolerance; ///< round-off / step + curvature * step^2, relative
};

struct Weights {
    Vector phi;
    MatrixX2 phi_a;
};

template <class Patch> Weights weights_at(const Patch& patch, const Vec2& u) {
    Weights w{Vector(patch.size()), MatrixX2(patch.size(), 2)};
    patch.weights(u, w.phi, w.phi_a);
    return w;
}

/// Phi_i(u_j) = delta_ij.
template <class Patch> void expect_interpolates_nodes(const Patch& patch, const PatchCase& c) {
    for (Index j = 0; j < patch.size(); ++j) {
        const Vector phi = weights_at(patch, c.nodes.row(j).transpose()).phi;
        EXPECT_LT((phi - Vector::Unit(patch.size(), j)).cwiseAbs().maxCoeff(), c.tolerance) << "node " << j;
    }
}

/// sum Phi_i = 1, so that sum Phi_i,a = 0.
template <class Patch> void expect_partition_of_unity(const Patch& patch, const PatchCase& c) {
    for (const Vec2& u : c.samples) {
        const Weights w = weights_at(patch, u);
        EXPECT_NEAR(w.phi.sum(), 1, c.tolerance);
        EXPECT_LT(w.phi_a.colwise().sum().cwiseAbs().maxCoeff(),
                  c.tolerance * w.phi_a.cwiseAbs().maxCoeff() + c.tolerance);
    }
}

/// A field given at the nodes by a polynomial of the natural coordinates is that polynomial everywhere.
/// @param degree  1, or 2 with all of xx, xy, yy
template <class Patch> void expect_reproduces(const Patch& patch, const PatchCase& c, int degree) {
    const double quadratic = degree == 2 ? 1 : 0;
    const Vec3 a(0.7, -0.4, 0.9), bx(1.1, 0.3, -0.6), by(-0.2, 0.8, 0.5);
    const Vec3 cxx = quadratic * Vec3(0.5, -0.7, 0.3), cxy = quadratic * Vec3(-0.9, 0.2, 0.6),
               cyy = quadratic * Vec3(0.4, 0.1, -0.8);
    const auto field = [&](const Vec2& u) -> Vec3 {
        return a + bx * u.x() + by * u.y() + cxx * u.x() * u.x() + cxy * u.x() * u.y() + cyy * u.y() * u.y();
    };
    MatrixX3 x(patch.size(), 3);
    for (Index i = 0; i < patch.size(); ++i) x.row(i) = field(c.nodes.row(i).transpose()).transpose();
    const MatrixX3 coefficients = patch.coefficients(x);
    const double h = patch.node_distance(), scale = x.cwiseAbs().maxCoeff();
    for (const Vec2& u : c.samples) {
        const PatchPoint p = patch.point(u, coefficients);
        const Vec3 X_1 = bx + 2 * cxx * u.x() + cxy * u.y(), X_2 = by + cxy * u.x() + 2 * cyy * u.y();
        EXPECT_LT((p.X - field(u)).norm(), c.tolerance * scale);
        EXPECT_LT((p.X_a.col(0) - X_1).norm(), c.tolerance * scale / h);
        EXPECT_LT((p.X_a.col(1) - X_2).norm(), c.tolerance * scale / h);
        EXPECT_LT((p.X_11 - 2 * cxx).norm(), c.tolerance * scale / (h * h));
        EXPECT_LT((p.X_12 - cxy).norm(), c.tolerance * scale / (h * h));
        EXPECT_LT((p.X_22 - 2 * cyy).norm(), c.tolerance * scale / (h * h));
    }
}

/// X = sum Phi_i x_i, and every derivative is that of the function below it.
template <class Patch> void expect_consistent_derivatives(const Patch& patch, const PatchCase& c, const MatrixX3& x) {
    const MatrixX3 coefficients = patch.coefficients(x);
    const double scale = x.cwiseAbs().maxCoeff();
    for (const Vec2& u : c.samples) {
        const Weights w = weights_at(patch, u);
        const PatchPoint p = patch.point(u, coefficients);
        EXPECT_LT((p.X - x.transpose() * w.phi).norm(), c.tolerance * scale);
        EXPECT_LT((p.X_a - x.transpose() * w.phi_a).norm(), c.tolerance * scale / patch.node_distance());

        const Matrix d_phi = osculate::support::central_differences(
            [&](const Vector& at) -> Vector { return weights_at(patch, at).phi; }, u, c.difference_step);
        EXPECT_LT(osculate::support::relative_difference(w.phi_a, d_phi), c.difference_tolerance);

        Matrix second(6, 2); // derivatives of (X,1; X,2) by u1 and u2
        second << p.X_11, p.X_12, p.X_12, p.X_22;
        const Matrix d_tangents = osculate::support::central_differences(
            [&](const Vector& at) -> Vector { return patch.point(at, coefficients).X_a.reshaped(); }, u,
            c.difference_step);
        EXPECT_LT(osculate::support::relative_difference(second, d_tangents), c.difference_tolerance);
    }
}

} // namespace osculate::contact::fixtures
