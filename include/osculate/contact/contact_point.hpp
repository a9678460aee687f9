#pragma once
/// What one evaluation of a master surface says about one slave point.

#include "osculate/contact/surface_patch.hpp"

#include <vector>

namespace osculate::contact {

/// Gap, normal and weights of one slave point, all from the same evaluation.
///     gap > 0 open, gap < 0 interpenetration; normal n points out of the master.
/// A contact force lambda on the slave loads master node i with  p_i (lambda . n) - Phi_i (lambda - n n . lambda).
struct ContactPoint {
    bool found = false;  ///< false: beyond the master's boundary, or out of its reach; the rest is then meaningless
    bool behind = false; ///< not found because the point is so deep that it lies behind the surface; gap is set
    Index facet = -1;    ///< temporary contact facet MF
    Index side = -1;     ///< facet of the side that was taken where sides meet in a crease; -1: there are none
    double gap = 0;      ///< g, m
    Vec3 normal = Vec3::Zero();
    Vec3 foot = Vec3::Zero(); ///< X_P, where the weights are taken
    std::vector<Index> nodes; ///< (n) surface vertices that take part
    Vector weights;           ///< (n) Phi_i, the share of each node in the master's motion and in tangential forces
    MatrixX3 pressing;        ///< (n x 3) p_i = dg/dx_i / |dg/ds|, what a unit normal force puts on each node
};

/// First variations of a ContactPoint with respect to y = (s, x_1 .. x_n), the slave point and the n master nodes.
struct ContactVariation {
    bool of_forces = true; ///< asked for; false: dweights and dpressing are left alone where they cost something
    Eigen::Matrix<double, 1, Eigen::Dynamic> dg; ///< (3+3n) of the gap
    Eigen::Matrix<double, 3, Eigen::Dynamic> dn; ///< (3 x 3+3n) of the normal
    Matrix dweights;                             ///< (n x 3+3n)
    Matrix dpressing;                            ///< (3n x 3+3n), three rows a node
};

} // namespace osculate::contact
