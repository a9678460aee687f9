#include "osculate/study/exact_surface.hpp"

#include <Eigen/LU>
#include <cmath>

namespace osculate::study {

ExactPoint Sphere::closest(const Vec3& x) const {
    const Vec3 n = (x - centre).normalized();
    return {centre + radius * n, n, 1 / radius};
}

ExactPoint Torus::closest(const Vec3& x) const {
    const Vec3 out = Vec3(x.x() - centre.x(), x.y() - centre.y(), 0).normalized();
    const Vec3 middle = centre + ring_radius * out;
    const Vec3 n = (x - middle).normalized();
    // principal curvatures: of the tube's section, and of the circle around the axis
    const double around = n.dot(out) / (ring_radius + tube_radius * n.dot(out));
    return {middle + tube_radius * n, n, 0.5 * (1 / tube_radius + around)};
}

double Saddle::height(double x1, double x2) const {
    const double a = x1 - centre.x(), b = x2 - centre.y();
    return centre.z() + rise * a * a - fall * b * b;
}

ExactPoint Saddle::closest(const Vec3& x) const {
    constexpr int most_iterations = 50;
    constexpr double round_off = 1e-15; // of the coordinates; Newton's last step is far smaller than that
    Vec2 p = x.head<2>();
    const Vec2 second(2 * rise, -2 * fall);
    const auto slope = [&](const Vec2& at) { return Vec2(second.cwiseProduct(at - centre.head<2>())); };
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        // F = 1/2 |X(p) - x|^2, X = (p, f(p))
        const Vec2 f_p = slope(p);
        const double off = height(p.x(), p.y()) - x.z();
        const Vec2 gradient = p - x.head<2>() + off * f_p;
        const Mat2 metric = Mat2::Identity() + f_p * f_p.transpose();
        Mat2 hessian = metric;
        hessian.diagonal() += off * second;
        if (!(hessian.determinant() > 0 && hessian.trace() > 0)) hessian = metric;
        const Vec2 step = hessian.inverse() * gradient;
        p -= step;
        if (step.norm() <= round_off * (1 + p.norm())) break;
    }
    const Vec2 f_p = slope(p);
    const double w2 = 1 + f_p.squaredNorm();
    ExactPoint exact;
    exact.point = Vec3(p.x(), p.y(), height(p.x(), p.y()));
    exact.normal = Vec3(-f_p.x(), -f_p.y(), 1) / std::sqrt(w2);
    // H = -1/2 [(1 + f,2^2) f,11 + (1 + f,1^2) f,22] / (1 + f,1^2 + f,2^2)^(3/2)
    exact.mean_curvature =
        -0.5 * ((1 + f_p.y() * f_p.y()) * second.x() + (1 + f_p.x() * f_p.x()) * second.y()) / (w2 * std::sqrt(w2));
    return exact;
}

} // namespace osculate::study
