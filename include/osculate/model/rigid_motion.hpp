#pragma once
/// Determines which rigid motions of a body are held by directions at its nodes.

#include "osculate/linear/constraints.hpp"
#include "osculate/model/model.hpp"

#include <string>
#include <vector>

namespace osculate::model {

/// Centre of a body for rotations, and its size, which scales rotations to translations.
struct Extent {
    Vec3 centre = Vec3::Zero(); ///< mean of the nodes, m
    double radius = 0;          ///< distance of the farthest node from it, m
};
/// @param x  (all nodes) positions, m
[[nodiscard]] Extent extent(const Body& body, const std::vector<Vec3>& x);

/// (bodies) A number that bodies share which ties or equations join.
[[nodiscard]] std::vector<Index> joined_groups(const Model& model);
/// (bodies) Whether equations join a body to others, or to itself, and these constraints hold all of them together: by
/// the rank of small motions.
[[nodiscard]] std::vector<char> held_by_equations(const Model& model,
                                                  const std::vector<linear::NodeConstraint>& constraints);

/// Gram matrix of the rows d . (t + w x r) of held directions d: its rank is the number of motions that they hold.
class RigidHold {
public:
    /// @param x  (all nodes) positions, m
    RigidHold(const Body& body, const std::vector<Vec3>& x) : extent_(extent(body, x)) {}

    /// Holds a point of the body along a unit direction.
    void hold(const Vec3& point, const Vec3& direction);
    /// Holds the body against turning about an axis.
    void hold_turning(const Vec3& axis);
    /// Holds what moves the ends of a sector otherwise than each other: all but what is along the axis and about it.
    void hold(const CyclicSymmetry& ring);
    /// What is held at the nodes of a rigid body, if the body is one.
    void hold(const RigidBody& body, const linear::NodeConstraint& constraint, const std::vector<Vec3>& x);
    /// Number of rigid motions that are not held, 0 to 6.
    [[nodiscard]] int free() const;
    /// These motions in words: "along z", "about x" for coordinate axes through the body's centre, and the number of
    /// others.
    [[nodiscard]] std::vector<std::string> free_motions() const;

private:
    using Motion = Eigen::Matrix<double, 6, 1>; ///< t and w times the body's radius

    Extent extent_;
    Eigen::Matrix<double, 6, 6> gram_ = Eigen::Matrix<double, 6, 6>::Zero();
};

} // namespace osculate::model
