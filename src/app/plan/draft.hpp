#pragma once
/// A plan that is being made of a scene, part by part, in the order of compile().

#include "app/plan/load_spread.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace osculate::app {

struct Draft {
    scene::Scene scene; ///< pairs are settled in it, and rigid bodies get a stiff material
    int threads;
    Timings& timings;
    Plan plan{};
    std::shared_ptr<Ranks> ranks{}; ///< processes that share the run; null: one
    std::vector<Fault> faults{};
    std::map<std::string, model::Set> skins{};  ///< sets of pairs whose faces have midside nodes, with the skin's nodes
    std::vector<model::CyclicSymmetry> rings{}; ///< with all nodes of their ends, whatever leads them
    std::map<Index, model::Set> outer_skins{};  ///< by body: outer surfaces likewise, for general contact

    [[nodiscard]] Index body_index(const std::string& name) const;
    std::map<std::string, LoadSpread> spreads{}; ///< of couplings that distribute loads

    /// Of the name of a rigid body or a coupling of kind rigid.
    [[nodiscard]] const model::RigidBody& rigid(const std::string& name) const;
    [[nodiscard]] const model::Set& set(const std::string& name) const;
    /// A set as contact sees it.
    [[nodiscard]] const model::Set& contact_set(const std::string& name) const {
        const auto skin = skins.find(name);
        return skin != skins.end() ? skin->second : set(name);
    }
    /// Faces of a set, global nodes.
    [[nodiscard]] std::vector<mesh::SurfaceFace> faces(const model::Set& set) const;
    template <class Is> [[nodiscard]] bool any_kernel(Is&& is) const {
        return std::ranges::any_of(plan.model.bodies, [&](const model::Body& body) {
            return std::ranges::any_of(body.kernels, [&](const auto& kernel) { return is(*kernel); });
        });
    }
    /// Whether accepted steps are audited: a body alone that is deformed little meets nothing, not even itself.
    [[nodiscard]] bool audited() const;
};

/// Bodies with their kernels, far from the scene's origin moved near to zero.
void add_bodies(Draft& draft, std::vector<mesh::Mesh> meshes);
void add_sets(Draft& draft);
/// Elements without a positive volume, also where only their shape functions show it. @param origin  of the mesh's coordinates
[[nodiscard]] std::vector<std::string> mesh_faults(const mesh::Mesh& mesh, const Vec3& origin);
/// Nodes of sets with imperfections, moved by them.
void move_imperfect_sets(Draft& draft);
/// Whether nodes are as far as their imperfections say from where they would be without any.
/// @param plain  the same draft without imperfections
void check_imperfect_sets(Draft& draft, const Draft& plain);
/// Couplings, with the two nodes of each behind those of all bodies.
void add_couplings(Draft& draft);
/// Ties, with their nodes moved onto the surfaces that they follow.
void add_ties(Draft& draft);
/// Sectors that stand for rings, with the nodes at one end moved onto the turned places of their likes at the other.
void add_cyclic_symmetry(Draft& draft);
/// Nodes that equations lead: each gives one direction of one node, along which no stage holds or drives it.
void add_equations(Draft& draft);
/// Whether supports and motions are alike at both ends of every sector, in every stage.
void check_sectors(Draft& draft);
/// Directions that x, y and z mean for a node, in columns. @param support  of the set that names them; null: none
[[nodiscard]] Mat3 axes_at(const Draft& draft, const scene::Support* support, Index node);
/// Projectors on the directions that supports leave free, of nodes that have any.
[[nodiscard]] std::map<Index, Mat3> free_directions(const Draft& draft);
/// Slave nodes of pairs that ask for it, moved onto the master.
void adjust_slaves(Draft& draft);
/// Pairs whose friction stages change, or which they put out of force.
void add_changes_of_pairs(Draft& draft);
/// Skins of all surfaces in contact whose faces have midside nodes, with their nodes behind all others.
void add_skins(Draft& draft);
/// Held directions of every stage, and external forces at its ends but for gravity.
void add_stages(Draft& draft);
/// Contact pairs of the scene.
void add_pairs(Draft& draft);
/// General contact, and the pairs that it finds at the start.
void add_general_contact(Draft& draft);
void check_gaps(Draft& draft);
/// Stiffness, mass and initial velocities as far as a stage needs them, and weight.
void add_matrices(Draft& draft);

} // namespace osculate::app
