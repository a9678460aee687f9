#pragma once
/// A slave node that bears on a master, as linear solvers see it.

#include "osculate/linear/soft_contact.hpp"

#include <span>

namespace osculate::linear {

/// Derivatives of one slave node's contact law and of the forces on its masters, by what they do to a motion.
class ContactDerivatives {
public:
    virtual ~ContactDerivatives() = default;
    /// Change of the contact law along a motion dy (3+3n) of slave and masters, m, which is used up, and a change lambda of the
    /// contact force, N; `on` (3 a master that carries force) is that of the forces on the left of the equilibrium, the
    /// slave's own being -lambda.
    virtual Vec3 along(Vector& dy, const Vec3& lambda, Vector& on) const = 0;
};

struct BearingContact {
    const ContactDerivatives* derivatives = nullptr;
    std::span<const Index> nodes; ///< (n) masters, global, as in the derivatives
    SoftContact law;              ///< with the nearest facet in place of the patch

    /// ContactDerivatives::along() the motion u(node) of global nodes.
    template <class U> Vec3 multiply(const U& u, const Vec3& lambda, Vector& on) const {
        static thread_local Vector dy;
        dy.resize(3 + 3 * static_cast<Index>(nodes.size()));
        dy.head<3>() = u(law.where.slave);
        for (std::size_t i = 0; i < nodes.size(); ++i) dy.segment<3>(3 + 3 * static_cast<Index>(i)) = u(nodes[i]);
        return derivatives->along(dy, lambda, on);
    }
    /// add(node, force) of what multiply() found.
    template <class Add> void scatter(const Vector& on, const Vec3& lambda, Add&& add) const {
        for (Index i = 0; i < on.size() / 3; ++i) add(nodes[static_cast<std::size_t>(i)], Vec3(on.segment<3>(3 * i)));
        add(law.where.slave, Vec3(-lambda));
    }
};

} // namespace osculate::linear
