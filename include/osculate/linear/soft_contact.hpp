#pragma once
/// A slave node's contact law in the form for preconditioners.

#include "osculate/linear/penalty_stiffness.hpp"

namespace osculate::linear {

/// Linearised contact law of one slave node, B w + D lambda = r, w the motion of the slave relative to its facet.
struct SoftContact {
    Index coupling = -1; ///< of Unknowns
    Spring where;        ///< its stiffness is set here
    Vec3 normal = Vec3::Zero();
    Mat3 B = Mat3::Zero(), D = Mat3::Identity();
    double c = 1; ///< stiffness scale, N/m
};

} // namespace osculate::linear
