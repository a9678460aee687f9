#pragma once
/// Weights of unknowns, states and residuals in a sum, for derivatives of one quantity by everything at once.

#include "osculate/core/field.hpp"

#include <vector>

namespace osculate::equilibrium {

/// Weights of forces at nodes and of rows of contact laws in a sum, or of displacements and contact forces. Global components.
struct Weights {
    Field nodes;
    std::vector<Vec3> couplings;
};

/// Norms of weights, of the two kinds apart as they have different units.
struct WeightSizes {
    double nodes = 0, couplings = 0;
};

/// Weights of a state between two steps in a sum: of displacements, of velocities and accelerations (both empty in statics), (nodes),
/// and of contact forces, (couplings). Global components.
struct StateWeights {
    Field u, v, a;
    std::vector<Vec3> couplings;
};

} // namespace osculate::equilibrium
