#pragma once
/// The master surface as contact sees it: the facets themselves, or a smooth surface through their nodes.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/radial_basis.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/core/choices.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::contact {

struct RpimOptions {
    int ring = 2; ///< rings of facets around the temporary facet that make its domain of influence
    Multiquadric basis;
    int polynomial_terms = 6;
    PatchCoordinates coordinates = PatchCoordinates::equal_length;
};

/// A patch that was fitted anew, by what it was fitted to.
struct RefittedPatch {
    Index patch = -1;
    std::vector<Vec3> at; ///< vertices around it, in an order of the surface's own, m
};

/// What a surface keeps of one set of vertex positions, see MasterSurface::place().
struct Placement {
    virtual ~Placement() = default;
};

/// Fixed once made: what depends on where its vertices are is in a Placement, and a surface fitted anew is another one.
class MasterSurface {
public:
    virtual ~MasterSurface() = default;

    /// Surface vertices that carry the patch of a facet.
    [[nodiscard]] virtual std::span<const Index> patch_vertices(Index facet) const = 0;
    /// Makes ready what the facets of `hits` need at vertices x. evaluate() gives the same without it, but slower.
    /// @param placement  an earlier one of this surface, which is written over, or null
    virtual void place(std::span<const FacetHit> hits, const std::vector<Vec3>& x, int threads,
                       std::unique_ptr<Placement>& placement) const {
        (void)hits, (void)x, (void)threads, (void)placement;
    }
    /// Gap, normal and weights at slave point s above the facet of `hit`, vertices at x; with `variation`, which may be
    /// null, their first variations too. point.found is false where there is no contact partner: beyond the boundary, or
    /// no unique foot.
    /// @param placement  of place(), or null; the point may refer to it
    virtual void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                          ContactVariation* variation = nullptr, const Placement* placement = nullptr) const = 0;
    /// First variations at a point that evaluate() gave with the same s, hit and x; the placement it had must be as it was.
    virtual void vary(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, const ContactPoint& point,
                      ContactVariation& variation) const {
        (void)point;
        ContactPoint again;
        evaluate(s, hit, x, again, &variation);
    }
    /// Whether a slave point between two facets that share a vertex may see another gap above one than above the other. Points
    /// that go to and fro between such facets are latched to one of them.
    [[nodiscard]] virtual bool tells_apart(Index from, Index to) const {
        (void)from, (void)to;
        return true;
    }
    /// Whether refitted() may ever be another surface.
    [[nodiscard]] virtual bool refits() const { return false; }
    /// This surface with patches fitted anew at converged positions x where it has been bent by more than 60 degrees within
    /// one, so that its frozen coordinates have become misleading; null where no patch has.
    [[nodiscard]] virtual std::shared_ptr<const MasterSurface> refitted(const std::vector<Vec3>& x) const {
        (void)x;
        return nullptr;
    }
    /// Patches fitted anew since the surface was made, ascending; and, of a surface as it was made, the one with these fitted.
    /// Null where one is no patch of this surface, or none fits.
    [[nodiscard]] virtual std::vector<RefittedPatch> refitted_patches() const { return {}; }
    [[nodiscard]] virtual std::shared_ptr<const MasterSurface>
    refitted(const std::vector<RefittedPatch>& patches) const {
        (void)patches;
        return nullptr;
    }
    /// How often a patch has been fitted anew.
    [[nodiscard]] virtual Index refits_done() const { return 0; }
    /// Facets that had to fall back to a smaller or simpler patch.
    [[nodiscard]] virtual Index fallbacks() const { return 0; }
};

/// The finite element surface as it is, each facet extended past its edges.
[[nodiscard]] std::unique_ptr<MasterSurface> make_facets_surface(const mesh::HalfEdgeSurface& surface);

struct BlendOptions {
    int level = 2; ///< rings of facets around a vertex that make its patch
    Multiquadric basis;
    int polynomial_terms = 6;
    PatchCoordinates coordinates = PatchCoordinates::equal_length;
};

/// Frozen RPIM patch of one vertex (one per smooth sector where feature edges meet) and its bump in the blend.
struct VertexPatchInfo {
    Index vertex = -1;
    int level = 0;
    double kappa = 0;           ///< tau = kappa u^T M u
    Mat2 metric = Mat2::Zero(); ///< M, m^-2
    std::vector<Index> vertices;
};

/// Vertex gap blend: gaps to the patches of all vertices near the slave point, blended with C2 bumps,
///     g = sum_v psi_v g_v / sum_v psi_v,   psi_v = (1 - tau_v)^3_+,   n = grad_s g / |grad_s g|.
/// Nothing in it depends on which facet is the closest, so gap, normal and forces run on smoothly over all edges.
[[nodiscard]] std::unique_ptr<MasterSurface>
make_blend_surface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const BlendOptions& options);
/// The patches make_blend_surface() would use.
[[nodiscard]] std::vector<VertexPatchInfo> vertex_patches(const mesh::HalfEdgeSurface& surface,
                                                          const std::vector<Vec3>& X, const BlendOptions& options);

/// One frozen RPIM patch per facet, fitted at the reference positions X.         [Qian 2014, secs 3.1-3.2]
/// A patch that would overlap itself in its plane (Fig. 5d) or is rank deficient takes one ring less, at last the facet.
[[nodiscard]] std::unique_ptr<MasterSurface> make_rpim_surface(const mesh::HalfEdgeSurface& surface,
                                                               const std::vector<Vec3>& X, const RpimOptions& options);

} // namespace osculate::contact
