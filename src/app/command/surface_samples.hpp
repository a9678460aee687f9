#pragma once
/// Points of a master surface, sampled facet by facet.

#include "osculate/contact/master_surface.hpp"

namespace osculate::app {

/// Regular grid of sample points on one facet, N intervals along every edge.
class FacetGrid {
public:
    /// @param corners 3 or 4
    FacetGrid(int corners, int N);
    [[nodiscard]] Index size() const { return static_cast<Index>(points_.size()); }
    [[nodiscard]] const std::vector<Vec2>& points() const { return points_; } ///< natural coordinates, as in FacetPatch
    [[nodiscard]] const std::vector<mesh::Facet>& cells() const { return cells_; }
    /// Point k = 0 .. N of the edge from corner `edge` to the next.
    [[nodiscard]] Index on_edge(int edge, int k) const;

private:
    [[nodiscard]] Index at(int i, int j) const;
    int corners_, N_;
    std::vector<Vec2> points_;
    std::vector<mesh::Facet> cells_;
};

/// What the solver sees at one point of a master surface.
struct SurfaceSample {
    Vec3 position = Vec3::Zero(); ///< on the surface; on the facet where not found
    Vec3 normal = Vec3::Zero();   ///< out of the master
    double mean_curvature = 0;    ///< 1/m; > 0 where the master bulges
    double gauss_curvature = 0;   ///< 1/m^2
    double distance = 0;          ///< from the facet to the surface, m; > 0 out of the master
    Index nodes = 0;              ///< that take part
    bool found = false;
};

struct SurfaceSamples {
    FacetGrid triangle, quadrilateral;
    std::vector<Index> first;           ///< (facets + 1) number of each facet's first point
    std::vector<SurfaceSample> samples; ///< facet by facet

    [[nodiscard]] const FacetGrid& grid(Index corners) const { return corners == 3 ? triangle : quadrilateral; }
};

/// Samples every facet on a grid. A sample is reached from its point of the facet by s <- s - g n until g vanishes.
/// @param x  positions of the surface's vertices  @param N  intervals along every edge of a facet
[[nodiscard]] SurfaceSamples sample_surface(const mesh::HalfEdgeSurface& surface, const contact::MasterSurface& master,
                                            const std::vector<Vec3>& x, int N, int threads);

} // namespace osculate::app
