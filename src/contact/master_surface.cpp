#include "osculate/contact/master_surface.hpp"

#include "contact/area_vector.hpp"
#include "contact/fold.hpp"
#include "contact/largest_turn.hpp"
#include "contact/merge.hpp"
#include "contact/reach.hpp"
#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/projection.hpp"
#include "osculate/contact/rpim_patch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace osculate::contact {

namespace {

/// A slave point and the nodes of a patch, from one of these: the round-off of X = Phi_i x_i must not grow with the
/// distance from the origin.
struct FromNode {
    Vec3 origin, s;
    MatrixX3 nodes;

    FromNode(std::span<const Index> vertices, const Vec3& slave, const std::vector<Vec3>& x)
        : origin(x[vertices[0]]), s(slave - origin), nodes(static_cast<Index>(vertices.size()), 3) {
        for (std::size_t i = 0; i < vertices.size(); ++i)
            nodes.row(static_cast<Index>(i)) = (x[vertices[i]] - origin).transpose();
    }
};

template <class Patch>
bool evaluate_at(const std::optional<Foot>& foot, const Patch& patch, std::span<const Index> vertices,
                 const FromNode& from, double facet_size, ContactPoint& point, ContactVariation* variation) {
    if (!foot) return false;
    point.nodes.assign(vertices.begin(), vertices.end());
    if (!locate(patch, *foot, from.s, point)) return false;
    if (variation != nullptr) vary(patch, *foot, point, *variation);
    point.foot += from.origin;
    point.behind = point.gap <= -deepest * facet_size;
    return !point.behind;
}

class FacetsSurface final : public MasterSurface {
public:
    explicit FacetsSurface(const mesh::HalfEdgeSurface& surface) : surface_(surface) {}

    std::span<const Index> patch_vertices(Index facet) const override { return surface_.facet_vertices(facet); }

    void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                  ContactVariation* variation, const Placement*) const override {
        point.found = point.behind = false;
        point.facet = hit.facet;
        if (hit.facet < 0) return;
        const double size = surface_.facet_size(hit.facet);
        if (beyond_boundary(hit, size)) return;
        const auto vertices = surface_.facet_vertices(hit.facet);
        FacetPatch patch(static_cast<int>(vertices.size()));
        const FromNode from(vertices, s, x);
        std::optional<Foot> foot = patch.foot(from.s, from.nodes, hit.u);
        if (!foot && vertices.size() == 4) {
            patch = patch.flattened();
            foot = patch.foot(from.s, from.nodes, hit.u);
        }
        point.found = evaluate_at(foot, patch, vertices, from, size, point, variation);
    }

private:
    const mesh::HalfEdgeSurface& surface_;
};

class RpimSurface final : public MasterSurface {
public:
    RpimSurface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const RpimOptions& options)
        : surface_(surface), facets_(surface) {
        domains_.reserve(static_cast<std::size_t>(surface.facet_count()));
        const auto fewer = merged(surface, X, options.ring);
        if (fewer) fallbacks_ = surface.vertex_count() - fewer->topology.vertex_count();
        for (Index f = 0; f < surface.facet_count(); ++f) {
            if (!fewer) {
                domains_.push_back(make_domain(surface, f, X, f, X, options));
                continue;
            }
            domains_.push_back(make_domain(fewer->topology, fewer->host[f], fewer->X, f, X, options));
            for (Index& v : domains_.back().vertices) v = fewer->vertex[v];
        }
    }

    std::span<const Index> patch_vertices(Index facet) const override {
        const Domain& domain = domains_[facet];
        return domain.patch ? std::span<const Index>(domain.vertices) : facets_.patch_vertices(facet);
    }

    void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                  ContactVariation* variation, const Placement*) const override {
        point.found = point.behind = false;
        point.facet = hit.facet;
        if (hit.facet < 0) return;
        const Domain& domain = domains_[hit.facet];
        if (!domain.patch) return facets_.evaluate(s, hit, x, point, variation, nullptr);
        const double size = domain.size;
        if (beyond_boundary(hit, size)) return;
        // start where the facet's own closest point lies in the patch's coordinates
        const FacetPatch facet(static_cast<int>(domain.corners.rows()));
        Vector phi(facet.size());
        MatrixX2 phi_a(facet.size(), 2);
        facet.weights(hit.u, phi, phi_a);
        const Vec2 start = domain.corners.transpose() * phi;
        const FromNode from(domain.vertices, s, x);
        const auto foot = project(*domain.patch, domain.patch->coefficients(from.nodes), from.s, start);
        point.found = evaluate_at(foot, *domain.patch, domain.vertices, from, size, point, variation);
    }

    Index fallbacks() const override { return fallbacks_; }

