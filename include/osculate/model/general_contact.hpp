#pragma once
/// General contact: which parts of the bodies' outer surfaces may meet, and as what, from the geometry of the moment.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/core/field.hpp"
#include "osculate/model/contact_pair.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osculate::model {

/// A node that an audit has found in or next to another body, and the surface of that body: the node is a slave of it whatever
/// its role, and may touch any of its facets.
struct WatchedNode {
    Index node = -1, surface = -1;

    auto operator<=>(const WatchedNode&) const = default;
};

/// Facets of two surfaces, by their numbers over all surfaces, of which one is behind the other.
struct PassedFacets {
    double between = 0; ///< least distance between them, m; they may overlap if it is negative
    Index one = -1, other = -1;

    auto operator<=>(const PassedFacets&) const = default;
};

/// Where pairs of general contact were looked for, and how long they are all there are.
struct ContactScope {
    Field x;                    ///< (nodes) positions, m
    std::vector<double> margin; ///< (surfaces) how far nodes of each may move before others could meet, m
    std::vector<double> own; ///< (surfaces) how far they may move against their mean before the surface meets itself, m
    std::vector<WatchedNode> watched{}; ///< ascending
    /// Facets within the margins that turned to each other but are not in front of each other there: as soon as they are, there
    /// may be more pairs. Ascending. It follows from the other members, see GeneralContact::passed().
    std::vector<PassedFacets> passed{};
};

/// The outer surface of a body, as far as it takes part.
struct OuterSurface {
    Index body = -1;
    std::string name;                       ///< of the body
    std::vector<mesh::Facet> facets;        ///< global nodes, outward
    std::shared_ptr<const MasterSide> side; ///< through these facets and their mirror images
    bool smooth = false;                    ///< the side is smooth, not its facets
    double E = 0;                           ///< Young's modulus, Pa
    std::map<Index, Mat3> in_plane{};       ///< projectors of its nodes on the symmetry planes they lie on
    std::map<Index, Index> skin{}; ///< nodes of its skin by those of elements that they stand for; empty: it has none
};

struct GeneralContactOptions {
    ContactOptions pair;                           ///< of every pair but for the friction
    Matrix friction;                               ///< (surfaces x surfaces) Coulomb's coefficients, symmetric
    Matrix static_friction;                        ///< the same, where nodes do not slide; empty: none differs
    std::vector<std::pair<Index, Index>> left_out; ///< surfaces that do not meet, the lower first
    double stiffness_scale = 1;
    /// Nodes and the nodes that they do not meet, both ascending: surfaces that pairs of the scene's own treat.
    std::vector<std::pair<std::vector<Index>, std::vector<Index>>> treated_elsewhere;
};

/// All outer surfaces may meet. For positions of the nodes, near() finds the facets that are near each other and face each
/// other, chooses a slave for every two of them, and makes a pair of every two surfaces: slave nodes of one against the
/// surface of the other. A surface has the role of the slave where its facets are softer or finer than the nearest of the
/// other; of two that are alike, the one of the first body has it. So no two facets are treated twice.
///
/// A surface may meet itself where two facets face each other that are not near along the surface. There the side that holds
/// the lowest number is the slave, or what was the slave before.
class GeneralContact {
public:
    GeneralContact(std::vector<OuterSurface> surfaces, GeneralContactOptions options, const std::vector<Vec3>& X);

    /// Where to look for pairs: from positions x on, for motions that a few steps make.
    /// @param expected  largest motion of a node that the next step may make, m
    /// @param watched  ascending; near() keeps those that are still near their surface
    [[nodiscard]] ContactScope scope_at(const Field& x, double expected, std::vector<WatchedNode> watched = {}) const;
    /// Whether pairs found for a scope are all that may touch at positions x, and after nodes have moved on by `ahead`, m, as
    /// far as margins tell.
    [[nodiscard]] bool covers(const ContactScope& scope, const Field& x, double ahead = 0) const;
    /// Whether facets that were not in front of each other are so at x, and could touch after nodes have moved on by `ahead`, m.
    [[nodiscard]] bool comes_round(const ContactScope& scope, const Field& x, double ahead) const;
    /// Facets that a scope with these positions and margins has passed over.
    [[nodiscard]] std::vector<PassedFacets> passed(const ContactScope& scope) const;
    /// The pairs for a scope with their histories: those of `before` where a slave node is in the same pair as there, which
    /// it is if it is closed. Sets `watched` and `passed` of the scope.
    /// @param before  of pairs found earlier
    [[nodiscard]] std::vector<ContactHistory> near(ContactScope& scope,
                                                   const std::vector<ContactHistory>& before) const;

