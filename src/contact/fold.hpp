#pragma once
/// Whether part of a surface can be laid flat.

#include "osculate/contact/rpim_patch.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <span>
#include <vector>

namespace osculate::contact {

/// Whether one of the facets folds over when projected on the plane (Fig. 5d): turned by more than 80 degrees, left with
/// less than 5 % of its area, or with a corner whose Jacobian is that small.
[[nodiscard]] bool folds(const mesh::HalfEdgeSurface& surface, std::span<const Index> facets,
                         const ReferencePlane& plane, const std::vector<Vec3>& X);

} // namespace osculate::contact
