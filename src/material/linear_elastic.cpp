#include "osculate/material/linear_elastic.hpp"

namespace osculate::material {

Mat6 LinearElastic::stiffness() const {
    Mat6 D = Mat6::Zero();
    D.topLeftCorner<3, 3>().setConstant(lambda());
    D.diagonal().head<3>().array() += 2 * mu();
    D.diagonal().tail<3>().setConstant(mu());
    return D;
}

Vec6 LinearElastic::stress(const Vec6& strain) const {
    Vec6 sigma = mu() * strain;
    sigma.head<3>() += mu() * strain.head<3>();
    sigma.head<3>().array() += lambda() * strain.head<3>().sum();
    return sigma;
}

} // namespace osculate::material
