#pragma once
/// Facets that take the place of faces with midside nodes in contact.

#include "osculate/core/types.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <utility>
#include <vector>

namespace osculate::fe {

/// A node of the skin of some faces.
struct SkinWeights {
    Index node = -1;                                ///< of the faces, which it stands for
    std::vector<std::pair<Index, double>> carriers; ///< nodes of elements, ascending, and weights that sum to 1
};

/// The skin of faces: plane pieces through points y_i, one for each node of the faces,
///     y_i = sum_k S_ik x_k + F_i (X_i - sum_k S_ik X_k),   S_ik = int psi_i N_k dA / int psi_i dA,
/// with the faces' own shape functions N and the dual functions psi of the pieces, over the pieces as they are with corners
/// at the nodes; F_i is the mean deformation gradient of the elements at the node, at their centres, by their corners. So
/// the skin is the faces' projection on what pieces can show, but starts at the nodes; it follows every linear motion; and
/// the nodal forces of a uniform pressure on pieces in a plane act on the nodes x_k as those of the pressure on the faces,
/// which are not all of one sign. At faces without midside nodes y_i = x_i.         [dual functions: Wohlmuth 2000]
/// @param facets      of the surface, with nodes numbered from first_node
/// @param X           reference positions of all nodes, m
/// @return            by ascending node; empty if no face has midside nodes
[[nodiscard]] std::vector<SkinWeights> skin_weights(const mesh::Mesh& mesh, const std::vector<mesh::Facet>& facets,
                                                    Index first_node, const std::vector<Vec3>& X);

} // namespace osculate::fe
