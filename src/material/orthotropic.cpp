#include "osculate/material/orthotropic.hpp"

#include "osculate/material/voigt.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace osculate::material {
namespace {
/// Strains over normal stresses along the axes.
Mat3 compliance(const Orthotropic& m) {
    Mat3 C;
    const double c12 = -m.nu[0] / m.E[0], c13 = -m.nu[1] / m.E[0], c23 = -m.nu[2] / m.E[1];
    C << 1 / m.E[0], c12, c13, c12, 1 / m.E[1], c23, c13, c23, 1 / m.E[2];
    return C;
}
} // namespace

bool Orthotropic::stable() const {
    if (!(E.minCoeff() > 0) || !(G.minCoeff() > 0)) return false;
    const Eigen::LLT<Mat3> factor(compliance(*this));
    return factor.info() == Eigen::Success;
}

Mat6 Orthotropic::stiffness() const {
    Mat6 local = Mat6::Zero();
    local.topLeftCorner<3, 3>() = compliance(*this).inverse();
    local(3, 3) = G[0]; // xy
    local(4, 4) = G[2]; // yz
    local(5, 5) = G[1]; // zx
    Mat6 turn;          // strain vector along the axes of a global one
    for (int k = 0; k < 6; ++k) {
        const Vec6 unit = Vec6::Unit(k);
        Mat3 strain = stress_matrix(unit);
        if (k >= 3) strain /= 2;
        turn.col(k) = strain_vector(axes.transpose() * strain * axes);
    }
    const Mat6 D = turn.transpose() * local * turn;
    return (D + D.transpose()) / 2;
}

} // namespace osculate::material
