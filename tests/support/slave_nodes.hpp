#pragma once
/// What the slave nodes of a finished run bear, and the measures of it that contact problems with known answers need.

#include "support/scene_runner.hpp"

#include <cmath>
#include <vector>

namespace osculate::support {

struct SlaveNode {
    Vec3 X = Vec3::Zero();        ///< reference position, m
    Vec3 traction = Vec3::Zero(); ///< tangential part of the force on the slave, N
    double normal = 0;            ///< normal force, N
    double area = 0;              ///< tributary area, m^2

    [[nodiscard]] double pressure() const { return normal / area; }
};

/// Those of the first pair after the last step.
inline std::vector<SlaveNode> slave_nodes(const SceneRun& run) {
    const model::ContactEvaluation& evaluation = run.contact.front();
    const model::ContactPair& pair = evaluation.pair();
    const auto& lambda = run.steps.back().state.contact.front().lambda;
    std::vector<SlaveNode> nodes;
    for (Index j = 0; j < pair.size(); ++j) {
        SlaveNode node;
        node.X = run.plan.model.X[pair.slaves().node[j]];
        node.area = pair.slaves().area[j];
        if (evaluation.point(j).found) {
            const Vec3& n = evaluation.point(j).normal;
            node.normal = lambda[j].dot(n);
            node.traction = lambda[j] - node.normal * n;
        }
        nodes.push_back(node);
    }
    return nodes;
}

/// Square root of the mean of distance^2, weighted. Forces see a square through the hat functions of the nodes, which adds
/// h^2/6 for each direction: an error of second order.
template <class Distance, class Weight>
double radius_of_gyration(const std::vector<SlaveNode>& nodes, const Distance& distance, const Weight& weight) {
    double sum = 0, moment = 0;
    for (const SlaveNode& node : nodes) {
        sum += weight(node);
        moment += weight(node) * distance(node) * distance(node);
    }
    return std::sqrt(moment / sum);
}

/// Root mean square of `error` over the nodes that `where` takes.
template <class Error, class Where>
double rms(const std::vector<SlaveNode>& nodes, const Error& error, const Where& where) {
    double sum = 0;
    int count = 0;
    for (const SlaveNode& node : nodes) {
        if (!where(node)) continue;
        sum += error(node) * error(node);
        ++count;
    }
    return std::sqrt(sum / count);
}

} // namespace osculate::support
