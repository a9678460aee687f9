#pragma once
/// Symmetry planes of a master surface: mirrored facets continue its patches past the plane.

#include "osculate/core/types.hpp"
#include "osculate/mesh/mesh.hpp"

#include <vector>

namespace osculate::contact {

struct SymmetryPlane {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitX(); ///< unit
};

/// x -> M x + t: the identity, a reflection, or a product of reflections.
struct Image {
    Mat3 M = Mat3::Identity();
    Vec3 t = Vec3::Zero();

    [[nodiscard]] Vec3 operator()(const Vec3& x) const { return M * x + t; }
};

/// A surface with its mirror images. The given nodes come first and are themselves; the ghost nodes follow.
struct MirroredSurface {
    std::vector<mesh::Facet> facets; ///< the given facets, then the mirrored ones, with the same orientation
    std::vector<Vec3> positions;     ///< of nodes and ghosts
    std::vector<Index> original;     ///< node of which each node or ghost is an image
    std::vector<Index> image;        ///< into images
    std::vector<Image> images{Image{}};
};

/// Mirrors the facets at the planes, repeatedly between parallel ones, up to six rings of facets and no farther than
/// `depth` (m) from the nearest plane; also fills corners between planes. Nodes on a plane are their own image. Facets
/// in a plane are not mirrored.
[[nodiscard]] MirroredSurface mirror(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& X,
                                     const std::vector<SymmetryPlane>& planes, double depth);

} // namespace osculate::contact
