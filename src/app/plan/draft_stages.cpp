/// Stages of a plan: limits, supports, motions and loads.

#include "app/fault.hpp"
#include "app/overloaded.hpp"
#include "app/plan/courses.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/settling.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace osculate::app {

namespace {

time::StepLimits step_limits(const Draft& draft, const scene::Stage& spec, bool dynamic) {
    time::StepLimits limits;
    constexpr double in_dynamics = 0.05, in_statics = 0.5; // of the facet size
    const scene::RelativeLength g_p = spec.control.allowed_interpenetration.value_or(
        scene::RelativeLength{dynamic ? in_dynamics : in_statics, false});
    limits.allowed_interpenetration = g_p.value;
    limits.in_metres = g_p.metres;
    limits.usual_bound = !dynamic && !spec.control.allowed_interpenetration;
    if (spec.control.error_tolerance) limits.error_tolerance = *spec.control.error_tolerance;
    if (dynamic) limits.energy_tolerance = spec.control.energy_tolerance;
    if (dynamic && spec.control.step_size == scene::StepSize::controlled) {
        if (!spec.control.error_tolerance) limits.velocity_error = spec.control.velocity_error;
        limits.closing_energy = spec.control.closing_energy;
    }
    const auto* analysis = std::get_if<scene::DynamicAnalysis>(&spec.analysis);
    if (analysis != nullptr && analysis->impacts == scene::Impacts::inelastic) {
        limits.inelastic_impacts = true; // where steps would be cut for an error, also if step_size is fixed
        limits.velocity_error = spec.control.velocity_error;
        limits.closing_energy = spec.control.closing_energy;
    }
    if (draft.audited()) limits.audited_depth = draft.scene.solver.audited_depth;
    limits.dt_max = spec.duration / spec.steps;
    limits.dt_min = draft.scene.solver.smallest_step * limits.dt_max;
    limits.growth = spec.control.growth;
    limits.easy_iterations = draft.scene.solver.max_iterations;
    return limits;
}

equilibrium::Integrator integrator(const scene::DynamicAnalysis& analysis) {
    return std::visit(Overloaded{
                          [](const scene::GeneralisedAlpha& s) { return equilibrium::generalised_alpha(s.rho_inf); },
                          [](const scene::Newmark& s) { return equilibrium::newmark(s.beta, s.gamma); },
                          [](const scene::Hht& s) { return equilibrium::hht(s.alpha); },
                          [](const scene::BackwardEuler&) { return equilibrium::backward_euler(); },
                      },
                      analysis.integrator);
}

void add_pressure(const Draft& draft, const std::string& set_name, double pressure, Field& force) {
    for (const mesh::SurfaceFace& face : draft.faces(draft.set(set_name)))
        fe::add_pressure_forces(face, draft.plan.model.X, pressure, force.values());
}

/// Adds a force and a moment at the reference point of a rigid body or coupling.
void add_at_point(const Draft& draft, const std::string& name, const Vec3& force, const Vec3& moment, Field& forces) {
    if (const auto spread = draft.spreads.find(name); spread != draft.spreads.end())
        return spread->second.add(force, moment, forces);
    const model::RigidBody& rigid = draft.rigid(name);
    forces[static_cast<std::size_t>(rigid.reference)] += force;
    forces[static_cast<std::size_t>(rigid.rotation())] += moment / rigid.radius; // a force at the radius
}

/// Loads that follow no course.
Field ramped_forces(const Draft& draft, const Driving& driving) {
    Field force(draft.plan.model.X.size());
    for (const auto& [set_name, value] : driving.pressure) add_pressure(draft, set_name, ramped(value), force);
    for (const auto& [body, b] : driving.body_force)
        model::add_body_force(draft.plan.model.bodies[draft.body_index(body)],
                              {ramped(b[0]), ramped(b[1]), ramped(b[2])}, force);
    for (const auto& [name, c] : driving.centrifugal) {
        const model::Body& body = draft.plan.model.bodies[draft.body_index(name)];
        model::add_centrifugal_force(body, c.axis.point - draft.plan.model.origin, c.axis.direction.normalized(),
                                     c.speed, force);
    }
    for (const auto& [set_name, f] : driving.nodal_force)
        for (const Index node : draft.set(set_name).nodes)
            force[static_cast<std::size_t>(node)] += Vec3(ramped(f[0]), ramped(f[1]), ramped(f[2]));
    for (const auto& [body, f] : driving.force)
        add_at_point(draft, body, {ramped(f[0]), ramped(f[1]), ramped(f[2])}, Vec3::Zero(), force);
    for (const auto& [body, m] : driving.moment)
        add_at_point(draft, body, Vec3::Zero(), {ramped(m[0]), ramped(m[1]), ramped(m[2])}, force);
    return force;
}

void add_course_forces(const Draft& draft, const Driving& driving, CourseList& courses,
                       std::vector<time::CourseForce>& forces) {
    Field pattern; // of one force
    const auto add = [&](const std::string& name, const scene::Course& course, auto&& make) {
        pattern.reset(draft.plan.model.X.size());
        make();
        forces.push_back({courses.index(name, course), SparseField(pattern)});
    };
    for (const auto& [set_name, value] : driving.pressure)
        if (!value.is_value())
            add("pressure." + set_name, value,
                [&, &set_name = set_name] { add_pressure(draft, set_name, 1, pattern); });
    const auto add_components = [&](const std::string& key, const auto& vectors, auto&& make) {
        for (const auto& [name, components] : vectors)
            for (int k = 0; k < 3; ++k)
                if (const scene::Course& course = components[static_cast<std::size_t>(k)]; !course.is_value())
                    add(key + "." + name + "." + std::string(1, "xyz"[k]), course,
                        [&, &name = name] { make(name, Vec3::Unit(k)); });
    };
    add_components("body_force", driving.body_force, [&](const std::string& body, const Vec3& unit) {
        model::add_body_force(draft.plan.model.bodies[draft.body_index(body)], unit, pattern);
    });
    add_components("nodal_force", driving.nodal_force, [&](const std::string& set, const Vec3& unit) {
        for (const Index node : draft.set(set).nodes) pattern[static_cast<std::size_t>(node)] = unit;
    });
    add_components("force", driving.force, [&](const std::string& body, const Vec3& unit) {
        add_at_point(draft, body, unit, Vec3::Zero(), pattern);
    });
    add_components("moment", driving.moment, [&](const std::string& body, const Vec3& unit) {
        add_at_point(draft, body, Vec3::Zero(), unit, pattern);
    });
}

/// Held and driven components of rigid bodies and couplings, at their own nodes.
void add_rigid_constraints(const Draft& draft, const Driving& driving, CourseList& courses,
                           std::vector<linear::NodeConstraint>& constraints) {
    for (const model::RigidBody& rigid : draft.plan.model.rigid) {
        const std::string& name = rigid.name;
        const std::array<bool, 6>& fixed = rigid.coupling ? scene::find(draft.scene.couplings, name)->fixed
                                                          : scene::find(draft.scene.bodies, name)->rigid->fixed;
        const auto motion = driving.motion.find(name);
        for (std::size_t k = 0; k < 6; ++k) {
            const bool moved = motion != driving.motion.end() && motion->second[k];
            if (!moved && !fixed[k]) continue;
            const double unit = k < 3 ? 1 : rigid.radius; // a rotation is the path of a point at the radius
            linear::NodeConstraint held;
            held.node = k < 3 ? rigid.reference : rigid.rotation();
            held.direction = Vec3::Unit(static_cast<Eigen::Index>(k % 3));
            held.driven = moved;
            if (moved) {
                const scene::Course& value = *motion->second[k];
                if (!value.is_value())
                    held.course = courses.index(
                        "motion." + name + "." + (k < 3 ? "" : "r") + std::string(1, "xyz"[k % 3]), value);
                held.target = unit * (value.is_value() ? value.value() : 1);
            }
            constraints.push_back(held);
        }
    }
}

void add_constraints(const Draft& draft, const Driving& driving, CourseList& courses,
                     std::vector<linear::NodeConstraint>& constraints) {
    for (std::size_t s = 0; s < draft.plan.model.sets.size(); ++s) {
        const model::Set& group = draft.plan.model.sets[s];
        const scene::Support* support = scene::find(draft.scene.supports, group.name);
        const auto motion = driving.displacement.find(group.name);
        for (int k = 0; k < 3; ++k) {
            const bool moved = motion != driving.displacement.end() && motion->second[static_cast<std::size_t>(k)];
            const auto let_go = driving.released.find(group.name);
            const bool released = let_go != driving.released.end() && let_go->second[static_cast<std::size_t>(k)];
            const bool fixed = support != nullptr && !released &&
                               (support->fixed[static_cast<std::size_t>(k)] || (support->symmetry && k == 0));
            if (!moved && !fixed) continue;
            double target = 0;
            Index course = -1;
            if (moved) {
                const scene::Course& value = *motion->second[static_cast<std::size_t>(k)];
                if (!value.is_value())
                    course = courses.index("displacement." + group.name + "." + std::string(1, "xyz"[k]), value);
                target = value.is_value() ? value.value() : 1;
            }
            for (const Index node : group.nodes)
                constraints.push_back({node, axes_at(draft, support, node).col(k), target, moved,
                                       support != nullptr && support->symmetry, static_cast<Index>(s), course});
        }
    }
}

/// Nodes of a set, or of a body.
std::vector<Index> nodes_of_part(Draft& draft, const std::string& part, const std::string& key) {
    std::vector<Index> nodes;
    for (const model::Set& set : draft.plan.model.sets)
        if (set.name == part) nodes = set.nodes;
    for (const model::Body& body : draft.plan.model.bodies)
        if (body.name == part && nodes.empty())
            for (Index i = 0; i < body.nodes(); ++i) nodes.push_back(body.first_node + i);
    if (nodes.empty()) {
        draft.faults.push_back(fault(key + "." + part, "the name of a body or set", "'" + part + "'"));
    } else if (const model::Body& body = *model::body_of(draft.plan.model, nodes.front());
               body.rigid || !body.grows()) {
        draft.faults.push_back(fault(key + "." + part, "a body that deforms and has a thermal expansion",
                                     "'" + body.name + "', which does not grow"));
    }
    return nodes;
}

} // namespace

