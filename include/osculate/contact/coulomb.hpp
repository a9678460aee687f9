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

/// Input of the law for one slave node.
struct ContactState {
    Vec3 lambda = Vec3::Zero(); ///< contact force on the slave node, N; lambda . n > 0 pushes it away from the master
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

/// With T = I - n n^T, augmented normal force L_N = lambda . n - c g and tangential trial force L_T = T v:
///     open   L_N <= 0              R = lambda
///     stick  |L_T| <= mu L_N       R = lambda - L_N n - L_T
///     slip   otherwise             R = lambda - L_N n - mu L_N L_T / |L_T|
///     glide  mu = 0                R = lambda - L_N n
/// A contact that yields has the gap g + from + (yield/c) lambda . n in place of g: L_N = (1 - yield) lambda . n - c (g + from).
/// So contacts that ask for the same motion share its force, and interfaces give way: a law h(p) by its tangent at lambda,
/// so that value and derivatives there are its own.
/// Exact: v = lambda - c d, so that stick means c (g n + T d) = 0. Then R = 0 is exactly p_N >= 0, g >= 0, p_N g = 0
/// and Coulomb's law; c > 0 (N/m) scales the rows, but does not change the solution.
/// Elastic: v = lambda_start - k d: a soft spring k makes stick elastic. For slave nodes that are held or driven along
/// a tangent: if several of them stuck to one master facet, they would constrain its motion more than once, and the
/// tangent would be singular.
/// A law that resists has a force -drag T d more, open or closed, which stick does not feel: lambda + drag T d in place of
/// lambda where that stands alone, not in L_N and v.
class Coulomb {
public:
    /// The exact law. @param mu coefficient of friction  @param c complementarity parameter, N/m
    Coulomb(double mu, double c) : mu_(mu), c_(c), follow_(1), spring_(c), anchor_(Vec3::Zero()) {}
    /// The elastic law. @param k stiffness of stick, N/m  @param lambda_start contact force at the start of the step, N
    [[nodiscard]] static Coulomb elastic(double mu, double c, double k, const Vec3& lambda_start) {
        Coulomb law(mu, c);
        law.follow_ = 0;
        law.spring_ = k;
        law.anchor_ = lambda_start;
        return law;
    }

    /// Compliance of stick, m/N, and the contact force at which it is not strained, N; zeros for the exact law.
    [[nodiscard]] double compliance() const { return follow_ == 0 ? 1 / spring_ : 0; }
    [[nodiscard]] const Vec3& anchor() const { return anchor_; }
    /// Makes the contact yield. @param part  of what c alone would yield, within [0, 1]  @param from  m
    void yield(double part, double from = 0) {
        yield_ = part;
        from_ = from;
    }
    /// Makes what slides meet a resistance. @param drag  force over displacement in the step, N/m
    void resist(double drag) { drag_ = drag; }
    [[nodiscard]] double drag() const { return drag_; }
    /// Compliance along the normal, m/N, and what the gap is more without a force, m.
    [[nodiscard]] double normal_compliance() const { return yield_ / c_; }
    [[nodiscard]] double from() const { return from_; }
    [[nodiscard]] double parameter() const { return c_; } ///< c, N/m
    /// What is zero in contact: the gap, and how far the contact has yielded, m.
    [[nodiscard]] double distance(double gap, double normal_force) const {
        return gap + from_ + yield_ / c_ * normal_force;
    }

    [[nodiscard]] Status status(const ContactState& state) const;
    /// Value and derivatives of the branch `status`, even if status() returns another one.
    [[nodiscard]] ContactResidual residual(const ContactState& state, Status status) const;

private:
    /// v = follow lambda + anchor - spring d
    [[nodiscard]] Vec3 trial(const ContactState& state) const {
        return follow_ * state.lambda + anchor_ - spring_ * state.drift;
    }

    double mu_, c_, follow_, spring_, yield_ = 0, from_ = 0, drag_ = 0;
    Vec3 anchor_;
};

} // namespace osculate::contact
