#pragma once
/// Everything that is fixed for a run: bodies, their stiffness, contact pairs, sets. Built once by compile.

#include "osculate/core/shared_pages.hpp"
#include "osculate/fe/element_block.hpp"
#include "osculate/linear/block_matrix.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/model/contact_pair.hpp"
#include "osculate/model/nonlinear_elements.hpp"
#include "osculate/model/rigid_body.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace osculate::model {

class GeneralContact;
struct ContactScope;

struct Body {
    std::string name;
    mesh::Mesh mesh;
    Index first_node = 0;                                    ///< global number of its node 0
    std::vector<std::unique_ptr<fe::ElementKernel>> kernels; ///< one per element block
    std::vector<double> density;                             ///< kg/m^3; one per element block
    std::vector<double> expansion;                           ///< thermal, 1/K; one per element block
    bool rigid = false;                  ///< moves as one, see RigidBody; its kernels know volumes alone
    std::vector<mesh::Facet> exterior{}; ///< mesh::exterior_facets(mesh), whose node numbers are the mesh's

    [[nodiscard]] Index nodes() const { return mesh.node_count(); }
    [[nodiscard]] bool has_mass() const { ///< in some part
        return std::ranges::any_of(density, [](double d) { return d > 0; });
    }
    [[nodiscard]] bool grows() const { ///< where it gets warmer, in some part
        return std::ranges::any_of(expansion, [](double a) { return a != 0; });
    }
};

/// A named part of one body, with global node numbers.
struct Set {
    std::string name;
    Index body = -1;
    std::vector<Index> nodes;
    std::vector<mesh::Facet> facets;
};

/// A node of a tied surface. It moves as the tie says but for the directions along which it is held:
///     u = free sum_a weight_a u_a
struct TiedNode {
    Index node = -1;
    std::vector<std::pair<Index, double>> carriers; ///< nodes of the other surface, and weights that sum to 1
    Mat3 free = Mat3::Identity();                   ///< projector on the directions along which nothing holds the node
};

/// Two surfaces that move as one.
struct Tie {
    std::string name;
    Index slave_body = -1, master_body = -1;
    std::vector<TiedNode> nodes;
    double adjusted = 0; ///< largest distance by which a node was moved onto the other surface, m
    double near = 0;     ///< largest such distance that needs no word, m
    Index left_out = 0;  ///< nodes of the slave that are too far from the master, or beside it
};

/// A node at one end of a sector, and its like at the other: u = free turn u_like, but for the directions along which
/// something holds it.
struct LikeNode {
    Index node = -1, like = -1;
    Mat3 free = Mat3::Identity(); ///< projector on the directions along which nothing holds the node
};

/// A sector that stands for a whole ring.
struct CyclicSymmetry {
    std::string name;
    Index body = -1;
    Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ(); ///< of the ring, m; a unit vector
    Mat3 turn = Mat3::Identity();                    ///< from an end to the other
    std::vector<LikeNode> nodes;
};

/// A node whose displacement along one direction an equation gives: u . direction = sum_a by_a . u_a. What leads it is
/// independent: no other LedNode's direction has a part in it.
struct LedNode {
    Index node = -1;
    Vec3 direction = Vec3::UnitX();           ///< unit; those of one node are orthogonal
    std::vector<std::pair<Index, Vec3>> by{}; ///< nodes
};

/// A node of the skin that a face with midside nodes has in contact, see fe::skin_weights. It belongs to no element, and is
/// where
///     x = x_host + free (sum_a weight_a x_a - x_host)
struct SkinNode {
    Index node = -1, host = -1;                     ///< its own number; the node of an element that it stands for
    std::vector<std::pair<Index, double>> carriers; ///< nodes of elements, and weights that sum to 1
    Mat3 free = Mat3::Identity();                   ///< projector on the directions along which nothing holds the host
};

struct Model {
    std::vector<Body> bodies;
    Vec3 origin = Vec3::Zero(); ///< position of X = 0 in the scene's coordinates, m; saves digits far from their zero
    Field X; ///< reference positions of all nodes relative to `origin`, as in the bodies' meshes, m; at the end the two
             ///< nodes of each rigid body and coupling, both at its reference point, and those of the skin
    std::vector<RigidBody> rigid; ///< what is special about the rigid ones of the bodies; then couplings
    std::vector<Tie> ties;
    std::vector<CyclicSymmetry> cyclic;
    std::vector<LedNode> led;   ///< by equations
    std::vector<SkinNode> skin; ///< ascending, one number after the other
    std::vector<Set> sets;
    ContactPairs pairs;                            ///< those that a scene names
    std::shared_ptr<const GeneralContact> general; ///< contact of all surfaces; null: none
    std::shared_ptr<const Share> share;            ///< of nodes among processes; null: there is one
    linear::BlockMatrix K;                         ///< constant stiffness of the linear elements, in the pattern of all
    std::unique_ptr<NonlinearElements> nonlinear;  ///< the other elements; null if there are none
    linear::BlockMatrix consistent_mass,
        lumped_mass;                      ///< of all bodies, kg, pattern of K; empty if no stage needs it
    std::vector<Index> kept_contact_mass; ///< bodies that keep their contact mass against the request, ascending

    Field initial_velocity; ///< (nodes) m/s; empty if no stage is dynamic

    [[nodiscard]] Index nodes() const { return static_cast<Index>(X.size()); }
    /// Whether some nodes follow others, see dependent_nodes().
    [[nodiscard]] bool has_dependent_nodes() const {
        return !rigid.empty() || !ties.empty() || !cyclic.empty() || !led.empty() || !skin.empty();
    }
    [[nodiscard]] const linear::BlockMatrix& mass(bool lumped) const { return lumped ? lumped_mass : consistent_mass; }
};

