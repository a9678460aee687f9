#pragma once
/// Rigid motions of bodies that neither supports nor contact without friction hold.

#include "osculate/app/compile.hpp"

#include <string>
#include <vector>

namespace osculate::app {

struct FreeMotion {
    std::string bodies; ///< "cap", or several that move as one: "cap, base"
    std::string motion; ///< "slides along x", "turns about the axis along z through (0.5, 0, 1) m"
    bool rubs = false;  ///< friction may hold it once the bodies are pressed together
    bool apart = false; ///< a pair of the body does not touch yet
};

/// Those of the first static stage; none where every stage is dynamic, as inertia holds every body. A slave node holds
/// its body, and the master's, along the normal where it is nearer to the master than facets of either side are long; each body is taken
/// by itself, the others at rest, and then all that touch one another as one.
/// @param contact  in the reference configuration
[[nodiscard]] std::vector<FreeMotion> free_motions(const Plan& plan, const model::ContactEvaluations& contact);

/// Motions of a rigid body that rows d . (t + w x (p - centre)) leave free, in words.
class RigidFreedom {
public:
    /// @param size  of the body, m
    RigidFreedom(const Vec3& centre, double size) : centre_(centre), size_(size) {}
    void hold(const Vec3& point, const Vec3& direction);
    void hold_turning(const Vec3& axis);
    /// The same by contact, whose normals are not exact.
    void press(const Vec3& point, const Vec3& normal);
    /// @param origin  added to places
    [[nodiscard]] std::vector<std::string> in_words(const Vec3& origin) const;

private:
    Vec3 centre_;
    double size_;
    Eigen::Matrix<double, 6, 6> held_ = Eigen::Matrix<double, 6, 6>::Zero(), pressed_ = held_; ///< Gram matrices
};

} // namespace osculate::app
