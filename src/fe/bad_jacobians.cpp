#include "osculate/fe/bad_jacobians.hpp"

#include "osculate/fe/with_element.hpp"

#include <Eigen/LU>

namespace osculate::fe {

namespace {

/// Natural coordinates at which an element is looked at.
template <ReferenceElement E> std::vector<Vec3> places() {
    std::vector<Vec3> all{E::node_positions().rowwise().mean()};
    if constexpr (E::degree > 1)
        for (int a = 0; a < E::nodes; ++a) all.emplace_back(E::node_positions().col(a));
    for (const QuadraturePoint& point : E::quadrature()) all.push_back(point.xi);
    for (const QuadraturePoint& point : E::mass_quadrature()) all.push_back(point.xi);
    return all;
}

} // namespace

std::vector<BadJacobian> bad_jacobians(const mesh::ElementBlock& block, const std::vector<Vec3>& positions) {
    std::vector<BadJacobian> bad;
    with_element(block.type, [&]<class E>() {
        const std::vector<Vec3> xi = places<E>();
        std::vector<typename E::Gradient> dN;
        for (const Vec3& at : xi) dN.push_back(E::gradient(at));
        typename E::Positions X;
        for (Index e = 0; e < block.size(); ++e) {
            for (int a = 0; a < E::nodes; ++a)
                X.col(a) = positions[static_cast<std::size_t>(
                    block.connectivity[static_cast<std::size_t>(e) * E::nodes + static_cast<std::size_t>(a)])];
            for (std::size_t k = 0; k < xi.size(); ++k) {
                const Mat3 J = X * dN[k];
                if (J.determinant() > 0) continue;
                bad.push_back({e, X * E::shape(xi[k])});
                break;
            }
        }
    });
    return bad;
}

} // namespace osculate::fe
