#pragma once
/// Surfaces through the nodes of a mesh, with one common interface: facet by facet.

#include "osculate/contact/radial_basis.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osculate::study {

/// Topology and vertex positions, in local numbering.
struct SurfaceMesh {
    mesh::HalfEdgeSurface topology;
    std::vector<Vec3> x;
};

struct SurfacePoint {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double mean_curvature = 0; ///< H = 1/2 div n, 1/m
};

class Approximation {
public:
    virtual ~Approximation() = default;
    /// Point of the approximation for the point u of a facet (natural coordinates of contact::FacetPatch); no value if
    /// it has none.
    [[nodiscard]] virtual std::optional<SurfacePoint> at(Index facet, const Vec2& u) const = 0;
    /// Number of facets or vertices that use a smaller patch.
    [[nodiscard]] virtual Index fallbacks() const { return 0; }
};

/// The facets themselves.
[[nodiscard]] std::unique_ptr<Approximation> make_facets(const SurfaceMesh& surface);

/// Quadratic patches whose edges are orthogonal to the vertex normals; X = sum L_i x_i - sum c_ij L_i L_j on triangles,
/// the corresponding serendipity form on quadrilaterals.                           [Nagata 2005, CAGD 22, eqs (5)-(20)]
/// Vertex normals are averages of the facet normals, weighted by the angles at the vertex, because a mesh has none of
/// its own.
[[nodiscard]] std::unique_ptr<Approximation> make_nagata(const SurfaceMesh& surface);

/// A height x3(x1, x2) on the k-ring of every facet, m = 3: radial point interpolation with a linear polynomial basis.
/// The result is the point above that of u.                                                         [Qian 2014, eq (9)]
/// @pre no facet is perpendicular to the x1x2 plane
[[nodiscard]] std::unique_ptr<Approximation> make_height_patches(const SurfaceMesh& surface, int ring);

/// The master surfaces `rpim` and `blend` of contact, m = 6 and equal lengths. The result is the foot to which s <- s -
/// g n converges from the facet's point.
/// @param basis  none: the one that suits each patch, as with contact.<pair>.discretisation: petrov_galerkin
[[nodiscard]] std::unique_ptr<Approximation> make_rpim(const SurfaceMesh& surface, int ring);
[[nodiscard]] std::unique_ptr<Approximation>
make_blend(const SurfaceMesh& surface, int level,
           const std::optional<contact::Multiquadric>& basis = contact::Multiquadric{});

/// Names of all methods: facets, nagata, height_1, rpim_1, rpim_2, blend_1, blend_2, blend_3, blend with
/// the basis that suits each patch and, with polyharmonic bases r^3 and r^5, blend_2_r3, blend_1_r5, blend_2_r5, blend_3_r5.
[[nodiscard]] const std::vector<std::string>& method_names();
/// @pre  the name is one of method_names()
[[nodiscard]] std::unique_ptr<Approximation> make_approximation(const std::string& method, const SurfaceMesh& surface);

} // namespace osculate::study
