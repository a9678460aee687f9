#include "osculate/fe/facet_quadrature.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace osculate::fe {
namespace {

/// Calls add(i, N_i w, a) for every node i and quadrature point, a = dx/dxi x dx/deta the area vector of the point.
template <class Add> void integrate(const mesh::Facet& facet, const std::vector<Vec3>& positions, Add add) {
    const auto x = [&](int i) -> const Vec3& {
        return positions[static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(i)])];
    };
    if (facet.count == 3) {
        // N_i integrates to 1/6 over the unit triangle, and a is constant
        const Vec3 area = (x(1) - x(0)).cross(x(2) - x(0));
        for (int i = 0; i < 3; ++i) add(static_cast<std::size_t>(i), 1.0 / 6, area);
        return;
    }
    const std::array<double, 4> xi_i{-1, 1, 1, -1}, eta_i{-1, -1, 1, 1};
    const double g = 1 / std::sqrt(3.0);
    for (std::size_t q = 0; q < 4; ++q) {
        const double xi = g * xi_i[q], eta = g * eta_i[q];
        Vec3 dxi = Vec3::Zero(), deta = Vec3::Zero();
        std::array<double, 4> N{};
        for (std::size_t i = 0; i < 4; ++i) {
            N[i] = (1 + xi_i[i] * xi) * (1 + eta_i[i] * eta) / 4;
            dxi += xi_i[i] * (1 + eta_i[i] * eta) / 4 * x(static_cast<int>(i));
            deta += eta_i[i] * (1 + xi_i[i] * xi) / 4 * x(static_cast<int>(i));
        }
        const Vec3 area = dxi.cross(deta);
        for (std::size_t i = 0; i < 4; ++i) add(i, N[i], area);
    }
}

} // namespace

std::array<double, 4> tributary_areas(const mesh::Facet& facet, const std::vector<Vec3>& positions) {
    std::array<double, 4> areas{};
    integrate(facet, positions, [&](std::size_t i, double N, const Vec3& area) { areas[i] += N * area.norm(); });
    return areas;
}

std::array<Vec3, 4> pressure_forces(const mesh::Facet& facet, const std::vector<Vec3>& positions, double pressure) {
    std::array<Vec3, 4> forces;
    forces.fill(Vec3::Zero());
    integrate(facet, positions, [&](std::size_t i, double N, const Vec3& area) { forces[i] -= pressure * N * area; });
    return forces;
}

} // namespace osculate::fe