/// Exterior facets of a body, with global node numbers. Throws std::logic_error where Body::exterior was not filled.
[[nodiscard]] std::vector<mesh::Facet> exterior_facets(const Body& body);
/// Adds the arrays that all processes hold of a model.
void add_replicas(const Model& model, Replicas& replicas);
/// Displacements, or velocities, of led and tied nodes, ends of sectors and skins from those of the nodes that they follow.
void move_tied(const Model& model, Field& u);
/// Nodes that follow others, and each of those that they follow, ascending; rotations of rigid bodies follow their
/// reference points here.
[[nodiscard]] std::vector<std::pair<Index, Index>> followed_nodes(const Model& model);
/// Directions along which equations lead nodes.
[[nodiscard]] std::vector<linear::LedDirection> led_directions(const Model& model);
/// The node of an element that a node of the skin stands for; any other node itself.
[[nodiscard]] Index material_node(const Model& model, Index node);
/// (bodies) A number that bodies share which are tied to each other.
[[nodiscard]] std::vector<Index> tied_groups(const Model& model);
/// Number of the body of a global node, also of one of its skin, and the body; -1 and null for node -1.
[[nodiscard]] Index body_index(const Model& model, Index node);
[[nodiscard]] const Body* body_of(const Model& model, Index node);
/// Internal forces of all bodies at the end of a step, or in a state, (nodes) N.
[[nodiscard]] Field internal_force(const Model& model, const BodyStep& step, int threads);
/// Energy stored in all bodies, J.
[[nodiscard]] double strain_energy(const Model& model, const Field& u, const MaterialHistory& history, int threads);
/// History of the undeformed initial state.
[[nodiscard]] MaterialHistory initial_history(const Model& model);
/// Largest diagonal entry of the stiffness of all undeformed bodies, N/m.
[[nodiscard]] double largest_stiffness(const Model& model);
/// Stiffness of all undeformed bodies, in the pattern of K.
[[nodiscard]] linear::BlockMatrix undeformed_stiffness(const Model& model, int threads);
/// Stiffness of the linear bodies, in the pattern of all bodies.
/// @param neighbours  of these bodies
[[nodiscard]] linear::BlockMatrix assemble_stiffness(const std::vector<Body>& bodies, Lists neighbours,
                                                     const std::shared_ptr<const Share>& share = nullptr);

/// Nodes that share an element, see linear::neighbours.
[[nodiscard]] Lists neighbours(const std::vector<Body>& bodies, Index nodes);
struct AssembledMass {
    linear::BlockMatrix M;
    std::vector<Index> kept; ///< bodies that keep the mass of marked nodes: nothing else has their moments
};
/// Mass of all bodies, multiples of the unit matrix in the pattern of the stiffness; lumped: diagonal.
/// @param massless  (nodes) marks nodes without mass: their mass goes to the other nodes of their elements, and factors
///                  near 1 on all elements keep the body's mass, centre and inertia to round-off, see moment_factors().
///                  A body for which no such factors exist keeps its mass unchanged. Empty: none
[[nodiscard]] AssembledMass assemble_mass(const std::vector<Body>& bodies, Index nodes, bool lumped,
                                          const std::vector<char>& massless,
                                          const std::shared_ptr<const Share>& share = nullptr);
/// (nodes) lumped fraction of each node in the volume of its body; the fractions of a body sum to 1.
[[nodiscard]] std::vector<double> volume_shares(const Model& model);
/// Centre of mass of a body in its reference configuration, of its volume where it has no mass, m.
[[nodiscard]] Vec3 centre_of_mass(const Body& body);
/// Mass, centre of mass and inertia about it of a body of uniform density in its reference configuration.
struct MassProperties {
    double mass = 0;             ///< kg
    Vec3 centre = Vec3::Zero();  ///< m
    Mat3 inertia = Mat3::Zero(); ///< kg m^2
};
[[nodiscard]] MassProperties mass_properties(const Body& body, double density);
/// Consistent nodal forces of a body force b (N/m^3) on one body, added into f (all nodes).
void add_body_force(const Body& body, const Vec3& b, Field& f);

/// The same of the weight density * g.
void add_gravity(const Body& body, const Vec3& g, Field& f);

/// Consistent nodal forces density * speed^2 * (distance from an axis) on one body, exact for the elements' own positions,
/// added into f (all nodes). @param speed  rad/s
void add_centrifugal_force(const Body& body, const Vec3& point, const Vec3& axis, double speed, Field& f);

/// State after an accepted step, restored after a rejected one: plain values.
struct State {
    double time = 0;
    Field u;    ///< displacements, m
    Field v, a; ///< velocities, m/s, and accelerations, m/s^2; empty before the first dynamic stage
    std::vector<ContactHistory> contact; ///< of the model's pairs, in their order, then of those of general contact
    std::shared_ptr<const ContactScope> scope{}; ///< of the latter; null without general contact
    MaterialHistory material{};
    std::vector<RigidMotion> rigid{}; ///< of the model's rigid bodies

    /// The step of zero length from this state to itself; its forces are those of the state.
    [[nodiscard]] BodyStep at_rest() const { return {u, u, material}; }
};

/// Some nodes of a body, for which means over the elements around them are wanted. Views.
struct BodyPart {
    std::span<const char> elements; ///< (elements of the body) whether one has a node of the part
    std::span<const Index> point;   ///< (nodes of the body) its number in the part; -1: not in it
    Index points = 0;
};

/// Nodal stress of one body (nodes x 6, Pa, Voigt): averages of element values, weighted by element volumes.
/// @param part  (points x 6) those of its nodes alone; not given: all
[[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 6> nodal_stress(const Model& model, Index body, const State& state,
                                                                    const std::optional<BodyPart>& part = std::nullopt);

} // namespace osculate::model