    /// Nodes to watch after an audit besides those that are watched: of every node, edge or facet that is more than touching
    /// inside another body, and of the facet through which it went. Empty: no others.
    /// @returns all, ascending
    [[nodiscard]] std::vector<WatchedNode> watched(const std::vector<WatchedNode>& now,
                                                   const std::vector<contact::IntrudedPlace>& places) const;
    [[nodiscard]] const std::vector<OuterSurface>& surfaces() const { return surfaces_; }
    [[nodiscard]] const GeneralContactOptions& options() const { return options_; }
    /// Whether two bodies may meet; and whether they are said not to.
    [[nodiscard]] bool meet(Index body, Index other) const;
    [[nodiscard]] bool pass_through(Index body, Index other) const;
    /// Nodes that are slaves in some pair, as far as sizes and stiffness tell, ascending.
    [[nodiscard]] std::vector<Index> possible_slaves() const;
    /// A pair of two surfaces, or of one and itself.
    /// @param nodes, facets  of the slave; the nodes of the facets and perhaps others, ascending
    /// @param yielding  those of the nodes that yield, ascending
    [[nodiscard]] std::shared_ptr<const ContactPair> make_pair(const ContactScope& scope, Index slave, Index master,
                                                               const std::vector<Index>& nodes,
                                                               std::vector<mesh::Facet> facets,
                                                               const std::vector<Index>& yielding) const;
    /// A pair of edges of two surfaces.
    /// @param edges  half-edges of the slave's and of the master's surface, ascending
    [[nodiscard]] std::shared_ptr<const ContactPair> make_edges(const ContactScope& scope, Index slave, Index master,
                                                                const std::vector<std::array<Index, 2>>& edges) const;
    /// Whether two pairs of general contact are the same in all that they were made of.
    [[nodiscard]] static bool alike(const ContactPair& one, const ContactPair& other);
    /// Nodes of the master of a pair that its slaves may come to while the scope lasts, and those of the patches there, global,
    /// ascending.
    [[nodiscard]] std::vector<Index> reachable(const ContactScope& scope, const ContactPair& pair) const;
    /// Surfaces of a pair that near() or make_pair() has made: slave and master.
    [[nodiscard]] std::pair<Index, Index> sides_of(const ContactPair& pair) const;

private:
    /// A convex edge of a surface.
    struct ConvexEdge {
        Index surface = -1, half_edge = -1;
        bool own = true;    ///< not the image of one
        bool sharp = false; ///< a feature edge
        bool blunt = true;  ///< sharp enough to meet these; others meet only what is watched
    };
    struct Facet {
        Index surface = -1;
        double size = 0; ///< root of its area in the reference configuration, m
    };
    /// Facets and further nodes that are slaves in one pair.
    struct Found {
        std::vector<Index> facets; ///< numbers over all surfaces
        std::vector<Index> nodes;
        std::vector<Index> yielding; ///< nodes of sharp edges of what is otherwise the master
    };
    using FacetPairs = std::vector<std::pair<Index, Index>>;
    /// A facet meets another if it is not farther behind its plane than this, in sizes of the smaller one.
    static constexpr double behind = 0.5;
    /// Facets at positions x.
    struct FacetPlaces {
        std::vector<Vec3> normal, centre;
        std::vector<double> radius; ///< of a sphere about the centre, m
    };
    [[nodiscard]] FacetPlaces places(const std::vector<Vec3>& x) const;
    /// How far facet f is from being in front of g, m, whose normal and centre these are.
    [[nodiscard]] double missing(Index f, Index g, const Vec3& normal, const Vec3& centre,
                                 const std::vector<Vec3>& x) const;
    /// Facets that are near each other for a scope, ascending.
    [[nodiscard]] FacetPairs near_pairs(const ContactScope& scope, const FacetPlaces& at) const;
    [[nodiscard]] std::vector<PassedFacets> passed(const ContactScope& scope, const FacetPlaces& at,
                                                   const FacetPairs& near) const;
    /// For every vertex of a surface its facets that are near along the surface, ascending.
    [[nodiscard]] std::vector<std::vector<Index>> neighbourhoods(const OuterSurface& surface) const;
    /// Whether facets of one surface are near each other along it.
    [[nodiscard]] bool are_neighbours(Index f, Index g) const;
    /// Roles of all facets against others of their own surface; empty if none has one. Connected parts have one role.
    /// @param facing  pairs of facets of one surface  @param before  as in near()
    enum class Role : char { slave, none, master };
    [[nodiscard]] std::vector<Role> roles_within(const FacetPairs& facing,
                                                 const std::vector<ContactHistory>& before) const;
    void find_convex_edges();
    /// Whether a node at an end of an edge is watched against a surface.
    [[nodiscard]] bool is_watched(const std::vector<WatchedNode>& watched, const ConvexEdge& edge, Index surface) const;
    /// Adds the pairs of edges for a scope, see near().
    void add_edges(const ContactScope& scope, const std::vector<ContactHistory>& before,
                   std::vector<ContactHistory>& histories) const;
    /// Number of the surface of a body, that of the surfaces if it has none.
    [[nodiscard]] std::size_t surface_of_body(Index body) const;
    [[nodiscard]] bool may_meet(Index f, Index g) const;
    /// Whether a pair of the scene's own treats these nodes against those.
    template <class Some, class Others> [[nodiscard]] bool is_treated(const Some& some, const Others& others) const;
    /// Whether facet f is the slave of two facets that meet.
    [[nodiscard]] bool is_slave(Index f, Index g) const;

    std::vector<OuterSurface> surfaces_;
    GeneralContactOptions options_;
    std::vector<Vec3> X_;             ///< (nodes) reference positions, m
    std::vector<mesh::Facet> facets_; ///< of all surfaces, one after another
    std::vector<Facet> data_;         ///< of each
    std::vector<Index> surface_of_;   ///< (nodes) -1: of none
    std::vector<std::vector<Index>> node_facets_,
        along_;                  ///< (nodes) facets that meet there; nodes at other ends of edges
    std::vector<char> left_out_; ///< (surfaces x surfaces)
    std::vector<ConvexEdge> convex_edges_;
    std::vector<char> sharp_;      ///< (nodes) on such an edge
    std::vector<double> diagonal_; ///< (surfaces) of the box of the reference configuration, m
    std::vector<Index> first_;     ///< (surfaces) number of the first facet
    /// (nodes) facets of the own surface that are near along it, numbers within the surface, ascending
    std::vector<std::vector<Index>> around_;
    std::vector<std::vector<char>>
        treated_; ///< (pairs treated elsewhere) nodes: 1 of one side, 2 of the other, 3 of both
};

} // namespace osculate::model
