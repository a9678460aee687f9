#pragma once
/// One contact pair: slave nodes, or the slave facets around them, against a master surface. Only data that is fixed
/// for a run.

#include "osculate/contact/coulomb.hpp"
#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/edge_crossing.hpp"
#include "osculate/contact/overclosure.hpp"
#include "osculate/core/choices.hpp"
#include "osculate/model/master_side.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osculate::contact {
struct SmoothSlave;
}

namespace osculate::model {

class ContactPair;

/// Data that a pair keeps from one accepted step to the next.
struct ContactHistory {
    std::shared_ptr<const ContactPair> pair; ///< never null in a state
    std::vector<Vec3> lambda;                ///< (slaves) contact force on each slave node, N, global components
    std::vector<contact::Status> status;     ///< (slaves)
    std::vector<Index> facet;                ///< (slaves) temporary facet, -1: not searched yet
    std::shared_ptr<const contact::MasterSurface> master; ///< with all patches refitted so far; never null
    /// (slaves) Whether a node slid when it last touched: 1, or 0 where it stuck or has not touched yet. Empty: static friction is
    /// no larger than kinetic.
    std::vector<char> slides{};
};

/// What a surface needs to touch itself: parts of it that face each other and are not neighbours.
struct OwnSurface {
    /// (slaves) facets of the surface that are near the node along the surface, ascending: it does not touch them.
    std::vector<std::vector<Index>> around;
    double reach = 0; ///< how far facets are looked for, m
};

/// Slaves that are edges: each begins in a slave node, which stands for it.
struct CrossingEdges {
    std::vector<std::array<Index, 2>> half_edges; ///< (slaves) of the slave's and of the master's surface
    std::vector<contact::EdgesThatMeet> meet;     ///< (slaves)
    std::vector<Index> others;                    ///< further nodes, global; their numbers follow those of the slaves
};

/// Slave nodes of a pair and the data of each node.
struct SlaveNodes {
    std::vector<Index> node;         ///< global
    std::vector<double> area;        ///< tributary area in the reference configuration, m^2
    std::vector<double> stiffness;   ///< c of the complementarity function, N/m
    std::vector<mesh::Facet> facets; ///< slave surface, global nodes
    std::vector<Mat3> in_plane{};    ///< projectors on the symmetry planes of each node; empty: no such planes
    /// Nodes at the other ends of the edges that meet in each node, global: a node touches only what it points at, what no
    /// such edge goes into at more than 25 degrees. Empty: it touches whatever it is above.
    std::vector<std::vector<Index>> along{};
    /// Outer facets that meet at each node, global: a node touches only facets that one of these faces at the start of an
    /// attempt, and for it the master ends where they do. Empty: it touches whatever it is above.
    std::vector<std::vector<mesh::Facet>> around{};
    /// Sides of the scene's own pairs that each slave is on, and the sides opposite to those that each master facet is on: a
    /// slave touches no facet with which it has one in common. Empty: none.
    std::vector<std::vector<Index>> treated{}, facet_treated{};
    std::optional<OwnSurface> own{}; ///< where slave and master are one surface
    /// Which slave nodes yield a little, see contact::Coulomb: others may hold the same place. Empty: none does.
    std::vector<char> yields{};
    /// Which slave nodes may touch any facet of the master, whatever they point at or face. Empty: none.
    std::vector<char> watched{};
    std::optional<CrossingEdges> edges{}; ///< where the slaves are edges
};

struct ContactOptions {
    double friction = 0;                               ///< Coulomb's mu
    double static_friction = 0;                        ///< mu of nodes that do not slide; counts if it is larger
    std::optional<contact::Overclosure> overclosure{}; ///< law of the pressure; none: contact is exact
    double damping = 0; ///< pressure over the speed at which surfaces close, in dynamics, Pa s/m; with an overclosure
    double tangential_damping = 0; ///< traction against sliding over its speed, in dynamics, Pa s/m
    double stick_stiffness = 0;    ///< friction over elastic slip, Pa/m; 0: stick is exact
    double hysteresis = 0.03;      ///< of the facet size, see contact::FacetSearch::track
    int changes_before_latch =
        4; ///< facet changes of a node in one attempt after which it keeps its facet: it is on an edge
    double closing_tolerance = 0.02; ///< of the facet size: largest distance that counts as touching before any contact
    Discretisation discretisation = Discretisation::node;
    bool in_force = true; ///< false: no slave finds a facet
    [[nodiscard]] bool rubs() const { return friction > 0 || tangential_damping > 0; }
    bool operator==(const ContactOptions&) const = default;
};

class ContactPair {
public:
    /// @param X             reference positions of all nodes
    /// @param smooth        for mortar: surface through the slave nodes, which are nodes of its vertices; null: their
    ///                      facets
    ContactPair(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                std::shared_ptr<const MasterSide> master_side, const ContactOptions& options,
                const contact::SmoothSlave* smooth = nullptr);
    /// With a master of its own.
    /// @param master_nodes  what the vertices of `surface` are
    ContactPair(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                std::unique_ptr<mesh::HalfEdgeSurface> surface, MasterNodes master_nodes,
                std::shared_ptr<const contact::MasterSurface> master, const ContactOptions& options,
                const contact::SmoothSlave* smooth = nullptr);
    /// Another pair but for what the law of contact takes from the options: friction, overclosure, and whether it is in force.
    ContactPair(const ContactPair& other, const ContactOptions& options);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] Index size() const { return static_cast<Index>(slaves_.node.size()); }
    [[nodiscard]] const SlaveNodes& slaves() const { return slaves_; }
    [[nodiscard]] const MasterSide& master_side() const { return *side_; }
    [[nodiscard]] const mesh::HalfEdgeSurface& surface() const { return side_->surface(); }
    /// The initial master surface; that of a state is in ContactHistory::master.
    [[nodiscard]] const std::shared_ptr<const contact::MasterSurface>& master() const { return side_->shape(); }
    [[nodiscard]] const std::vector<Index>& master_nodes() const { return side_->nodes(); }
    [[nodiscard]] const ContactOptions& options() const { return options_; }
    /// The discretisation to clone; evaluate only the clone.
    [[nodiscard]] const contact::Discretisation& discretisation() const { return *discretisation_; }
    /// The search to copy; build only the copy.
    [[nodiscard]] const contact::FacetSearch& search() const { return search_; }
    /// See MasterSide.
    [[nodiscard]] double thickness(Index facet) const { return side_->thickness(facet); }
    /// For motions well below it, the side of a node is unambiguous.
    [[nodiscard]] double finest() const { return side_->finest(); }
    [[nodiscard]] std::vector<Vec3> vertices(const std::vector<Vec3>& x) const { return side_->vertices(x); }
    [[nodiscard]] const contact::Image& image_of(Index vertex) const { return side_->image_of(vertex); }
    [[nodiscard]] bool mirrored() const { return side_->mirrored(); }
    [[nodiscard]] Index own_vertex(Index vertex) const { return side_->own_vertex(vertex); }
    /// Linear part of the image; the unit matrix for numbers from surface().vertex_count() on, which are slave nodes.
    [[nodiscard]] const Mat3& image(Index vertex) const {
        static const contact::Image none{};
        return vertex < surface().vertex_count() ? image_of(vertex).M : none.M;
    }
    /// Global node of a vertex, or of a slave node, or another one of the slave's, in the numbering of Mortar and CrossingEdges.
    [[nodiscard]] Index node(Index vertex) const {
        const Index number = vertex - surface().vertex_count();
        if (number < 0) return master_nodes()[vertex];
        return number < size() ? slaves_.node[number] : slaves_.edges->others[number - size()];
    }
    /// Where slaves are edges: the edge of slave j, and the master's that it may touch.
    /// @param vertices  see vertices(), at x
    [[nodiscard]] std::pair<contact::SharpEdge, contact::SharpEdge> edges(Index j, const std::vector<Vec3>& x,
                                                                          const std::vector<Vec3>& vertices) const;
    /// Nothing has touched yet; without the pair itself, see opened().
    [[nodiscard]] ContactHistory initial_history() const;

private:
    std::string name_;
    SlaveNodes slaves_;
    std::shared_ptr<const MasterSide> side_;
    contact::FacetSearch search_;
    ContactOptions options_;
    std::unique_ptr<const contact::Discretisation> discretisation_;
};

/// Pairs that are in force at the same time.
using ContactPairs = std::vector<std::shared_ptr<const ContactPair>>;

/// History of a pair that has touched nothing yet.
[[nodiscard]] ContactHistory opened(std::shared_ptr<const ContactPair> pair);

} // namespace osculate::model
