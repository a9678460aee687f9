#pragma once
/// Master surfaces of facets or single patches, on bodies with sharp edges.

#include "osculate/contact/master_surface.hpp"

namespace osculate::contact {

/// A surface of facets or patches of its own side each, which are extended past their edges, as one surface with sharp edges: a point
/// beyond a feature edge, whose closest point is on that edge, is over the side that faces it. The plane of the other side
/// passes through points that are anywhere. `each` itself where there are no feature edges.
[[nodiscard]] std::unique_ptr<MasterSurface> with_sides(const mesh::HalfEdgeSurface& surface,
                                                        std::unique_ptr<MasterSurface> each);

} // namespace osculate::contact