namespace {
/// Symmetries hold where the axis is theirs, and only what has mass is thrown outward.
void check_centrifugal(Draft& draft, const std::string& key, const std::string& name, const scene::Centrifugal& c) {
    constexpr double same = 1e-9; // of unit vectors, and of the distance
    const model::Model& m = draft.plan.model;
    const Index b = draft.body_index(name);
    const auto is_other = [&](const Vec3& point, const Vec3& axis) {
        const Vec3 n = axis.normalized(), d = c.axis.direction.normalized(), arm = c.axis.point - point;
        return n.cross(d).norm() > same || (arm - n.dot(arm) * n).norm() > same * (arm.norm() + c.axis.point.norm());
    };
    if (m.bodies[static_cast<std::size_t>(b)].rigid)
        draft.faults.push_back(fault(key, "a body that deforms", "a rigid one"));
    else if (!m.bodies[static_cast<std::size_t>(b)].has_mass())
        draft.faults.push_back(fault("bodies." + name + ".material", "a density, for " + key, "none"));
    for (const model::CyclicSymmetry& ring : draft.rings)
        if (ring.body == b && is_other(ring.point + m.origin, ring.axis))
            draft.faults.push_back(fault(key + ".axis", "the axis of cyclic." + ring.name, "another"));
    const auto& slice = draft.scene.bodies[static_cast<std::size_t>(b)].second.slice;
    if (slice && slice->kind == scene::SliceKind::axisymmetric && is_other(slice->point, slice->axis))
        draft.faults.push_back(fault(key + ".axis", "the axis of bodies." + name + ".slice", "another"));
    if (slice && slice->kind != scene::SliceKind::axisymmetric &&
        slice->axis.normalized().cross(c.axis.direction.normalized()).norm() > same)
        draft.faults.push_back(fault(key + ".axis", "the normal of bodies." + name + ".slice", "another direction"));
}

/// What follows other nodes does so for the whole run, in the directions that supports leave free at its start.
void check_releases(Draft& draft) {
    const model::Model& m = draft.plan.model;
    std::vector<Index> bound = model::dependent_nodes(m);
    for (const model::SkinNode& one : m.skin) bound.push_back(one.host);
    std::ranges::sort(bound);
    Driving held; // so far
    for (const auto& [name, stage] : draft.scene.stages) {
        for (const auto& [set, components] : stage.release)
            for (std::size_t k = 0; k < 3; ++k) {
                const scene::Support* support = scene::find(draft.scene.supports, set);
                const bool driven = held.displacement.contains(set) && held.displacement[set][k],
                           fixed = support != nullptr && support->fixed[k] && !held.released[set][k];
                if (components[k] && !driven && !fixed)
                    draft.faults.push_back(fault("stages." + name + ".release." + set,
                                                 "components that its support or the displacement of an earlier stage "
                                                 "holds",
                                                 std::string(1, "xyz"[k]) + ", which is free"));
            }
        held.update(stage);
        for (const auto& [set, components] : stage.release)
            for (const Index node : draft.set(set).nodes)
                if (std::ranges::binary_search(bound, node)) {
                    const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
                    draft.faults.push_back(
                        fault("stages." + name + ".release." + set,
                              "nodes that follow no others, and no face with midside nodes in contact",
                              fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m that does", X[0], X[1], X[2])));
                    break;
                }
    }
}
} // namespace

/// Held directions of every stage and external forces at its ends.
void add_stages(Draft& draft) {
    check_releases(draft);
    Driving now;          // keeps its values in later stages
    bool settled = false; // courses of the stage before have become values
    for (const auto& [name, spec] : draft.scene.stages) {
        time::Stage stage;
        stage.name = name;
        stage.duration = spec.duration;
        stage.steps = spec.steps;
        stage.ramp = spec.ramp;
        if (const auto* analysis = std::get_if<scene::DynamicAnalysis>(&spec.analysis)) {
            stage.dynamics = equilibrium::Dynamics{integrator(*analysis), analysis->mass == scene::MassMatrix::lumped,
                                                   analysis->mass_damping, analysis->stiffness_damping.value(), 0};
            if (analysis->impacts == scene::Impacts::inelastic)
                stage.dynamics->recovery_time = recovery_time(spec.duration / spec.steps);
        }
        const bool dynamic = stage.dynamics.has_value();
        stage.limits = step_limits(draft, spec, dynamic);
        stage.follow_paths = dynamic && (!draft.scene.contact.empty() || draft.scene.general);
        const Driving before = now;
        now.update(spec);
        CourseList courses(stage.courses);
        add_constraints(draft, now, courses, stage.constraints);
        add_rigid_constraints(draft, now, courses, stage.constraints);
        const bool varying = now.has_load_courses();
        if (draft.plan.stages.empty() || settled || varying)
            stage.force_start = SparseField(ramped_forces(draft, before.without_courses_of(now)));
        else
            stage.force_start = draft.plan.stages.back().force_end;
        stage.force_end = SparseField(ramped_forces(draft, now));
        if (varying) add_course_forces(draft, now, courses, stage.course_forces);
        for (const auto& [set_name, value] : now.follower_pressure) {
            const auto was = before.follower_pressure.find(set_name);
            const bool known = was != before.follower_pressure.end();
            stage.follower_pressures.push_back(
                {draft.faces(draft.set(set_name)), known ? ramped(was->second) : 0, ramped(value),
                 value.is_value() ? -1 : courses.index("follower_pressure." + set_name, value)});
        }
        for (const auto& [part, value] : now.temperature) {
            const auto was = std::ranges::find(before.temperature, part, [](const auto& one) { return one.first; });
            stage.temperatures.push_back({nodes_of_part(draft, part, "stages." + name + ".temperature"),
                                          was != before.temperature.end() ? ramped(was->second) : 0, ramped(value),
                                          value.is_value() ? -1 : courses.index("temperature." + part, value)});
        }
        for (const auto& [body, c] : spec.centrifugal)
            check_centrifugal(draft, "stages." + name + ".centrifugal." + body, body, c);
        for (const auto& [key, loaded] :
             {std::pair{"pressure", &now.pressure}, std::pair{"follower_pressure", &now.follower_pressure}})
            for (const auto& [set_name, value] : *loaded)
                if (draft.set(set_name).facets.empty())
                    draft.faults.push_back(fault("stages." + name + "." + key + "." + set_name, "a set with facets",
                                                 "a set of nodes that cover no facet"));
        now.settle(spec.duration);
        settled = varying;
        try {
            (void)linear::Constraints(draft.plan.model.nodes(), stage.constraints);
        } catch (const std::invalid_argument& error) {
            draft.faults.push_back(fault("supports", "compatible directions at every node", error.what()));
        }
        draft.plan.stages.push_back(std::move(stage));
    }
    for (std::size_t s = 0; s < draft.plan.model.sets.size(); ++s) {
        const std::string& name = draft.plan.model.sets[s].name;
        if (scene::find(draft.scene.supports, name) != nullptr || now.displacement.contains(name))
            draft.plan.constrained_sets.push_back(static_cast<Index>(s));
    }
}

} // namespace osculate::app
