#pragma once
/// Resultants of a contact pair.

#include "osculate/output/snapshot.hpp"

namespace osculate::output {

struct ContactResultants {
    Vec3 force = Vec3::Zero();  ///< on the slave, N
    Vec3 moment = Vec3::Zero(); ///< of those forces about the origin, N m
    double normal = 0;          ///< sum of lambda . n, N
    double friction = 0;        ///< sum of |lambda_T|, N
    double area = 0;            ///< of the closed nodes, in the reference configuration, m^2
    long open = 0, stick = 0, slip = 0;
    double penetration = 0; ///< of the deepest slave node in the master, or of bodies by the audit, >= 0, m
};

[[nodiscard]] ContactResultants contact_resultants(const Snapshot& snapshot, Index pair);

} // namespace osculate::output
