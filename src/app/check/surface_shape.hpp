#pragma once
/// Shapes of slave and master that contact has trouble with.

#include "osculate/model/contact_evaluation.hpp"

#include <vector>

namespace osculate::app {

/// Slave facets, by number, that turn their edge or their back on every facet of the master, though others of the set look
/// at it: the sides of a block whose sole is pressed on a plane. What goes smoothly over into facets that do look, as
/// all round a wheel, is none of them.
[[nodiscard]] std::vector<std::size_t> side_facets(const model::ContactPair& pair, const std::vector<Vec3>& X);

/// Edges inside a master that are sharper than the feature angle.
struct SharpEdges {
    Index convex = 0, concave = 0;
    Vec3 first_convex = Vec3::Zero(), first_concave = Vec3::Zero(); ///< middles, m
};
[[nodiscard]] SharpEdges sharp_edges(const model::ContactPair& pair, const std::vector<Vec3>& X);

/// Whether slave and master run alongside one another over several facets of a curved master, closer than its facets
/// stand off from a curve through their nodes.
/// @param evaluation  in the reference configuration
[[nodiscard]] bool fits(const model::ContactEvaluation& evaluation);

} // namespace osculate::app
