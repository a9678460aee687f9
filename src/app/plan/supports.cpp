#include "app/plan/supports.hpp"

#include "osculate/model/rigid_motion.hpp"

namespace osculate::app {

std::vector<std::string> unsupported_bodies(const Plan& plan) {
    std::vector<std::string> names;
    const std::vector<Index> group = model::tied_groups(plan.model), reach = model::joined_groups(plan.model);
    const std::vector<char> by_equations = model::held_by_equations(plan.model, plan.stages.front().constraints);
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
