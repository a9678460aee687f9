#pragma once
/// Rigid bodies and couplings: what is fixed for a run, and how one moves.

#include "osculate/contact/exact_shape.hpp"
#include "osculate/core/field.hpp"
#include "osculate/model/rotation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace osculate::model {

struct Model;
struct State;

/// Nodes that move as one,
///     u_i = u_r + (R - I)(X_i - X_r),
/// with the displacement u_r of its reference point and the rotation R. Both are carried by nodes of their own behind
/// those of all meshes: node `reference` has the displacement u_r, the next one the sum of the rotation vectors of all
/// steps, times `radius`. So every unknown is a length and every row a force: a moment is divided by `radius`.
/// They are all nodes of a rigid body, or a coupling: some nodes of a body that deforms, which keep their elements and
/// have the mass of these. A coupling has no inertia of its own; its centre is its reference point.
struct RigidBody {
    std::string name;                           ///< of the rigid body, or of the coupling
    bool coupling = false;                      ///< some nodes of a body that deforms
    Index body = -1;                            ///< of the model, whose nodes these are
    std::vector<Index> nodes;                   ///< global, ascending
    Index reference = -1;                       ///< node of the reference point; that of the rotation is the next
    double radius = 1;                          ///< distance of its farthest node from the reference point, m
    double mass = 0;                            ///< kg; 0: none is needed, every stage is static
    Vec3 centre = Vec3::Zero();                 ///< of mass, in the reference configuration, m
    Mat3 inertia = Mat3::Zero();                ///< about the centre, in the reference configuration, kg m^2
    std::optional<contact::ExactShape> shape{}; ///< in the reference configuration; none: it is the surface of its mesh
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero(); ///< of the centre at the start, m/s; rad/s

    [[nodiscard]] Index rotation() const { return reference + 1; }
};

/// Motion of a rigid body in a state: plain values. Those of inertia are zero in statics.
struct RigidMotion {
    Quaternion orientation = Quaternion::Identity();
    Vec3 rotation = Vec3::Zero();                                      ///< rotation vector, continuous beyond pi, rad
    Vec3 velocity = Vec3::Zero(), acceleration = Vec3::Zero();         ///< of the centre, m/s, m/s^2
    Vec3 angular_velocity = Vec3::Zero(), angular_rate = Vec3::Zero(); ///< and its rate, body axes, rad/s, rad/s^2
    Vec3 moment = Vec3::Zero(); ///< rate of the angular momentum about the centre, N m
};

/// Angular velocity in global axes, rad/s.
[[nodiscard]] Vec3 spin(const RigidMotion& motion);
/// Angular momentum about the centre, kg m^2/s.
[[nodiscard]] Vec3 angular_momentum(const RigidBody& body, const RigidMotion& motion);
/// Position of the centre of mass, m.
[[nodiscard]] Vec3 centre_now(const Model& model, const RigidBody& body, const State& state);

/// Sums over all rigid bodies.
struct RigidMomenta {
    double kinetic = 0;                                 ///< J
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero(); ///< kg m/s; about X = 0, kg m^2/s
};
[[nodiscard]] RigidMomenta rigid_momenta(const Model& model, const State& state);

/// Sets velocities and accelerations of the body's nodes from its motion; of a coupling, of its own two. @pre state.v and state.a have all nodes
void spread_velocities(const Model& model, const RigidBody& body, const RigidMotion& motion, State& state);
/// Displacements of the body's mesh from those of its two nodes, for an orientation.
void spread_displacements(const Model& model, const RigidBody& body, const Quaternion& orientation, Field& u);

/// Nodes of rigid bodies and couplings, tied ones, and those of the skin: they have no equations.
[[nodiscard]] std::vector<Index> dependent_nodes(const Model& model);
/// The rigid body or coupling that a node belongs to, be it one that follows or one of its own two; null: none.
[[nodiscard]] const RigidBody* rigid_body_of(const Model& model, Index node);

/// Weights of the nodes of a mesh with a given sum whose centre is a given point: those nearest to equal ones. A force
/// that is shared out so acts at this point, however the body turns.
/// @returns (nodes) empty if the point is not in the plane or on the line of the nodes
[[nodiscard]] std::vector<double> weights_about(const std::vector<Vec3>& nodes, const Vec3& point);

} // namespace osculate::model
