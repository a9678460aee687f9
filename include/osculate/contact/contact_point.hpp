#pragma once
/// What one evaluation of a master surface says about one slave point.

#include "osculate/contact/surface_patch.hpp"

#include <vector>

namespace osculate::contact {

/// Gap, normal, weights and their first variations, all from the same evaluation. The variations are with respect to
/// y = (s, x_1 .. x_n), the slave point and the n master nodes of the patch, 3 + 3n columns.
///     gap > 0 open, gap < 0 interpenetration; normal n points out of the master.
struct ContactPoint {
    bool found = false;  ///< false: beyond the master's boundary, or out of its reach; the rest is then meaningless
    bool behind = false; ///< not found because the point is so deep that it lies behind the surface; gap is set
    Index facet = -1;    ///< temporary contact facet MF
    double gap = 0;      ///< g = n . (s - X_P), m
    Vec3 normal = Vec3::Zero();
    Vec3 foot = Vec3::Zero(); ///< X_P
    std::vector<Index> nodes; ///< (n) surface vertices of the patch
    Vector weights;           ///< (n) Phi_i at the foot, the share of each node in the master's motion and force
    MatrixX2 weight_gradient; ///< (n x 2) Phi_i,a: d Phi_i = Phi_i,a du_a
    Eigen::Matrix<double, 2, Eigen::Dynamic> du; ///< (2 x 3+3n) variation of the foot's natural coordinates
    Eigen::Matrix<double, 3, Eigen::Dynamic> dn; ///< (3 x 3+3n) variation of the normal
    Eigen::Matrix<double, 1, Eigen::Dynamic> dg; ///< (3+3n) variation of the gap
};

} // namespace osculate::contact
