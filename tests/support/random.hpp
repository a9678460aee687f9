#pragma once
/// Repeatable random numbers: the same on every machine, unlike the distributions of <random>.

#include "osculate/core/types.hpp"

#include <random>

namespace osculate::support {

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    /// Uniform in [low, high).
    double uniform(double low = -1, double high = 1) { return low + (high - low) * (engine_() / 4294967296.0); }
    /// Components uniform in [-scale, scale).
    Vec3 vector(double scale = 1) {
        const double x = uniform(), y = uniform(), z = uniform();
        return scale * Vec3(x, y, z);
    }
    /// Uniform over the unit sphere.
    Vec3 direction() {
        for (;;) {
            const Vec3 v = vector();
            if (v.squaredNorm() > 1e-4 && v.squaredNorm() <= 1) return v.normalized();
        }
    }

private:
    std::mt19937 engine_;
};

} // namespace osculate::support
