#include "osculate/contact/facet_patch.hpp"

#include <cmath>

namespace osculate::contact {

namespace {
constexpr double least_turn = 0.1;   ///< of N . N(0) / |N(0)|^2
constexpr double least_cosine = 0.5; ///< of the angle between N and N(0): warped facets far past their corners

struct Bilinear {
    Eigen::Vector4d phi;
    Eigen::Matrix<double, 4, 2> phi_a;
};

/// N_b = (1 +- u1)(1 +- u2)/4, flat: without u1 u2
Bilinear bilinear(const Vec2& u, bool flat) {
    if (flat) {
        Bilinear shape;
        shape.phi_a << -0.25, -0.25, 0.25, -0.25, 0.25, 0.25, -0.25, 0.25;
        shape.phi = shape.phi_a * u;
        shape.phi.array() += 0.25;
        return shape;
    }
    const double a = (1 - u.x()) / 4, b = (1 + u.x()) / 4, c = 1 - u.y(), d = 1 + u.y();
    Bilinear shape;
    shape.phi << a * c, b * c, b * d, a * d;
    shape.phi_a << -c / 4, -a, c / 4, -b, d / 4, b, -d / 4, a;
    return shape;
}
} // namespace

PatchPoint FacetPatch::point(const Vec2& u, const MatrixX3& x) const {
    PatchPoint p;
    if (corners_ == 3) {
        p.X_a.col(0) = (x.row(1) - x.row(0)).transpose();
        p.X_a.col(1) = (x.row(2) - x.row(0)).transpose();
        p.X = x.row(0).transpose() + p.X_a * u;
        return p;
    }
    const auto [phi, phi_a] = bilinear(u, flat_);
    p.X = x.transpose() * phi;
    p.X_a = x.transpose() * phi_a;
    if (!flat_) p.X_12 = 0.25 * (x.row(0) - x.row(1) + x.row(2) - x.row(3)).transpose();
    return p;
}

bool FacetPatch::folded(const Foot& foot, const MatrixX3& x) const {
    const Matrix32 middle = point(Vec2::Zero(), x).X_a;
    const Vec3 N0 = middle.col(0).cross(middle.col(1)), N = foot.point.X_a.col(0).cross(foot.point.X_a.col(1));
    const double along = N.dot(N0);
    if (foot.u.cwiseAbs().maxCoeff() <= 1) return !(along > 0);
    return !(along > least_turn * N0.squaredNorm() && along > least_cosine * N.norm() * N0.norm());
}

std::optional<Vec2> FacetPatch::in_plane(const Vec3& s, const MatrixX3& x) const {
    // s = X(0) + a p + b q and X,12 = beta a + alpha b: with p = u1 + beta u1 u2 and q = u2 + alpha u1 u2, quadratic
    // equations for u1 and u2, whose discriminant is (N . N(0) / |N(0)|^2)^2
    const PatchPoint middle = point(Vec2::Zero(), x);
    const Mat2 metric = middle.X_a.transpose() * middle.X_a;
    if (!(metric.determinant() > 0)) return std::nullopt;
    const Mat2 inverse = metric.inverse();
    const Vec2 at = inverse * (middle.X_a.transpose() * (s - middle.X)),
               uneven = inverse * (middle.X_a.transpose() * middle.X_12);
    const double p = at.x(), q = at.y(), beta = uneven.x(), alpha = uneven.y();
    const double B = 1 + alpha * p - beta * q, discriminant = B * B + 4 * beta * q;
    if (!(discriminant > 0)) return std::nullopt;
    const double root = std::sqrt(discriminant), first = 2 - B + root, second = B + root;
    if (first == 0 || second == 0) return std::nullopt;
    return Vec2(2 * p / first, 2 * q / second);
}

std::optional<Foot> FacetPatch::foot(const Vec3& s, const MatrixX3& x, const Vec2& u) const {
    std::optional<Foot> found = project(*this, x, s, u);
    if (corners_ == 3 || flat_ || (found && !folded(*found, x))) return found;
    const std::optional<Vec2> start = in_plane(s, x);
    if (!start) return std::nullopt;
    found = project(*this, x, s, *start);
    if (found && folded(*found, x)) return std::nullopt;
    return found;
}

void FacetPatch::weights(const Vec2& u, Eigen::Ref<Vector> phi, Eigen::Ref<MatrixX2> phi_a) const {
    if (corners_ == 3) {
        phi << 1 - u.x() - u.y(), u.x(), u.y();
        phi_a << -1, -1, 1, 0, 0, 1;
        return;
    }
    const Bilinear shape = bilinear(u, flat_);
    phi = shape.phi;
    phi_a = shape.phi_a;
}

} // namespace osculate::contact
