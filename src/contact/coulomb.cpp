#include "osculate/contact/coulomb.hpp"

namespace osculate::contact {

Status Coulomb::status(const ContactState& state) const {
    const Vec3& n = state.normal;
    const double L_N = (1 - yield_) * state.lambda.dot(n) - c_ * (state.gap + from_);
    if (!(L_N > 0)) return Status::open;
    if (mu_ == 0) return Status::glide;
    const Vec3 v = trial(state);
    const Vec3 L_T = v - n * n.dot(v);
    return L_T.norm() <= mu_ * L_N ? Status::stick : Status::slip;
}

ContactResidual Coulomb::residual(const ContactState& state, Status status) const {
    const Vec3& n = state.normal;
    const Vec3& lambda = state.lambda;
    const double c = c_, L = lambda.dot(n), q = yield_ * L + c * (state.gap + from_);
    const Mat3 T = Mat3::Identity() - n * n.transpose();
    // d(T v) = T dv - (n . v) dn - n (v . dn)
    const auto by_normal_of_Tv = [&](const Vec3& v) -> Mat3 {
        return -n.dot(v) * Mat3::Identity() - n * v.transpose();
    };
    ContactResidual R;
    if (drag_ > 0) {
        R.value = drag_ * (T * state.drift);
        R.by_normal = drag_ * by_normal_of_Tv(state.drift);
        R.by_drift = drag_ * T;
    }
    if (status == Status::open) {
        R.value += lambda;
        R.by_lambda.setIdentity();
        return R;
    }
    // lambda - L_N n = T lambda + q n,  q = yield L + c (g + from)
    R.value += T * lambda + q * n;
    R.by_lambda = T + yield_ * n * n.transpose();
    R.by_gap = c * n;
    R.by_normal += by_normal_of_Tv(lambda) + yield_ * n * lambda.transpose() + q * Mat3::Identity();
    if (status == Status::glide) return R;

    const Vec3 v = trial(state);
    const Vec3 L_T = T * v;
    if (status == Status::stick) {
        R.value -= L_T;
        R.by_lambda -= follow_ * T;
        R.by_normal -= by_normal_of_Tv(v);
        R.by_drift += spring_ * T;
        return R;
    }
    const double L_N = L - q;
    const double length = L_T.norm();
    if (!(length > 0)) return R; // no direction to slip in yet
    const Vec3 e = L_T / length;
    const Mat3 turn = mu_ * L_N / length * (Mat3::Identity() - e * e.transpose()); // mu L_N de/dL_T
    R.value -= mu_ * L_N * e;
    R.by_lambda -= mu_ * (1 - yield_) * e * n.transpose() + follow_ * turn * T;
    R.by_gap += mu_ * c * e;
    R.by_normal -= mu_ * (1 - yield_) * e * lambda.transpose() + turn * by_normal_of_Tv(v);
    R.by_drift += spring_ * turn * T;
    return R;
}

} // namespace osculate::contact
