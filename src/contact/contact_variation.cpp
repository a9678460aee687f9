#include "osculate/contact/contact_point.hpp"

namespace osculate::contact {

namespace {
using Moments = Eigen::Matrix<double, PatchVariation::size, 1>;
using Sums = Eigen::Matrix<double, PatchVariation::derivatives, 3>; ///< a moment a row

Moments moments(const PatchVariation& patch, const Vector& dy) {
    Sums sums = Sums::Zero();
    for (std::size_t i = 0; i < patch.place.size(); ++i)
        sums.noalias() += patch.phi.col(static_cast<Index>(i)) * dy.segment<3>(3 + 3 * patch.place[i]).transpose();
    Moments z;
    z.head<3>() = dy.head<3>();
    Eigen::Map<Eigen::Matrix<double, 3, PatchVariation::derivatives>>(z.data() + 3) = sums.transpose();
    return z;
}
} // namespace

void ContactVariation::along(const ContactPoint& point, const Vector& dy, Vector& weights, Vector& pressing) const {
    if (patches.empty()) {
        weights.noalias() = dweights * dy;
        pressing.noalias() = dpressing * dy;
        return;
    }
    static thread_local std::vector<Moments> z;
    z.clear();
    double gap = 0, bump = 0;
    for (const PatchVariation& patch : patches) {
        z.push_back(moments(patch, dy));
        gap += patch.first * z.back();
        bump += patch.dpsi * z.back();
    }
    weights = -bump * point.weights;
    pressing.setZero(3 * point.weights.size());
    Vec3 top = Vec3::Zero();
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const PatchVariation& patch = patches[p];
        const Moments out = patch.second * z[p] - gap * patch.dpsi.transpose() - bump * patch.first.transpose();
        const Vec2 u = patch.du * z[p];
        const double psi = patch.dpsi * z[p];
        const Vec3 shares(psi, u.x(), u.y());
        const Sums sums =
            Eigen::Map<const Eigen::Matrix<double, 3, PatchVariation::derivatives>>(out.data() + 3).transpose();
        top += out.head<3>();
        for (std::size_t i = 0; i < patch.place.size(); ++i) {
            const auto phi = patch.phi.col(static_cast<Index>(i));
            weights(patch.place[i]) += phi.head<3>().dot(shares);
            pressing.segment<3>(3 * patch.place[i]).noalias() += sums.transpose() * phi;
        }
    }
    weights /= bumps;
    const double turn = point.normal.dot(top) / (bumps * slope);
    pressing /= bumps * slope;
    for (Index i = 0; i < point.weights.size(); ++i)
        pressing.segment<3>(3 * i) -= (turn * point.pressing.row(i).transpose()).eval();
}

void ContactVariation::weights_times(const ContactPoint& point, const Eigen::Ref<const Eigen::Matrix3Xd>& m,
                                     Matrix& result) const {
    if (patches.empty()) {
        result.setZero(3, dg.cols());
        result.leftCols(dweights.cols()).noalias() = m * dweights;
        return;
    }
    const Vec3 mean = m * point.weights;
    result.setZero(3, 3 + 3 * point.weights.size());
    for (const PatchVariation& patch : patches) {
        Mat3 C = Mat3::Zero(); // sum m_i Phi_i, sum m_i Phi_i,a
        for (std::size_t i = 0; i < patch.place.size(); ++i)
            C += m.col(patch.place[i]) * patch.phi.col(static_cast<Index>(i)).head<3>().transpose();
        const Eigen::Matrix<double, 3, PatchVariation::size> rows =
            ((C.col(0) - mean) * patch.dpsi + C.rightCols<2>() * patch.du) / bumps;
        result.leftCols<3>() += rows.leftCols<3>();
        for (std::size_t i = 0; i < patch.place.size(); ++i)
            for (int k = 0; k < 3; ++k) // the bump and the foot depend on no second derivatives
                result.middleCols<3>(3 + 3 * patch.place[i]) +=
                    patch.phi(k, static_cast<Index>(i)) * rows.middleCols<3>(3 + 3 * k);
    }
}

} // namespace osculate::contact
