#include "app/plan/supports.hpp"

#include "osculate/model/rigid_motion.hpp"

namespace osculate::app {

std::vector<std::string> unsupported_bodies(const Plan& plan) {
    std::vector<std::string> names;
    for (const model::Body& body : plan.model.bodies) {
        const auto owns = [&](Index node) { return node >= body.first_node && node < body.first_node + body.nodes(); };
        model::RigidHold hold(body, plan.model.X);
        for (const linear::NodeConstraint& c : plan.stages.front().constraints)
            if (owns(c.node)) hold.hold(plan.model.X[c.node], c.direction);
        for (const model::RigidBody& rigid : plan.model.rigid)
            if (&plan.model.bodies[static_cast<std::size_t>(rigid.body)] == &body)
                for (const linear::NodeConstraint& c : plan.stages.front().constraints)
                    hold.hold(rigid, c, plan.model.X);
        const bool held = hold.free() == 0;
        bool touched = plan.model.general != nullptr;
        for (const auto& pair : plan.model.pairs)
            touched = touched || owns(pair->slaves().node.front()) || owns(pair->master_nodes().front());
        if (!held && !touched) names.push_back(body.name);
    }
    return names;
}

} // namespace osculate::app
