#include "app/plan/gaps.hpp"

#include <algorithm>
#include <limits>

namespace osculate::app {

PairGaps initial_gaps(model::ContactEvaluation& evaluation, const std::vector<Vec3>& X, Timings& timings, int threads) {
    const model::ContactPair& pair = evaluation.pair();
    evaluation.begin_step(X, pair.initial_history(), timings, threads);
    evaluation.evaluate(X, timings, threads);
    constexpr double round_off = 1e-9; // of the facet size
    PairGaps gaps;
    gaps.least = std::numeric_limits<double>::max();
    gaps.largest = -gaps.least;
    for (Index j = 0; j < pair.size(); ++j) {
        const contact::ContactPoint& point = evaluation.point(j);
        if (!point.found && !point.behind) continue;
        ++gaps.above;
        gaps.largest = std::max(gaps.largest, point.gap);
        if (point.gap < gaps.least) {
            gaps.least = point.gap;
            gaps.worst_node = pair.slaves().node[j];
        }
        const double of_facet = -point.gap / pair.surface().facet_size(point.facet);
        gaps.largest_overlap = std::max(gaps.largest_overlap, of_facet);
        if (of_facet > round_off)
            gaps.overlaps.push_back({pair.slaves().node[j], point.facet, -point.gap, point.foot, of_facet});
    }
    std::ranges::stable_sort(gaps.overlaps, std::ranges::greater{}, &Overlap::depth);
    if (gaps.above == 0) gaps.least = gaps.largest = 0;
    return gaps;
}

std::string node_name(const model::Model& model, Index any) {
    const Index node = model::material_node(model, any);
    for (const model::Body& body : model.bodies)
        if (node >= body.first_node && node < body.first_node + body.nodes())
            return "node " + std::to_string(node - body.first_node) + " of body '" + body.name + "'";
    return "no node";
}

} // namespace osculate::app
