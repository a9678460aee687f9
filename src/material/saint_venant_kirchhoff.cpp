#include "osculate/material/saint_venant_kirchhoff.hpp"

namespace osculate::material {

double SaintVenantKirchhoff::energy(const Mat3& E) const {
    const double trace = E.trace();
    return lambda_ / 2 * trace * trace + mu_ * E.squaredNorm();
}

Mat3 SaintVenantKirchhoff::pk2(const Mat3& E) const {
    return lambda_ * E.trace() * Mat3::Identity() + 2 * mu_ * E;
}

Mat6 SaintVenantKirchhoff::tangent(const Mat3&) const {
    return D_;
}

} // namespace osculate::material
