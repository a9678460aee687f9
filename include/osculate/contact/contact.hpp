#pragma once
/// Contact geometry alone: a smooth surface through the nodes of triangles and quadrilaterals, the gap of a point to it, and
/// what these change by as nodes move. `find_package(osculate COMPONENTS contact)`, `osculate::contact`.

#include "osculate/contact/contact_point.hpp"  // IWYU pragma: export
#include "osculate/contact/master_surface.hpp" // IWYU pragma: export
#include "osculate/contact/search.hpp"         // IWYU pragma: export
#include "osculate/contact/sided_surface.hpp"  // IWYU pragma: export
#include "osculate/mesh/half_edge_surface.hpp" // IWYU pragma: export
