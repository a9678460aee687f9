#pragma once
/// Derivatives of one slave node's contact law and of the forces on its masters.

#include "osculate/model/contact_evaluation.hpp"
#include "osculate/time/contact_preconditioner.hpp"

#include <span>

namespace osculate::time {

/// As SystemMatrix takes them, over y = (slave, its n master nodes), the first m of which carry force.
struct ContactTangent {
    bool reaches = false;  ///< false: only D means anything
    Mat3 D = Mat3::Zero(); ///< of the law by the contact force
    contact::MatrixX3 E;   ///< (3m x 3) of the forces on the left of the equilibrium by the contact force
    Matrix A, G;           ///< (3 x 3+3n) of the law and (3m x 3+3n) of the forces by y; G where asked for as matrix
    Matrix dd;             ///< (3 x 3+3n) of the drift, scratch
    contact::ContactVariation variation;
};

/// A slave node that bears, and what its derivatives do to a motion.
struct BearingContact {
    const ContactTangent* tangent = nullptr; ///< without G
    const model::ContactEvaluation* evaluation = nullptr;
    Index slave = -1;             ///< of its pair
    Vec3 force = Vec3::Zero();    ///< lambda where the tangent was taken, N
    std::span<const Index> nodes; ///< (n) masters, global, as in the tangent
    SoftContact law;              ///< with the nearest facet in place of the patch

    /// Derivatives along the motion u(node), m, of global nodes and a change lambda of the contact force, N: returns that of
    /// the contact law; `on` (3 a master that carries force) are those of the forces on the left of the equilibrium, the
    /// slave's own being -lambda.
    template <class U> Vec3 multiply(const U& u, const Vec3& lambda, Vector& on) const {
        static thread_local Vector dy;
        dy.resize(3 + 3 * static_cast<Index>(nodes.size()));
        dy.head<3>() = u(law.where.slave);
        for (std::size_t i = 0; i < nodes.size(); ++i) dy.segment<3>(3 + 3 * static_cast<Index>(i)) = u(nodes[i]);
        const Vec3 value = tangent->A * dy + tangent->D * lambda;
        evaluation->master_force_along(slave, force, tangent->variation, dy, on);
        for (Index i = 0; i < on.size() / 3; ++i)
            on.segment<3>(3 * i) = (tangent->E.middleRows<3>(3 * i) * lambda - on.segment<3>(3 * i)).eval();
        return value;
    }
    /// add(node, force) of what multiply() found.
    template <class Add> void scatter(const Vector& on, const Vec3& lambda, Add&& add) const {
        for (Index i = 0; i < on.size() / 3; ++i) add(nodes[static_cast<std::size_t>(i)], Vec3(on.segment<3>(3 * i)));
        add(law.where.slave, Vec3(-lambda));
    }
};

} // namespace osculate::time
