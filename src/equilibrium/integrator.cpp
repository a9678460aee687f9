#include "osculate/equilibrium/integrator.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace osculate::equilibrium {

namespace {

/// Every comparison with NaN is false, so that NaN is refused, too.
void demand(bool within, const char* bounds, double found) {
    if (within) return;
    std::ostringstream text;
    text << "expected " << bounds << ", found " << found;
    throw std::invalid_argument(text.str());
}

Integrator newmark_family(double alpha_m, double alpha_f, double beta, double gamma) {
    return {alpha_m, alpha_f, beta, gamma, 0.5 - beta, std::abs(beta - 1. / 6 + 0.5 * (alpha_m - alpha_f))};
}

/// gamma and beta that make the method second order and most dissipative at high frequencies.
Integrator second_order(double alpha_m, double alpha_f) {
    const double shift = alpha_f - alpha_m;
    return newmark_family(alpha_m, alpha_f, 0.25 * (1 + shift) * (1 + shift), 0.5 + shift);
}

} // namespace

Integrator generalised_alpha(double rho_inf) {
    demand(rho_inf >= 0 && rho_inf <= 1, "0 <= rho_inf <= 1", rho_inf);
    return second_order((2 * rho_inf - 1) / (rho_inf + 1), rho_inf / (rho_inf + 1));
}

Integrator newmark(double beta, double gamma) {
    demand(beta > 0 && std::isfinite(beta), "Newmark's beta > 0", beta);
    demand(gamma >= 0.5 && std::isfinite(gamma), "Newmark's gamma >= 1/2", gamma);
    return newmark_family(0, 0, beta, gamma);
}

Integrator hht(double alpha) {
    demand(alpha >= -1. / 3 && alpha <= 0, "-1/3 <= alpha <= 0", alpha);
    return second_order(0, -alpha);
}

Integrator backward_euler() {
    return {0, 0, 1, 1, 0, 0.5};
}

Vec3 Integrator::predictor(const Vec3& u_n, const Vec3& v_n, const Vec3& a_n, double dt) const {
    return u_n + dt * v_n + dt * dt * (beta_n + beta) * a_n;
}

double Integrator::local_error(const Vec3& a, const Vec3& a_n, double dt) const {
    return dt * dt * error * (a - a_n).norm();
}

Kinematics kinematics(const Integrator& integrator, double dt) {
    const double beta = integrator.beta, gamma = integrator.gamma, beta_n = integrator.beta_n;
    Kinematics k;
    k.by_u_velocity = gamma / (beta * dt);
    k.velocity_by_v = 1 - gamma / beta;
    k.velocity_by_a = dt * (1 - gamma - gamma * beta_n / beta);
    k.by_u_acceleration = 1 / (beta * dt * dt);
    k.acceleration_by_v = -1 / (beta * dt);
    k.acceleration_by_a = -beta_n / beta;
    return k;
}

} // namespace osculate::equilibrium
