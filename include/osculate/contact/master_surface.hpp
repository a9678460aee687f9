#pragma once
/// The master surface for contact: the facets themselves, or a smooth surface through their nodes.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/radial_basis.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/core/choices.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/shared_pages.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::contact {

struct RpimOptions {
    int ring = 2; ///< rings of facets around the temporary facet that form its domain of influence
    std::optional<Multiquadric> basis = Multiquadric{}; ///< none: basis_for() each patch
    int polynomial_terms = 6;
    PatchCoordinates coordinates = PatchCoordinates::equal_length;
};

/// A refitted patch, with the positions to which it was fitted.
struct RefittedPatch {
    Index patch = -1;
    std::vector<Vec3> at; ///< vertices around it, in the surface's own order, m
};

/// Data that a surface keeps for one set of vertex positions, see MasterSurface::place().
struct Placement {
    virtual ~Placement() = default;
};

/// Immutable: data that depends on the vertex positions is in a Placement, and refitting makes another surface.
class MasterSurface {
public:
    virtual ~MasterSurface() = default;

    /// Surface vertices of the patch of a facet.
    [[nodiscard]] virtual std::span<const Index> patch_vertices(Index facet) const = 0;
    /// Prepares the data for the facets of `hits` with vertices at x. evaluate() gives the same without it, but more
    /// slowly.
    /// @param placement  an earlier one of this surface, which is overwritten, or null
    virtual void place(std::span<const FacetHit> hits, const std::vector<Vec3>& x, int threads,
                       std::unique_ptr<Placement>& placement) const {
        (void)hits, (void)x, (void)threads, (void)placement;
    }
    /// Computes gap, normal and weights at slave point s above the facet of `hit`, vertices at x; also their first
    /// variations unless `variation` is null. point.found is false if there is no contact partner: beyond the boundary,
    /// or no unique foot.
    /// @param placement  of place(), or null; the point may refer to it
    virtual void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                          ContactVariation* variation = nullptr, const Placement* placement = nullptr) const = 0;
    /// First variations at a point from evaluate() with the same s, hit and x; the placement used then must be
    /// unchanged.
    virtual void vary(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, const ContactPoint& point,
                      ContactVariation& variation) const {
        (void)point;
        ContactPoint again;
        evaluate(s, hit, x, again, &variation);
        require(again.found, "MasterSurface: no point where there was one");
    }
    /// Whether a slave point between two facets that share a vertex may have different gaps above them. Points that
    /// alternate between such facets are latched to one of them.
    [[nodiscard]] virtual bool tells_apart(Index from, Index to) const {
        (void)from, (void)to;
        return true;
    }
    /// Whether it is the surface itself, with facets that only stand for it.
    [[nodiscard]] virtual bool exact() const { return false; }
    /// Whether refitted() can return another surface.
    [[nodiscard]] virtual bool refits() const { return false; }
    /// This surface with some patches refitted at converged positions x: those that have been bent by more than 60
    /// degrees, so that their frozen coordinates have become misleading; null if there are none.
    [[nodiscard]] virtual std::shared_ptr<const MasterSurface> refitted(const std::vector<Vec3>& x) const {
        (void)x;
        return nullptr;
    }
    /// Patches refitted since the surface was made, ascending; and, for a surface as first made, the one with these
    /// patches refitted. Null if one of them is not a patch of this surface, or cannot be fitted.
    [[nodiscard]] virtual std::vector<RefittedPatch> refitted_patches() const { return {}; }
    [[nodiscard]] virtual std::shared_ptr<const MasterSurface>
    refitted(const std::vector<RefittedPatch>& patches) const {
        (void)patches;
        return nullptr;
    }
    /// Number of refits of patches.
    [[nodiscard]] virtual Index refits_done() const { return 0; }
    /// Number of facets that use a smaller or simpler patch as fallback.
    [[nodiscard]] virtual Index fallbacks() const { return 0; }
    /// Adds the large arrays of the surface as it was first made.
    virtual void add_replicas(Replicas& replicas) const { (void)replicas; }
};

/// The finite element surface itself, with each facet extended past its edges.
[[nodiscard]] std::unique_ptr<MasterSurface> make_facets_surface(const mesh::HalfEdgeSurface& surface);

struct BlendOptions {
    int level = 2;                                      ///< rings of facets around a vertex that form its patch
    std::optional<Multiquadric> basis = Multiquadric{}; ///< none: basis_for() each patch
    int polynomial_terms = 6;
    PatchCoordinates coordinates = PatchCoordinates::equal_length;
};

/// Frozen RPIM patch of one vertex (one per smooth sector if feature edges meet there) and its bump in the blend.
struct VertexPatchInfo {
    Index vertex = -1;
    int level = 0;
    double kappa = 0;           ///< tau = kappa u^T M u
    Mat2 metric = Mat2::Zero(); ///< M, m^-2
    std::vector<Index> vertices;
};

/// Vertex gap blend: gaps to the patches of all vertices near the slave point, blended with C2 bumps,
///     g = sum_v psi_v g_v / sum_v psi_v,   psi_v = (1 - tau_v)^3_+,   n = grad_s g / |grad_s g|.
/// It does not depend on which facet is the closest, so gap, normal and forces are smooth across all edges.
[[nodiscard]] std::unique_ptr<MasterSurface>
make_blend_surface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const BlendOptions& options);
/// The patches that make_blend_surface() would use.
[[nodiscard]] std::vector<VertexPatchInfo> vertex_patches(const mesh::HalfEdgeSurface& surface,
                                                          const std::vector<Vec3>& X, const BlendOptions& options);

/// One frozen RPIM patch per facet, fitted at the reference positions X.                      [Qian 2014, secs 3.1-3.2]
/// If a patch would overlap itself in its plane (Fig. 5d) or is rank deficient, it uses one ring less, and finally only
/// the facet.
[[nodiscard]] std::unique_ptr<MasterSurface> make_rpim_surface(const mesh::HalfEdgeSurface& surface,
                                                               const std::vector<Vec3>& X, const RpimOptions& options);

} // namespace osculate::contact
