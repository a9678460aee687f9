#include "osculate/contact/facet_patch.hpp"

namespace osculate::contact {

namespace {
struct Bilinear {
    Eigen::Vector4d phi;
    Eigen::Matrix<double, 4, 2> phi_a;
};

/// N_b = (1 +- u1)(1 +- u2)/4
Bilinear bilinear(const Vec2& u) {
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
    const auto [phi, phi_a] = bilinear(u);
    p.X = x.transpose() * phi;
    p.X_a = x.transpose() * phi_a;
    p.X_12 = 0.25 * (x.row(0) - x.row(1) + x.row(2) - x.row(3)).transpose();
    return p;
}

void FacetPatch::weights(const Vec2& u, Eigen::Ref<Vector> phi, Eigen::Ref<MatrixX2> phi_a) const {
    if (corners_ == 3) {
        phi << 1 - u.x() - u.y(), u.x(), u.y();
        phi_a << -1, -1, 1, 0, 0, 1;
        return;
    }
    const Bilinear shape = bilinear(u);
    phi = shape.phi;
    phi_a = shape.phi_a;
}

} // namespace osculate::contact
