/// Matrices of a plan, and weight, which acts on masses.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/draft_share.hpp"
#include "app/plan/draft_slices.hpp"
#include "osculate/model/general_contact.hpp"

#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>

namespace osculate::app {

namespace {

/// Nodes without mass of their own: slave nodes whose contact is exact, where the scene asks for it.
std::vector<char> massless_nodes(const Draft& draft) {
    std::vector<char> massless;
    const auto mark = [&](Index node) {
        massless[static_cast<std::size_t>(model::material_node(draft.plan.model, node))] = 1;
    };
    for (const auto& [name, stage] : draft.scene.stages) {
        const auto* dynamic = std::get_if<scene::DynamicAnalysis>(&stage.analysis);
        if (dynamic == nullptr || dynamic->contact_mass == scene::ContactMass::kept) continue;
        massless.assign(draft.plan.model.X.size(), 0);
        for (const auto& pair : draft.plan.model.pairs)
            if (!pair->options().overclosure) // an interface that gives way stores what its nodes bring
                for (const Index node : pair->slaves().node) mark(node);
        if (draft.plan.model.general)
            for (const Index node : draft.plan.model.general->possible_slaves()) mark(node);
        for (Index b = 0; b < static_cast<Index>(draft.plan.model.bodies.size()); ++b)
            for (const auto& [above, base] : nodes_above(draft.scene, draft.plan.model, b))
                massless[static_cast<std::size_t>(above)] |= massless[static_cast<std::size_t>(base)];
        break;
    }
    return massless;
}

/// Motions at the start that equations would have to change, by forces that nothing has said.
void check_led_velocities(Draft& draft) {
    constexpr double round_off = 1e-9; // of the fastest
    const model::Model& m = draft.plan.model;
    double fastest = 0;
    for (const Vec3& v : m.initial_velocity) fastest = std::max(fastest, v.norm());
    for (const model::LedNode& one : m.led) {
        const auto v = [&](Index node) -> const Vec3& { return m.initial_velocity[static_cast<std::size_t>(node)]; };
        double along = one.direction.dot(v(one.node));
        for (const auto& [node, by] : one.by) along -= by.dot(v(node));
        if (std::abs(along) <= round_off * fastest) continue;
        const Vec3 X = m.X[static_cast<std::size_t>(one.node)] + m.origin;
        draft.faults.push_back(fault("equations", "initial velocities that satisfy the equations",
                                     fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m that is off by {:.3g} m/s", X[0],
                                                 X[1], X[2], std::abs(along))));
        return;
    }
}

/// Masses and velocities, where a stage is dynamic.
void add_mass(Draft& draft) {
    model::Model& m = draft.plan.model;
    const std::vector<char> massless = massless_nodes(draft);
    for (const time::Stage& stage : draft.plan.stages) {
        if (!stage.dynamics) continue;
        linear::BlockMatrix& mass = stage.dynamics->lumped_mass ? m.lumped_mass : m.consistent_mass;
        if (mass.empty()) {
            model::AssembledMass assembled =
                model::assemble_mass(m.bodies, m.nodes(), stage.dynamics->lumped_mass, massless, m.share);
            mass = std::move(assembled.M);
            std::vector<Index> kept;
            std::ranges::set_union(m.kept_contact_mass, assembled.kept, std::back_inserter(kept));
            m.kept_contact_mass = std::move(kept);
        }
        if (!m.initial_velocity.empty()) continue;
        for (std::size_t b = 0; b < m.bodies.size(); ++b) {
            const model::Body& body = m.bodies[b];
            const scene::Body& spec = draft.scene.bodies[b].second;
            const Vec3 centre = model::centre_of_mass(body);
            for (const Vec3& X : body.mesh.nodes)
                m.initial_velocity.values().push_back(spec.initial_velocity + spec.initial_spin.cross(X - centre));
        }
        m.initial_velocity.values().resize(m.X.size(), Vec3::Zero()); // rigid bodies know theirs
        check_led_velocities(draft);
    }
}

/// A node with mass loses its speed in the step in which it lands, however short that is, and rings the faster the
/// shorter steps are: cuts for what landing costs would make it worse.
void leave_steps_where_mass_lands(Draft& draft) {
    if (draft.plan.model.kept_contact_mass.empty()) return;
    for (time::Stage& stage : draft.plan.stages)
        if (!stage.limits.inelastic_impacts) // which are not cut for it
            stage.limits.velocity_error = stage.limits.closing_energy = std::numeric_limits<double>::infinity();
}

/// Whose mass a stage weighs: its own, in statics that of the dynamic stage it leads to, or else comes from.
const equilibrium::Dynamics* weighed(const Draft& draft, std::size_t s) {
    for (std::size_t k = s; k < draft.plan.stages.size(); ++k)
        if (draft.plan.stages[k].dynamics) return &*draft.plan.stages[k].dynamics;
    for (std::size_t k = s; k-- > 0;)
        if (draft.plan.stages[k].dynamics) return &*draft.plan.stages[k].dynamics;
    return nullptr;
}

/// At the centre of mass, which turns about the reference point with the mesh.
void add_weight(Draft& draft, const model::RigidBody& rigid, Field& weight) {
    const model::Body& body = draft.plan.model.bodies[static_cast<std::size_t>(rigid.body)];
    if (rigid.mass == 0) return;
    const std::vector<double> share = model::weights_about(body.mesh.nodes, rigid.centre);
    if (share.empty() && draft.faults.empty())
        draft.faults.push_back(fault("bodies." + body.name + ".rigid.centre",
                                     "a centre of mass in the plane of a flat mesh, for gravity", "one outside it"));
    for (std::size_t i = 0; i < share.size(); ++i)
        weight[static_cast<std::size_t>(rigid.nodes[i])] += share[i] * rigid.mass * draft.scene.gravity;
}

/// In full from the start. It acts on mass where the mass is, so that bodies fall without strain, and in statics on the
/// same mass, so that what rests goes on resting when inertia sets in.
void add_gravity(Draft& draft) {
    if (draft.scene.gravity.isZero(0)) return;
    const model::Model& m = draft.plan.model;
    std::map<std::optional<bool>, std::shared_ptr<const Field>> weights; // by mass: none, consistent or lumped
    for (std::size_t s = 0; s < draft.plan.stages.size(); ++s) {
        const equilibrium::Dynamics* dynamics = weighed(draft, s);
        std::shared_ptr<const Field>& known =
            weights[dynamics != nullptr ? std::optional(dynamics->lumped_mass) : std::nullopt];
        draft.plan.stages[s].weight = known;
        if (known) continue;
        Field weight(m.X.size());
        if (dynamics != nullptr)
            m.mass(dynamics->lumped_mass).multiply_add(Field(m.X.size(), draft.scene.gravity), weight, draft.threads);
        else
            for (const model::Body& body : m.bodies)
                if (!body.rigid) model::add_gravity(body, draft.scene.gravity, weight);
        for (const model::RigidBody& rigid : m.rigid) add_weight(draft, rigid, weight);
        draft.plan.stages[s].weight = known = std::make_shared<const Field>(std::move(weight));
    }
}

} // namespace

void add_matrices(Draft& draft) {
    const ScopedTimer timer(draft.timings, Part::assembly);
    model::Model& model = draft.plan.model;
    Lists neighbours = model::neighbours(model.bodies, model.nodes());
    if (draft.ranks) model.share = share_nodes(draft, neighbours);
    model.K = model::assemble_stiffness(model.bodies, std::move(neighbours), model.share);
    if (draft.any_kernel([](const fe::ElementKernel& kernel) { return !kernel.linear(); }))
        model.nonlinear = std::make_unique<model::NonlinearElements>(model.bodies, model.K, model.share);
    add_mass(draft);
    leave_steps_where_mass_lands(draft);
    add_gravity(draft);
}

} // namespace osculate::app
