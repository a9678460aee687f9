#pragma once
/// Gaps of a pair in the reference configuration.

#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"

#include <string>
#include <vector>

namespace osculate::app {

struct Overlap {
    Index node = -1;          ///< global
    Index facet = -1;         ///< of the master
    double depth = 0;         ///< m
    Vec3 foot = Vec3::Zero(); ///< on the master, from Model::origin
    double of_facet = 0;      ///< depth over the size of the facet
};

struct PairGaps {
    Index above = 0;               ///< slave nodes with a contact partner below them
    double least = 0;              ///< smallest gap, m
    double largest = 0;            ///< largest gap, m
    double largest_overlap = 0;    ///< over the size of the facet concerned
    Index worst_node = -1;         ///< global node with the smallest gap
    std::vector<Overlap> overlaps; ///< of nodes deeper than round-off, deepest first
};

/// Evaluates contact there.
[[nodiscard]] PairGaps initial_gaps(model::ContactEvaluation& evaluation, const std::vector<Vec3>& X, Timings& timings,
                                    int threads);

/// "node 12 of body 'cap'" for a global node.
[[nodiscard]] std::string node_name(const model::Model& model, Index node);

} // namespace osculate::app
