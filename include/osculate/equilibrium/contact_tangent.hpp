#pragma once
/// Derivatives of one slave node's contact law and of the forces on its masters.

#include "osculate/linear/bearing_contact.hpp"
#include "osculate/model/contact_evaluation.hpp"

namespace osculate::equilibrium {

/// Derivatives in the form of SystemMatrix, with respect to y = (slave, its n master nodes); the first m masters carry
/// force.
struct ContactTangent final : linear::ContactDerivatives {
    bool reaches = false;  ///< false: only D is valid
    Index carriers = 0;    ///< m; 0 if it does not reach
    Mat3 D = Mat3::Zero(); ///< of the law, by the contact force
    contact::MatrixX3 E;   ///< (3m x 3) of the forces on the left of the equilibrium, by the contact force
    Matrix A, G;           ///< (3 x 3+3n) of the law and (3m x 3+3n) of the forces, by y; G only if needed as matrix
    Matrix dd;             ///< (3 x 3+3n) of the drift, scratch
    contact::ContactVariation variation;
    const model::ContactEvaluation* evaluation = nullptr;
    Index slave = -1;          ///< number within its pair
    Vec3 force = Vec3::Zero(); ///< lambda where the tangent was taken, N

    Vec3 along(Vector& dy, const Vec3& lambda, Vector& on) const override {
        const Vec3 value = A * dy + D * lambda;
        evaluation->master_force_along(slave, force, variation, dy, on);
        for (Index i = 0; i < on.size() / 3; ++i)
            on.segment<3>(3 * i) = (E.middleRows<3>(3 * i) * lambda - on.segment<3>(3 * i)).eval();
        return value;
    }

    /// The transpose of along(): of a weight of the law and of weights of the forces on masters (3 per carrier), the weights dy (3+3n)
    /// of a motion, and returned that of the contact force, but for the part of the slave's force. @pre G is there
    Vec3 along_transposed(const Vec3& of_law, const Vector& of_forces, Vector& dy) const {
        dy.noalias() = A.transpose() * of_law;
        Vec3 of_lambda = D.transpose() * of_law;
        if (of_forces.size() == 0) return of_lambda;
        dy.noalias() += G.transpose() * of_forces;
        return of_lambda + E.transpose() * of_forces;
    }
};

} // namespace osculate::equilibrium
