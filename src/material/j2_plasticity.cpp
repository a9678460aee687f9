#include "osculate/material/j2_plasticity.hpp"

#include "logarithmic_strain.hpp"
#include "osculate/material/voigt.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::material {

double Hardening::yield_stress(double strain) const {
    const auto above = std::ranges::upper_bound(rows, strain, {}, [](const auto& row) { return row[0]; });
    if (above == rows.begin()) return rows.front()[1];
    if (above == rows.end()) return rows.back()[1];
    const auto& [a, from] = *(above - 1);
    const auto& [b, to] = *above;
    return from + (to - from) * (strain - a) / (b - a);
}

double Hardening::work(double strain) const {
    double sum = 0, at = 0, stress = rows.front()[1];
    for (const auto& [a, y] : rows) {
        if (a > strain) break;
        sum += (a - at) * (stress + y) / 2;
        at = a;
        stress = y;
    }
    return sum + (strain - at) * (stress + yield_stress(strain)) / 2;
}

Hardening::Return Hardening::solve(double q, double three_G, double start) const {
    // the difference of both sides falls from row to row
    double at = start, stress = yield_stress(start);
    for (const auto& [a, y] : rows) {
        if (a <= start) continue;
        if (const double left = q - three_G * (a - start) - y; left <= 0) {
            const double slope = (y - stress) / (a - at);
            return {at + (q - three_G * (at - start) - stress) / (three_G + slope), slope};
        }
        at = a;
        stress = y;
    }
    return {start + (q - stress) / three_G, 0};
}

J2Plasticity::At::At(const J2Plasticity& law, std::span<const double> remembered) : law_(law) {
    if (remembered.empty()) return;
    Vec6 tensor;
    std::copy_n(remembered.begin(), 6, tensor.data());
    plastic_ = stress_matrix(tensor);
    strain_ = remembered[6];
}

/// The state at the end of the step.
struct J2Plasticity::At::Flow {
    Mat3 T, plastic;
    double strain = 0;                 ///< equivalent plastic strain
    Mat3 direction = Mat3::Zero();     ///< of the deviatoric trial stress, of norm 1
    double of_deviator = 1, along = 0; ///< 2 G times these: factors of the deviator, and less along the direction
};

J2Plasticity::At::Flow J2Plasticity::At::flow(const Mat3& e) const {
    const double lambda = law_.lambda_, mu = law_.mu_, three_G = 3 * mu, bulk = lambda + 2 * mu / 3;
    const Mat3 elastic = e - plastic_;
    Mat3 deviator = 2 * mu * elastic;
    deviator.diagonal().array() -= deviator.trace() / 3;
    const double norm = deviator.norm(), q = std::sqrt(1.5) * norm;
    Flow end;
    end.plastic = plastic_;
    end.strain = strain_;
    if (q > law_.hardening_.yield_stress(strain_)) {
        const auto [strain, slope] = law_.hardening_.solve(q, three_G, strain_);
        const double step = strain - strain_;
        end.strain = strain;
        end.direction = deviator / norm;
        end.plastic += std::sqrt(1.5) * step * end.direction;
        end.of_deviator = 1 - three_G * step / q;
        end.along = 1 / (1 + slope / three_G) - (1 - end.of_deviator);
        deviator *= end.of_deviator;
    }
    end.T = deviator + bulk * elastic.trace() * Mat3::Identity();
    return end;
}

double J2Plasticity::At::stored(const Mat3& elastic) const {
    const double trace = elastic.trace();
    return law_.lambda_ / 2 * trace * trace + law_.mu_ * elastic.squaredNorm();
}

double J2Plasticity::At::energy(const Mat3& E) const {
    return stored(LogarithmicStrain(E).value() - plastic_);
}

double J2Plasticity::At::potential(const Mat3& E) const {
    const Mat3 e = LogarithmicStrain(E).value();
    const Flow end = flow(e);
    return stored(e - end.plastic) + law_.hardening_.work(end.strain) - law_.hardening_.work(strain_);
}

Mat3 J2Plasticity::At::pk2(const Mat3& E) const {
    const LogarithmicStrain strain(E);
    return strain.conjugate(flow(strain.value()).T);
}

Mat6 J2Plasticity::At::tangent(const Mat3& E) const {
    const LogarithmicStrain strain(E);
    const Flow end = flow(strain.value());
    const double mu = law_.mu_, bulk = law_.lambda_ + 2 * mu / 3;
    // K 1 x 1 + 2 G (t dev - t' n x n)
    Mat6 D = Mat6::Zero();
    D.topLeftCorner<3, 3>().setConstant(bulk - 2 * mu / 3 * end.of_deviator);
    D.diagonal() += 2 * mu * end.of_deviator * Vec6(1, 1, 1, 0.5, 0.5, 0.5);
    const Vec6 n = stress_vector(end.direction);
    D -= 2 * mu * end.along * n * n.transpose();
    return strain.tangent(D, end.T);
}

void J2Plasticity::At::end(const Mat3& E, std::span<double> remembered) const {
    const Flow now = flow(LogarithmicStrain(E).value());
    const Vec6 tensor = stress_vector(now.plastic);
    std::copy_n(tensor.data(), 6, remembered.begin());
    remembered[6] = now.strain;
}

} // namespace osculate::material