private:
    /// Domain of influence of a temporary facet: a frozen patch, or nothing where only the facet itself will do.
    struct Domain {
        std::vector<Index> vertices;
        std::optional<RpimPatch> patch;
        MatrixX2 corners; ///< natural coordinates of the facet's own corners
        double size = 0;  ///< of the facet it is made around, m
    };

    /// Around a facet of a surface whose vertices are at X; `own` is the facet of surface_, vertices at X_own, that is to
    /// use it: the same, unless vertices have been merged.
    Domain make_domain(const mesh::HalfEdgeSurface& surface, Index facet, const std::vector<Vec3>& X, Index own,
                       const std::vector<Vec3>& X_own, const RpimOptions& options) {
        const auto around = surface.facet_vertices(facet), corners_own = surface_.facet_vertices(own);
        const FacetPatch shape(static_cast<int>(around.size()));
        MatrixX3 corners(shape.size(), 3);
        for (Index b = 0; b < shape.size(); ++b) corners.row(b) = X[around[b]].transpose();
        const PatchPoint centre = shape.point(shape.centre(), corners);
        const ReferencePlane plane = ReferencePlane::through(centre.X, centre.normal());
        const auto natural = [&](const Vec3& x) {
            return options.coordinates == PatchCoordinates::tangential ? plane.tangential(x) : plane.equal_length(x);
        };
        for (int ring = options.ring; ring > 0; --ring) {
            if (folds(surface, surface.ring_facets(facet, ring), plane, X)) continue;
            Domain domain;
            domain.size = surface.facet_size(facet);
            domain.vertices = surface.facet_ring(facet, ring);
            MatrixX2 u(static_cast<Index>(domain.vertices.size()), 2), flat(u.rows(), 2);
            for (Index i = 0; i < u.rows(); ++i) {
                u.row(i) = natural(X[domain.vertices[i]]).transpose();
                flat.row(i) = plane.tangential(X[domain.vertices[i]]).transpose();
            }
            const Multiquadric basis = options.basis ? *options.basis
                                       : options.polynomial_terms < 6
                                           ? r3 // r^5 needs quadratics
                                           : basis_for(largest_turn(surface, surface.ring_facets(facet, ring), X));
            domain.patch = RpimPatch::fit(u, flat, options.basis, basis, options.polynomial_terms);
            if (!domain.patch) continue;
            domain.corners.resize(static_cast<Index>(corners_own.size()), 2);
            for (Index b = 0; b < domain.corners.rows(); ++b)
                domain.corners.row(b) = natural(X_own[corners_own[b]]).transpose();
            if (ring < options.ring) ++fallbacks_;
            return domain;
        }
        ++fallbacks_;
        return {};
    }

    const mesh::HalfEdgeSurface& surface_;
    FacetsSurface facets_;
    std::vector<Domain> domains_;
    Index fallbacks_ = 0;
};

} // namespace

std::unique_ptr<MasterSurface> make_facets_surface(const mesh::HalfEdgeSurface& surface) {
    return std::make_unique<FacetsSurface>(surface);
}

std::unique_ptr<MasterSurface> make_rpim_surface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                                                 const RpimOptions& options) {
    return std::make_unique<RpimSurface>(surface, X, options);
}

} // namespace osculate::contact
