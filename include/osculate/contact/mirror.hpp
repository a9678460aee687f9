#pragma once
/// Symmetry planes of a master surface: mirrored facets carry its patches on past the plane.

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

/// A surface with its mirror images. Nodes below `original.size()` of the nodes given are themselves; the ghosts follow.
struct MirroredSurface {
    std::vector<mesh::Facet> facets; ///< those given first, then the mirrored ones, oriented alike
    std::vector<Vec3> positions;     ///< of nodes and ghosts
    std::vector<Index> original;     ///< node that each node or ghost stands for
    std::vector<Index> image;        ///< into images
    std::vector<Image> images{Image{}};
};

/// Mirrors the facets at the planes, again and again between parallel ones, six rings of facets far and no farther than
/// `depth` (m) from the nearest plane; corners between planes are filled too. Nodes on a plane are their own image. Facets
/// that lie in a plane are not mirrored.
[[nodiscard]] MirroredSurface mirror(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& X,
                                     const std::vector<SymmetryPlane>& planes, double depth);

} // namespace osculate::contact
