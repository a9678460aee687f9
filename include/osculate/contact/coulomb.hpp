#pragma once
/// Unilateral contact with Coulomb friction at one slave node, in semismooth (Alart-Curnier) form.

#include "osculate/core/types.hpp"

#include <cstdint>

namespace osculate::contact {

/// `glide` is closed without friction: every closed node of a frictionless pair, and nodes put in contact by hand.
enum class Status : std::uint8_t { open, stick, slip, glide };

[[nodiscard]] constexpr bool is_closed(Status status) {
    return status != Status::open;
}

/// What the law needs to know of one slave node.
struct ContactState {
    Vec3 lambda = Vec3::Zero(); ///< contact force on the slave node, N; lambda . n > 0 presses it off the master
    double gap = 0;             ///< g, m
    Vec3 normal = Vec3::Zero(); ///< n, unit
    Vec3 drift = Vec3::Zero();  ///< d, displacement of the slave relative to the master since the start of the step, m
};

/// Residual and its derivatives with respect to the four members of ContactState.
struct ContactResidual {
    Vec3 value = Vec3::Zero(); ///< N
    Mat3 by_lambda = Mat3::Zero(), by_normal = Mat3::Zero(), by_drift = Mat3::Zero();
    Vec3 by_gap = Vec3::Zero();
};

/// With T = I - n n^T, augmented force L_N = lambda . n - c g and L_T = T (lambda - c d):
///     open   L_N <= 0              R = lambda
///     stick  |L_T| <= mu L_N       R = lambda - L_N n - L_T               ( = c (g n + T d) )
///     slip   otherwise             R = lambda - L_N n - mu L_N L_T / |L_T|
///     glide  mu = 0                R = lambda - L_N n
/// R = 0 is exactly p_N >= 0, g >= 0, p_N g = 0 and Coulomb's law; c > 0 (N/m) scales the rows, never the solution.
class Coulomb {
public:
    /// @param mu coefficient of friction  @param c complementarity parameter, N/m
    Coulomb(double mu, double c) : mu_(mu), c_(c) {}

    [[nodiscard]] Status status(const ContactState& state) const;
    /// Value and derivatives of the branch `status`, whether or not it is the one status() names.
    [[nodiscard]] ContactResidual residual(const ContactState& state, Status status) const;

private:
    double mu_, c_;
};

} // namespace osculate::contact
