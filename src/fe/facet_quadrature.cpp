#include "osculate/fe/facet_quadrature.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace osculate::fe {
namespace {

/// A quadrature point: shape functions and their derivatives, times no weight, tangents of the facet.
struct Point {
    double weight = 1;
    std::array<double, 4> N{}, dxi{}, deta{};
    Vec3 x_xi = Vec3::Zero(), x_eta = Vec3::Zero();
};

/// Calls use(point) for every quadrature point.
template <class Use> void integrate(const mesh::Facet& facet, const std::vector<Vec3>& positions, Use use) {
    const auto finish = [&](Point& p) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(facet.count); ++i) {
            const Vec3& x = positions[static_cast<std::size_t>(facet.nodes[i])];
            p.x_xi += p.dxi[i] * x;
            p.x_eta += p.deta[i] * x;
        }
        use(p);
    };
    if (facet.count == 3) {
        // N_i integrates to 1/6 over the unit triangle, and the area vector is constant
        Point p{0.5, {1. / 3, 1. / 3, 1. / 3, 0}, {-1, 1, 0, 0}, {-1, 0, 1, 0}};
        finish(p);
        return;
    }
    const std::array<double, 4> xi_i{-1, 1, 1, -1}, eta_i{-1, -1, 1, 1};
    const double g = 1 / std::sqrt(3.0);
    for (std::size_t q = 0; q < 4; ++q) {
        const double xi = g * xi_i[q], eta = g * eta_i[q];
        Point p;
        for (std::size_t i = 0; i < 4; ++i) {
            p.N[i] = (1 + xi_i[i] * xi) * (1 + eta_i[i] * eta) / 4;
            p.dxi[i] = xi_i[i] * (1 + eta_i[i] * eta) / 4;
            p.deta[i] = eta_i[i] * (1 + xi_i[i] * xi) / 4;
        }
        finish(p);
    }
}

} // namespace

std::array<double, 4> tributary_areas(const mesh::Facet& facet, const std::vector<Vec3>& positions) {
    std::array<double, 4> areas{};
    integrate(facet, positions, [&](const Point& p) {
        const double area = p.weight * p.x_xi.cross(p.x_eta).norm();
        for (std::size_t i = 0; i < 4; ++i) areas[i] += p.N[i] * area;
    });
    return areas;
}

std::array<Vec3, 4> pressure_forces(const mesh::Facet& facet, const std::vector<Vec3>& positions, double pressure) {
    std::array<Vec3, 4> forces;
    forces.fill(Vec3::Zero());
    integrate(facet, positions, [&](const Point& p) {
        const Vec3 force = -pressure * p.weight * p.x_xi.cross(p.x_eta);
        for (std::size_t i = 0; i < 4; ++i) forces[i] += p.N[i] * force;
    });
    return forces;
}

Matrix pressure_tangent(const mesh::Facet& facet, const std::vector<Vec3>& positions, double pressure) {
    Matrix K = Matrix::Zero(3 * facet.count, 3 * facet.count);
    integrate(facet, positions, [&](const Point& p) {
        for (int b = 0; b < facet.count; ++b) {
            // d (x_xi x x_eta) = dN_b/dxi du x x_eta - dN_b/deta du x x_xi
            const auto j = static_cast<std::size_t>(b);
            const Vec3 arm = p.dxi[j] * p.x_eta - p.deta[j] * p.x_xi;
            Mat3 cross; // du x arm
            cross << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
            for (int a = 0; a < facet.count; ++a)
                K.block<3, 3>(3 * a, 3 * b) -= pressure * p.weight * p.N[static_cast<std::size_t>(a)] * cross;
        }
    });
    return K;
}

} // namespace osculate::fe
