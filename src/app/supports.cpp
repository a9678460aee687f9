#include "app/supports.hpp"

#include <Eigen/SVD>

namespace osculate::app {

std::vector<std::string> unsupported_bodies(const Plan& plan) {
    std::vector<std::string> names;
    for (const model::Body& body : plan.model.bodies) {
        const auto owns = [&](Index node) { return node >= body.first_node && node < body.first_node + body.nodes(); };
        Vec3 centre = Vec3::Zero();
        for (const Vec3& X : body.mesh.nodes) centre += X / static_cast<double>(body.nodes());
        double size = 0;
        for (const Vec3& X : body.mesh.nodes) size = std::max(size, (X - centre).norm());
        // held motions d . (t + w x r): the Gram matrix of the rows has full rank when no rigid motion is left
        Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
        for (const model::NodeConstraint& c : plan.stages.front().constraints)
            if (owns(c.node)) {
                Eigen::Matrix<double, 6, 1> row;
                row << c.direction, ((plan.model.X[c.node] - centre) / size).cross(c.direction);
                gram += row * row.transpose();
            }
        const Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>> svd(gram);
        constexpr double rank_tolerance = 1e-12; // of a Gram matrix: 1e-6 of a lever arm
        const bool held = svd.singularValues()(5) > rank_tolerance * svd.singularValues()(0);
        bool touched = false;
        for (const auto& pair : plan.model.pairs)
            touched = touched || owns(pair->slaves().node.front()) || owns(pair->master_nodes().front());
        if (!held && !touched) names.push_back(body.name);
    }
    return names;
}

} // namespace osculate::app
