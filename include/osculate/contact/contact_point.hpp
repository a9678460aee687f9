#pragma once
/// Result of one evaluation of a master surface for one slave point.

#include "osculate/contact/surface_patch.hpp"

#include <memory>
#include <vector>

namespace osculate::contact {

/// Data that a surface keeps of an evaluation for MasterSurface::vary().
struct PointTrace {
    virtual ~PointTrace() = default;
};

/// Gap, normal and weights of one slave point, all from the same evaluation.
///     gap > 0 open, gap < 0 interpenetration; normal n points out of the master.
/// A contact force lambda on the slave loads master node i with  p_i (lambda . n) - Phi_i (lambda - n n . lambda).
struct ContactPoint {
    bool found = false;  ///< false: beyond the master's boundary or out of its reach; the rest is then undefined
    bool behind = false; ///< not found because the point is so deep that it is behind the surface; gap is set
    Index facet = -1;    ///< temporary contact facet MF
    Index side = -1;     ///< facet of the chosen side if sides meet at a crease; -1: none meet
    double gap = 0;      ///< g, m
    Vec3 normal = Vec3::Zero();
    Vec3 foot = Vec3::Zero(); ///< X_P, at which the weights are evaluated
    std::vector<Index> nodes; ///< (n) surface vertices of the patch
    Vector weights;           ///< (n) Phi_i, the share of each node in the master's motion and in tangential forces
    MatrixX3 pressing;        ///< (n x 3) p_i = dg/dx_i / |dg/ds|, force on each node due to a unit normal force
    std::shared_ptr<const PointTrace> trace; ///< null if the surface keeps nothing

    /// Force on node i due to a contact force lambda on the slave, N.
    [[nodiscard]] Vec3 force(Index i, const Vec3& lambda) const {
        const double L = lambda.dot(normal);
        return pressing.row(i).transpose() * L - weights(i) * (lambda - L * normal);
    }
};

/// Contribution of one patch of a blend to second variations of the gap and first variations of the weights, over
///     z = (ds, sum Phi_i dx_i, sum Phi_i,a dx_i (2), sum Phi_i,ab dx_i (3)),   21 components.
/// The motion of its nodes enters only through z: the cost of more nodes is only that of these sums.
struct PatchVariation {
    static constexpr int size = 21, derivatives = 6;
    using Row = Eigen::Matrix<double, 1, size>;

    std::vector<Index> place;                               ///< position of the patch's nodes among the point's nodes
    Eigen::Matrix<double, derivatives, Eigen::Dynamic> phi; ///< Phi_i; Phi_i,1 Phi_i,2; Phi_i,11 Phi_i,12 Phi_i,22
    Eigen::Matrix<double, size, size> second;               ///< of psi g, less what cancels in the sum over all patches
    Row first, dpsi;                                        ///< contribution to the gap's first variation; of the bump
    Eigen::Matrix<double, 2, size> du;                      ///< psi times the variation of the foot
};

enum class VariationForm {
    gap,      ///< gap and normal alone
    products, ///< also the data for along() and weights_times()
    matrices  ///< all variations as matrices
};

/// First variations of a ContactPoint with respect to y = (s, x_1 .. x_n), the slave point and the n master nodes.
struct ContactVariation {
    VariationForm form = VariationForm::matrices; ///< requested; a surface may give more
    Eigen::Matrix<double, 1, Eigen::Dynamic> dg;  ///< (3+3n) of the gap
    Eigen::Matrix<double, 3, Eigen::Dynamic> dn;  ///< (3 x 3+3n) of the normal
    Matrix dweights;                              ///< (n x 3+3n); columns past its last are zero
    Matrix dpressing;                             ///< (3n x 3+3n), three rows per node
    std::vector<PatchVariation> patches;          ///< if not empty, these replace the last two
    double bumps = 1, slope = 1;                  ///< sum of the bumps, |dg/ds|; with patches

    /// Changes of the weights (n) and of the pressing (3n, three per node) when y changes by dy (3+3n).
    void along(const ContactPoint& point, const Vector& dy, Vector& weights, Vector& pressing) const;
    /// sum_i m_i dPhi_i, 3 x 3+3n, with m (3 x c) for the first c nodes and zero for the others.
    void weights_times(const ContactPoint& point, const Eigen::Ref<const Eigen::Matrix3Xd>& m, Matrix& result) const;
};

} // namespace osculate::contact
