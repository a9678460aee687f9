#pragma once
/// Resultants of a contact pair.

#include "osculate/output/snapshot.hpp"

#include <vector>

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

/// @param pair  of the state's pairs
[[nodiscard]] ContactResultants contact_resultants(const Snapshot& snapshot, Index pair);
/// The sum over the pairs that general contact has found; the penetration is the largest.
[[nodiscard]] ContactResultants general_resultants(const Snapshot& snapshot);

/// What general contact does to a body.
struct BodyResultants {
    Vec3 force = Vec3::Zero();  ///< on the body, N
    Vec3 moment = Vec3::Zero(); ///< of the forces on its nodes about the origin, N m
};
/// One for each surface of the general contact.
[[nodiscard]] std::vector<BodyResultants> body_resultants(const Snapshot& snapshot);

} // namespace osculate::output
