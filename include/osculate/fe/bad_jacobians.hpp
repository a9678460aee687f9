#pragma once
/// Elements of a mesh that no kernel can compute.

#include "osculate/core/types.hpp"
#include "osculate/mesh/mesh.hpp"

#include <vector>

namespace osculate::fe {

/// An element that is folded over somewhere inside, or on an edge.
struct BadJacobian {
    Index element; ///< of its block
    Vec3 place;    ///< m, the first at which the Jacobian is not positive
};

/// Elements of a block whose reference map has a Jacobian that is not positive (or is NaN) where kernels take it: at the
/// quadrature points and the centre; also at the nodes of elements with midside nodes. Corners of others are seen by
/// mesh::bad_corner.
/// @pre  the block's node numbers are within `positions`
[[nodiscard]] std::vector<BadJacobian> bad_jacobians(const mesh::ElementBlock& block,
                                                     const std::vector<Vec3>& positions);

} // namespace osculate::fe
