#pragma once
/// Implicit time integrators as one affine map: velocity and acceleration at t + dt from the displacement there.

#include "osculate/core/types.hpp"

namespace osculate::equilibrium {

/// u = u_n + dt v_n + dt^2 (beta_n a_n + beta a),  v = v_n + dt ((1 - gamma) a_n + gamma a),
/// with equilibrium of  (1 - alpha_m) a + alpha_m a_n  and of  (1 - alpha_f) F(t + dt) + alpha_f F(t), where F is the
/// sum of all other forces. Newmark's formulas have beta_n = 1/2 - beta; backward Euler does not.
/// For alpha_m != alpha_f the acceleration belongs to the time t + (alpha_m - alpha_f) dt.
struct Integrator {
    double alpha_m = 0, alpha_f = 0;
    double beta = 0.25, gamma = 0.5;
    double beta_n = 0.25;
    double error = 1. / 12; ///< coefficient of local_error()
    bool operator==(const Integrator&) const = default;

    /// Displacement at t + dt if the acceleration remains a_n, m.
    [[nodiscard]] Vec3 predictor(const Vec3& u_n, const Vec3& v_n, const Vec3& a_n, double dt) const;
    /// Estimate of the error of this step, m: dt^2 |beta - 1/6 + (alpha_m - alpha_f)/2| |a - a_n|. This is the
    /// difference between u_n + dt v_n + dt^2/2 a_n + beta dt^2 (a - a_n) and Taylor's series, exact up to the next
    /// order if a_n belongs to its time. For backward Euler dt^2/2 |a - a_n|, which is dt times the local error of its
    /// velocity; it excludes the local error of its displacement, dt^2/2 |a|.
    [[nodiscard]] double local_error(const Vec3& a, const Vec3& a_n, double dt) const;
};

/// Second order, dissipative at high frequencies only.                                           [Chung & Hulbert 1993]
/// @param rho_inf  spectral radius at infinite frequency, 0 <= rho_inf <= 1; 1: no dissipation
/// @throws std::invalid_argument outside these bounds, like the other constructors
[[nodiscard]] Integrator generalised_alpha(double rho_inf);
/// Second order for gamma = 1/2, stable for every dt if 2 beta >= gamma.
/// @param beta   > 0
/// @param gamma  >= 1/2
[[nodiscard]] Integrator newmark(double beta, double gamma);
/// Second order, spectral radius (1 + alpha)/(1 - alpha) at infinite frequency.               [Hilber, Hughes, Taylor 1977]
/// @param alpha  -1/3 <= alpha <= 0; 0 is newmark(1/4, 1/2)
[[nodiscard]] Integrator hht(double alpha);
/// First order, v = (u - u_n)/dt, a = (v - v_n)/dt; damps out all high frequencies and much of the low ones.
[[nodiscard]] Integrator backward_euler();

/// The integrator's formulas, solved for v and a, for one dt.
struct Kinematics {
    double by_u_velocity = 0, by_u_acceleration = 0; ///< dv/du in 1/s, da/du in 1/s^2
    double velocity_by_v = 0, velocity_by_a = 0;
    double acceleration_by_v = 0, acceleration_by_a = 0;

    [[nodiscard]] Vec3 velocity(const Vec3& u, const Vec3& u_n, const Vec3& v_n, const Vec3& a_n) const {
        return by_u_velocity * (u - u_n) + velocity_by_v * v_n + velocity_by_a * a_n;
    }
    [[nodiscard]] Vec3 acceleration(const Vec3& u, const Vec3& u_n, const Vec3& v_n, const Vec3& a_n) const {
        return by_u_acceleration * (u - u_n) + acceleration_by_v * v_n + acceleration_by_a * a_n;
    }
};

/// @pre dt > 0
[[nodiscard]] Kinematics kinematics(const Integrator& integrator, double dt);

} // namespace osculate::equilibrium
