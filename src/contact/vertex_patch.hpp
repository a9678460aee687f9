#pragma once
/// Frozen patches around the vertices of a surface, and their bumps.

#include "merge.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/rpim_patch.hpp"

#include <map>
#include <vector>

namespace osculate::contact {

/// Patch of one vertex, or of one smooth sector of it where feature edges meet there.
struct VertexPatch {
    Index vertex = -1;
    int level = 0;
    std::vector<Index> vertices; ///< of the patch, ascending
    RpimPatch shape;
    Mat2 metric = Mat2::Identity(); ///< M = 1/2 (mean over edge neighbours of u_j u_j^T)^-1, m^-2
    double kappa = 0.8;
    Vec2 origin = Vec2::Zero();        ///< natural coordinates of the vertex
    std::vector<Index> sector, facets; ///< around the vertex, and all whose corners make the patch
    std::vector<double> turn;          ///< (facets) angle of each to the vertex normal where the patch was fitted, rad
};

/// Facets around a vertex that hang together over smooth edges, each sector ascending.
[[nodiscard]] std::vector<std::vector<Index>> sectors(const mesh::HalfEdgeSurface& surface, Index vertex);

/// All patches of a surface, and which of them each facet may need. Near-duplicate vertices are merged first: the one that
/// is kept has a patch, and the patches do not pass through the others.
struct VertexPatches {
    std::vector<VertexPatch> patches;
    std::vector<std::vector<Index>> of_facet; ///< patches of the vertices of a facet's 2-ring, ascending
    std::vector<char> bare;                   ///< per facet, whether one of its vertices has no patch on its side
    std::shared_ptr<const std::vector<double>> numbers; ///< of the shapes as first fitted
    Index fallbacks = 0; ///< vertices merged, without a patch, or with a smaller or simpler one than asked for

    VertexPatches(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const BlendOptions& options);
    /// Patches one of whose facets has turned against the vertex by more than 60 degrees since the last fit, vertices at x:
    /// their natural coordinates no longer tell how far nodes are apart. Ascending.
    [[nodiscard]] std::vector<Index> bent(const std::vector<Vec3>& x) const;
    /// Fits these anew at x; one that x folds over stays as it is. @returns how many
    Index fit(const std::vector<Index>& list, const std::vector<Vec3>& x);
    Index refits = 0; ///< fits anew so far
    /// See MasterSurface. Positions are those of the vertices that a fit looks at, see looked_at().
    [[nodiscard]] std::vector<RefittedPatch> refitted() const;
    [[nodiscard]] bool refit(const std::vector<RefittedPatch>& list);

private:
    /// What patches are made on.
    [[nodiscard]] const mesh::HalfEdgeSurface& topology() const { return merged_ ? merged_->topology : *surface_; }
    /// Vertices of the topology that a fit of a patch may look at, ascending.
    [[nodiscard]] std::vector<Index> looked_at(Index patch) const;
    /// Positions of the topology's vertices, given those of all.
    [[nodiscard]] std::vector<Vec3> kept(const std::vector<Vec3>& x) const;
    /// Number of a vertex in the topology.
    [[nodiscard]] Index own(Index vertex) const;
    /// Fits a patch anew at positions of the topology's vertices. False where none fits: it stays as it was.
    bool fit(Index patch, const std::vector<Vec3>& x);

    const mesh::HalfEdgeSurface* surface_;
    std::shared_ptr<const MergedSurface>
        merged_; ///< what patches are made on, where near-duplicate vertices are merged
    BlendOptions options_;
    std::map<Index, std::vector<Vec3>> fitted_at_; ///< (looked_at) of the patches fitted anew, at their last fit
};

} // namespace osculate::contact
