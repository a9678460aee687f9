#pragma once
/// A slave node in contact with a master, in the form that linear solvers need.

#include "osculate/linear/soft_contact.hpp"

#include <span>

namespace osculate::linear {

/// Derivatives of one slave node's contact law and of the forces on its masters, as products with a motion.
class ContactDerivatives {
public:
    virtual ~ContactDerivatives() = default;
    /// Change of the contact law along a motion dy (3+3n) of slave and masters, m, and a change lambda of the contact
    /// force, N. Overwrites dy. `on` (3 per master that carries force) is the change of the forces on the left of the
    /// equilibrium; that of the slave is -lambda.
    virtual Vec3 along(Vector& dy, const Vec3& lambda, Vector& on) const = 0;
};

struct BearingContact {
    const ContactDerivatives* derivatives = nullptr;
    std::span<const Index> nodes; ///< (n) masters, global, in the order of the derivatives
    SoftContact law;              ///< with the nearest facet instead of the patch

    /// ContactDerivatives::along() for the motion u(node) of global nodes.
    template <class U> Vec3 multiply(const U& u, const Vec3& lambda, Vector& on) const {
        static thread_local Vector dy;
        dy.resize(3 + 3 * static_cast<Index>(nodes.size()));
        dy.head<3>() = u(law.where.slave);
        for (std::size_t i = 0; i < nodes.size(); ++i) dy.segment<3>(3 + 3 * static_cast<Index>(i)) = u(nodes[i]);
        return derivatives->along(dy, lambda, on);
    }
    /// Calls add(node, force) for the results of multiply().
    template <class Add> void scatter(const Vector& on, const Vec3& lambda, Add&& add) const {
        for (Index i = 0; i < on.size() / 3; ++i) add(nodes[static_cast<std::size_t>(i)], Vec3(on.segment<3>(3 * i)));
        add(law.where.slave, Vec3(-lambda));
    }
};

} // namespace osculate::linear
