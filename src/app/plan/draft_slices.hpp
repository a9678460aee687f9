#pragma once
/// Bodies of one layer of elements that stand for plane ones, or for those of revolution.

#include "app/plan/draft.hpp"

namespace osculate::app {

/// A node of a slice moves along a direction as another does along its own.
struct SliceRow {
    std::string key; ///< of the slice
    Index node = -1, as = -1;
    Vec3 direction = Vec3::UnitX(), own = Vec3::UnitX();
};

/// Nodes of a slice that have another in the same place of the plane below them -> the lowest there; empty for other bodies.
[[nodiscard]] std::map<Index, Index> nodes_above(const scene::Scene& scene, const model::Model& model, Index body);
/// Holds the nodes of slices across their planes in every stage, and says which move alike.
[[nodiscard]] std::vector<SliceRow> add_slices(Draft& draft);

} // namespace osculate::app
