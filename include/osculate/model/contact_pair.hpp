#pragma once
/// One contact pair: slave nodes, or the slave facets around them, against a master surface. Only data that is fixed
/// for a run.

#include "osculate/contact/coulomb.hpp"
#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/core/choices.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <string>
#include <vector>

namespace osculate::contact {
struct SmoothSlave;
}

namespace osculate::model {

/// Data that a pair keeps from one accepted step to the next.
struct ContactHistory {
    std::vector<Vec3> lambda;            ///< (slaves) contact force on each slave node, N, global components
    std::vector<contact::Status> status; ///< (slaves)
    std::vector<Index> facet;            ///< (slaves) temporary facet, -1: not searched yet
    std::shared_ptr<const contact::MasterSurface> master; ///< with all patches refitted so far; never null
};

/// Slave nodes of a pair and the data of each node.
struct SlaveNodes {
    std::vector<Index> node;         ///< global
    std::vector<double> area;        ///< tributary area in the reference configuration, m^2
    std::vector<double> stiffness;   ///< c of the complementarity function, N/m
    std::vector<mesh::Facet> facets; ///< slave surface, global nodes
    std::vector<Mat3> in_plane{};    ///< projectors on the symmetry planes of each node; empty: no such planes
};

/// Vertices of a master surface: nodes, or mirror images of nodes.
struct MasterNodes {
    std::vector<Index> node;    ///< (vertices) global
    std::vector<Index> image{}; ///< (vertices) index into images; empty: every vertex is its node
    std::vector<contact::Image> images{contact::Image{}};
    std::vector<double> thickness{}; ///< (vertices) thickness of the body behind, m; empty: not needed
};

struct ContactOptions {
    double friction = 0;      ///< Coulomb's mu
    double hysteresis = 0.03; ///< of the facet size, see contact::FacetSearch::track
    int changes_before_latch =
        4; ///< facet changes of a node in one attempt after which it keeps its facet: it is on an edge
    double closing_tolerance = 0.02; ///< of the facet size: largest distance that counts as touching before any contact
    Discretisation discretisation = Discretisation::node;
};

class ContactPair {
public:
    /// @param X             reference positions of all nodes
    /// @param master_nodes  what the vertices of `surface` are
    /// @param smooth        for mortar: surface through the slave nodes, which are nodes of its vertices; null: their
    ///                      facets
    ContactPair(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                std::unique_ptr<mesh::HalfEdgeSurface> surface, MasterNodes master_nodes,
                std::shared_ptr<const contact::MasterSurface> master, const ContactOptions& options,
                const contact::SmoothSlave* smooth = nullptr);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] Index size() const { return static_cast<Index>(slaves_.node.size()); }
    [[nodiscard]] const SlaveNodes& slaves() const { return slaves_; }
    [[nodiscard]] const mesh::HalfEdgeSurface& surface() const { return *surface_; }
    /// The initial master surface; that of a state is in ContactHistory::master.
    [[nodiscard]] const std::shared_ptr<const contact::MasterSurface>& master() const { return master_; }
    [[nodiscard]] const std::vector<Index>& master_nodes() const { return master_nodes_.node; }
    [[nodiscard]] const ContactOptions& options() const { return options_; }
    /// The discretisation to clone; evaluate only the clone.
    [[nodiscard]] const contact::Discretisation& discretisation() const { return *discretisation_; }
    /// The search to copy; build only the copy.
    [[nodiscard]] const contact::FacetSearch& search() const { return search_; }
    /// Least thickness of the body behind a facet's vertices, m; infinite if none was given.
    [[nodiscard]] double thickness(Index facet) const;
    /// The smallest of all facet sizes and thicknesses, m: for motions well below it, the side of a node is
    /// unambiguous.
    [[nodiscard]] double finest() const { return finest_; }
    /// Positions of the master's vertices, including mirror images.
    [[nodiscard]] std::vector<Vec3> vertices(const std::vector<Vec3>& x) const;
    /// The image of a vertex.
    [[nodiscard]] const contact::Image& image_of(Index vertex) const {
        return master_nodes_.images[master_nodes_.image.empty() ? 0 : master_nodes_.image[vertex]];
    }
    /// Whether the master has mirror images: forces on them fold back onto its nodes.
    [[nodiscard]] bool mirrored() const { return !master_nodes_.image.empty(); }
    /// The vertex that is the node itself, if `vertex` is an image of this node.
    [[nodiscard]] Index own_vertex(Index vertex) const { return own_vertex_.empty() ? vertex : own_vertex_[vertex]; }
    /// Linear part of the image; the unit matrix for numbers from surface().vertex_count() on, which are slave nodes.
    [[nodiscard]] const Mat3& image(Index vertex) const {
        return vertex < surface_->vertex_count() ? image_of(vertex).M : master_nodes_.images.front().M;
    }
    /// Global node of a vertex, or of a slave node in the numbering of Mortar.
    [[nodiscard]] Index node(Index vertex) const {
        return vertex < surface_->vertex_count() ? master_nodes_.node[vertex]
                                                 : slaves_.node[vertex - surface_->vertex_count()];
    }
    [[nodiscard]] ContactHistory initial_history() const;

private:
    std::string name_;
    SlaveNodes slaves_;
    std::unique_ptr<mesh::HalfEdgeSurface> surface_;
    MasterNodes master_nodes_;
    std::vector<Index> own_vertex_; ///< (vertices) empty without images
    std::shared_ptr<const contact::MasterSurface> master_;
    contact::FacetSearch search_;
    ContactOptions options_;
    std::unique_ptr<const contact::Discretisation> discretisation_;
    double finest_ = 0;
};

} // namespace osculate::model
