#include "app/plan/supports.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/model/rigid_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace osculate::app {

namespace {

/// (bodies) A number that bodies share which ties or equations join.
std::vector<Index> joined(const model::Model& model) {
    std::vector<Index> group = model::tied_groups(model);
    for (const model::LedNode& one : model.led)
        for (const auto& [node, by] : one.by) {
            const Index from = group[static_cast<std::size_t>(model::body_index(model, node))],
                        to = group[static_cast<std::size_t>(model::body_index(model, one.node))];
            std::ranges::replace(group, from, to);
        }
    return group;
}

} // namespace

std::vector<char> held_by_equations(const model::Model& model, const time::Stage& stage) {
    constexpr double rank_tolerance = 1e-12; // of a Gram matrix, as in RigidHold
    std::vector<char> held(model.bodies.size(), 0);
    if (model.led.empty()) return held;
    const std::vector<Index> tied = model::tied_groups(model), group = joined(model);
    Eigen::AlignedBox3d box;
    for (const Vec3& X : model.X) box.extend(X);
    const Vec3 centre = box.center();
    const double size = std::max(0.5 * box.diagonal().norm(), 1e-300);
    const auto n = static_cast<Index>(model.bodies.size());
    Matrix gram = Matrix::Zero(6 * n, 6 * n);
    Vector row(6 * n);
    const auto add_part = [&](Index body, const Vec3& point, const Vec3& direction) {
        const Index at = 6 * tied[static_cast<std::size_t>(body)];
        row.segment<3>(at) += direction;
        row.segment<3>(at + 3) += ((point - centre) / size).cross(direction);
    };
    const auto finish = [&] {
        gram.noalias() += row * row.transpose();
        row.setZero();
    };
    row.setZero();
    const auto X = [&](Index node) -> const Vec3& { return model.X[static_cast<std::size_t>(node)]; };
    for (const linear::NodeConstraint& c : stage.constraints) {
        const model::RigidBody* rigid = model::rigid_body_of(model, c.node);
        if (rigid != nullptr && c.node == rigid->rotation())
            row.segment<3>(6 * tied[static_cast<std::size_t>(rigid->body)] + 3) += c.direction;
        else
            add_part(rigid != nullptr ? rigid->body : model::body_index(model, c.node), X(c.node), c.direction);
        finish();
    }
    for (const model::CyclicSymmetry& ring : model.cyclic) { // as RigidHold::hold() of a ring
        const Vec3 one = ring.axis.unitOrthogonal();
        for (const Vec3& across : {one, Vec3(ring.axis.cross(one))}) {
            add_part(ring.body, ring.point, across);
            finish();
            row.segment<3>(6 * tied[static_cast<std::size_t>(ring.body)] + 3) += across;
            finish();
        }
    }
    for (const model::LedNode& one : model.led) {
        add_part(model::body_index(model, one.node), X(one.node), one.direction);
        for (const auto& [node, by] : one.by) add_part(model::body_index(model, node), X(node), -by);
        finish();
    }
    for (Index g = 0; g < n; ++g) {
        std::set<Index> rows; // bodies that are tied to one another move as one
        for (std::size_t b = 0; b < group.size(); ++b)
            if (group[b] == g)
                for (Index k = 0; k < 6; ++k) rows.insert(6 * tied[b] + k);
        if (rows.empty()) continue;
        const std::vector<Index> own(rows.begin(), rows.end());
        const Vector values = symmetric_eigen(gram(own, own)).values; // ascending
        if (values(0) > rank_tolerance * values(values.size() - 1))
            for (Index b = 0; b < n; ++b)
                if (group[static_cast<std::size_t>(b)] == g) held[static_cast<std::size_t>(b)] = 1;
    }
    return held;
}

std::vector<std::string> unsupported_bodies(const Plan& plan) {
    std::vector<std::string> names;
    const std::vector<Index> group = model::tied_groups(plan.model), reach = joined(plan.model);
    const std::vector<char> by_equations = held_by_equations(plan.model, plan.stages.front());
    for (std::size_t b = 0; b < plan.model.bodies.size(); ++b) {
        const model::Body& body = plan.model.bodies[b];
        model::RigidHold hold(body, plan.model.X);
        for (const linear::NodeConstraint& c : plan.stages.front().constraints)
            if (const Index other = model::body_index(plan.model, c.node);
                other >= 0 && group[static_cast<std::size_t>(other)] == group[b])
                hold.hold(plan.model.X[c.node], c.direction);
        for (const model::RigidBody& rigid : plan.model.rigid)
            if (group[static_cast<std::size_t>(rigid.body)] == group[b])
                for (const linear::NodeConstraint& c : plan.stages.front().constraints)
                    hold.hold(rigid, c, plan.model.X);
        for (const model::CyclicSymmetry& ring : plan.model.cyclic)
            if (static_cast<std::size_t>(ring.body) == b) hold.hold(ring);
        const bool held = hold.free() == 0 || by_equations[b] != 0;
        bool touched = plan.model.general != nullptr;
        for (const auto& pair : plan.model.pairs)
            for (const Index node : {pair->slaves().node.front(), pair->master_nodes().front()})
                if (const Index other = model::body_index(plan.model, node); other >= 0)
                    touched = touched || reach[static_cast<std::size_t>(other)] == reach[b];
        if (!held && !touched) names.push_back(body.name);
    }
    return names;
}

} // namespace osculate::app
