#pragma once
/// Which rigid motions of a body are held by directions at its nodes.

#include "osculate/model/model.hpp"

#include <string>
#include <vector>

namespace osculate::model {

/// About which point a body turns, and its size: what brings rotations to the scale of translations.
struct Extent {
    Vec3 centre = Vec3::Zero(); ///< mean of the nodes, m
    double radius = 0;          ///< of the node farthest from it, m
};
/// @param x  (all nodes) positions, m
[[nodiscard]] Extent extent(const Body& body, const std::vector<Vec3>& x);

/// Rows d . (t + w x r) of held directions d, gathered in a Gram matrix: its rank is the number of motions they hold.
class RigidHold {
public:
    /// @param x  (all nodes) positions, m
    RigidHold(const Body& body, const std::vector<Vec3>& x) : extent_(extent(body, x)) {}

    /// Holds a point of the body along a unit direction.
    void hold(const Vec3& point, const Vec3& direction);
    /// Rigid motions nothing holds, 0 to 6.
    [[nodiscard]] int free() const;
    /// Those in words, "along z", "about x": coordinate axes through the body's centre, and how many there are besides.
    [[nodiscard]] std::vector<std::string> free_motions() const;

private:
    using Motion = Eigen::Matrix<double, 6, 1>; ///< t and w times the body's radius

    Extent extent_;
    Eigen::Matrix<double, 6, 6> gram_ = Eigen::Matrix<double, 6, 6>::Zero();
};

} // namespace osculate::model
