#pragma once
/// The master surface of contact pairs: its vertices, its shape, and the search on it. Pairs with the same master share it.

#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <vector>

namespace osculate::model {

/// Vertices of a master surface: nodes, or mirror images of nodes.
struct MasterNodes {
    std::vector<Index> node;    ///< (vertices) global
    std::vector<Index> image{}; ///< (vertices) index into images; empty: every vertex is its node
    std::vector<contact::Image> images{contact::Image{}};
    std::vector<double> thickness{}; ///< (vertices) thickness of the body behind, m; empty: not needed
};

class MasterSide {
public:
    /// @param shape  on `surface`
    MasterSide(std::unique_ptr<const mesh::HalfEdgeSurface> surface, MasterNodes nodes,
               std::shared_ptr<const contact::MasterSurface> shape);

    [[nodiscard]] const mesh::HalfEdgeSurface& surface() const { return *surface_; }
    /// The surface as first made; that of a state is in ContactHistory::master.
    [[nodiscard]] const std::shared_ptr<const contact::MasterSurface>& shape() const { return shape_; }
    [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_.node; }
    /// A search without rules for ties.
    [[nodiscard]] const contact::FacetSearch& search() const { return search_; }
    /// Least thickness of the body behind a facet's vertices, m; infinite if none was given.
    [[nodiscard]] double thickness(Index facet) const;
    /// The smallest of all facet sizes and thicknesses, m.
    [[nodiscard]] double finest() const { return finest_; }
    /// Positions of the vertices, including mirror images, for positions of all nodes.
    [[nodiscard]] std::vector<Vec3> vertices(const std::vector<Vec3>& x) const;
    /// The image of a vertex.
    [[nodiscard]] const contact::Image& image_of(Index vertex) const {
        return nodes_.images[nodes_.image.empty() ? 0 : nodes_.image[vertex]];
    }
    /// Whether there are mirror images: forces on them fold back onto their nodes.
    [[nodiscard]] bool mirrored() const { return !nodes_.image.empty(); }
    /// The vertex that is the node itself, if `vertex` is an image of this node.
    [[nodiscard]] Index own_vertex(Index vertex) const { return own_vertex_.empty() ? vertex : own_vertex_[vertex]; }

private:
    std::unique_ptr<const mesh::HalfEdgeSurface> surface_;
    MasterNodes nodes_;
    std::vector<Index> own_vertex_; ///< (vertices) empty without images
    std::shared_ptr<const contact::MasterSurface> shape_;
    contact::FacetSearch search_;
    double finest_ = 0;
};

} // namespace osculate::model
