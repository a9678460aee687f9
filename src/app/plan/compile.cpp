#include "osculate/app/compile.hpp"

#include "app/fault.hpp"
#include "app/overloaded.hpp"
#include "app/plan/contact_pairs.hpp"
#include "app/plan/courses.hpp"
#include "app/plan/gaps.hpp"
#include "app/plan/plan_items.hpp"
#include "app/plan/planned_probe.hpp"
#include "app/plan/supports.hpp"
#include "app/report/plots.hpp"
#include "osculate/core/error.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/quality.hpp"
#include "osculate/mesh/select.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/scene/nearest.hpp"
#include "osculate/time/collision_check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

namespace osculate::app {

namespace {

linear::LinearSolver linear_solver(scene::LinearSolver solver) {
    switch (solver) {
    case scene::LinearSolver::automatic: return linear::LinearSolver::automatic;
    case scene::LinearSolver::condensed: return linear::LinearSolver::condensed;
    case scene::LinearSolver::iterative: return linear::LinearSolver::iterative;
    case scene::LinearSolver::multigrid: return linear::LinearSolver::multigrid;
    case scene::LinearSolver::direct: return linear::LinearSolver::direct;
    }
    throw std::logic_error("linear solver without a name");
}

class Compiler {
public:
    Compiler(const scene::Scene& scene, int threads, Timings& timings)
        : scene_(scene), threads_(threads), timings_(timings) {}

    Plan run(std::vector<mesh::Mesh> meshes) {
        require(meshes.size() == scene_.bodies.size(), "compile: one mesh per body");
        move_origin(meshes);
        add_bodies(std::move(meshes));
        throw_faults(); // nothing below can be trusted on a broken mesh
        add_sets();
        throw_faults();
        add_stages();
        add_pairs();
        throw_faults();
        check_supports();
        check_gaps();
        plan_.probes = make_probes(scene_, plan_.model, faults_);
        throw_faults();
        check_plots(scene_, plan_, faults_);
        throw_faults();
        {
            const ScopedTimer timer(timings_, Part::assembly);
            plan_.model.K = model::assemble_stiffness(plan_.model.bodies, plan_.model.nodes());
            if (std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const auto& body) {
                    return !std::holds_alternative<scene::LinearElastic>(body.second.material);
                }))
                plan_.model.finite_strain = std::make_unique<model::FiniteStrain>(plan_.model.bodies, plan_.model.K);
            add_mass();
            leave_steps_where_mass_lands();
            add_gravity();
        }
        plan_.stepper = {scene_.solver.tolerance,
                         scene_.solver.max_iterations,
                         0,
                         scene_.solver.predictor,
                         scene_.solver.stabilisation,
                         threads_,
                         linear_solver(scene_.solver.linear_solver),
                         audited()};
        plan_.items = plan_items(scene_, plan_);
        return std::move(plan_);
    }

private:
    void throw_faults() {
        if (!faults_.empty()) throw SceneError(std::move(faults_));
    }

    /// A body alone that is deformed little meets nothing, not even itself.
    [[nodiscard]] bool audited() const {
        const auto linear = [](const auto& body) {
            return std::holds_alternative<scene::LinearElastic>(body.second.material);
        };
        return scene_.solver.audit && (scene_.bodies.size() > 1 || !std::ranges::all_of(scene_.bodies, linear));
    }

    /// Far from the scene's origin positions have few digits left for gaps: they are taken from the middle of all bodies.
    void move_origin(std::vector<mesh::Mesh>& meshes) {
        constexpr double far = 8; // half diagonals: three of 53 bits
        Eigen::AlignedBox3d box;
        for (const mesh::Mesh& m : meshes)
            for (const Vec3& X : m.nodes) box.extend(X);
        if (!(box.center().norm() > far * 0.5 * box.diagonal().norm())) return;
        plan_.model.origin = box.center();
        for (mesh::Mesh& m : meshes)
            for (Vec3& X : m.nodes) X -= plan_.model.origin;
    }

    void add_bodies(std::vector<mesh::Mesh> meshes) {
        for (std::size_t b = 0; b < meshes.size(); ++b) {
            const auto& [name, spec] = scene_.bodies[b];
            for (const std::string& what : mesh::faults(meshes[b]))
                faults_.push_back(fault("bodies." + name + ".mesh", "a sound mesh", what));
            model::Body body;
            body.name = name;
            body.density = scene::elastic(spec.material).density;
            body.mesh = std::move(meshes[b]);
            body.first_node = plan_.model.nodes();
            for (const mesh::ElementBlock& block : body.mesh.blocks)
                body.kernels.push_back(kernel(block.type, formulation(spec.hex_formulation), spec.material));
            plan_.model.X.insert(plan_.model.X.end(), body.mesh.nodes.begin(), body.mesh.nodes.end());
            exterior_.push_back(mesh::exterior_facets(body.mesh));
            plan_.model.bodies.push_back(std::move(body));
        }
    }

    static std::unique_ptr<fe::ElementKernel> kernel(mesh::CellType type, fe::HexFormulation formulation,
                                                     const scene::Material& spec) {
        const material::LinearElastic elastic{scene::elastic(spec).E, scene::elastic(spec).nu};
        return std::visit(Overloaded{
                              [&](const scene::LinearElastic&) { return fe::make_kernel(type, formulation, elastic); },
                              [&](const scene::SaintVenantKirchhoff&) {
                                  return fe::make_kernel(type, formulation, material::SaintVenantKirchhoff(elastic));
                              },
                              [&](const scene::NeoHookean&) {
                                  return fe::make_kernel(type, formulation, material::NeoHookean(elastic));
                              },
                          },
                          spec);
    }

    static fe::HexFormulation formulation(scene::HexFormulation f) {
        switch (f) {
        case scene::HexFormulation::full: return fe::HexFormulation::full;
        case scene::HexFormulation::b_bar: return fe::HexFormulation::b_bar;
        case scene::HexFormulation::incompatible_modes: return fe::HexFormulation::incompatible_modes;
        }
        throw InternalError("unknown hex formulation");
    }

    Index body_index(const std::string& name) const {
        for (std::size_t b = 0; b < scene_.bodies.size(); ++b)
            if (scene_.bodies[b].first == name) return static_cast<Index>(b);
        throw InternalError("the scene names a body it does not have");
    }

    const model::Set& set(const std::string& name) const {
        for (const model::Set& s : plan_.model.sets)
            if (s.name == name) return s;
        throw InternalError("the scene names a set it does not have");
    }

    /// Faces of a set, global nodes.
    std::vector<mesh::SurfaceFace> faces(const model::Set& set) const {
        const model::Body& body = plan_.model.bodies[static_cast<std::size_t>(set.body)];
        return mesh::surface_faces(body.mesh, set.facets, body.first_node);
    }

    /// A part that the mesh names; one fault when it does not.
    mesh::Region select(const std::string& set_name, const std::string& body, const scene::SelectNamed& s,
                        const mesh::Mesh& m, const std::vector<mesh::Facet>& exterior) {
        if (auto named = mesh::select_named(m, exterior, s.name)) return *named;
        std::vector<std::string> known;
        for (const auto& [surface, facets] : m.surfaces) known.push_back(surface);
        for (const auto& [nodes, list] : m.node_sets)
            if (!m.surfaces.contains(nodes)) known.push_back(nodes);
        std::string names;
        for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
        faults_.push_back(fault("sets." + set_name + (s.nodes ? ".nodes" : ".surface"),
                                "a surface or node set of body '" + body + "' (it has " + names + ")",
                                "'" + s.name + "'"));
        faults_.back().nearest = scene::nearest(s.name, known);
        return {};
    }

    void add_sets() {
        for (const auto& [name, spec] : scene_.sets) {
            const Index b = body_index(spec.body);
            const mesh::Mesh& m = plan_.model.bodies[b].mesh;
            const auto& exterior = exterior_[b];
            const std::size_t before = faults_.size();
            const Vec3& o = plan_.model.origin;
            const mesh::Region region = std::visit(
                Overloaded{
                    [&](const scene::SelectNamed& s) { return select(name, spec.body, s, m, exterior); },
                    [&](const scene::SelectPlane& s) { return mesh::select_plane(m, exterior, s.point - o, s.normal); },
                    [&](const scene::SelectCylinder& s) {
                        return mesh::select_cylinder(m, exterior, s.point - o, s.axis, s.radius);
                    },
                    [&](const scene::SelectBox& s) { return mesh::select_box(m, exterior, s.min - o, s.max - o); },
                    [&](const scene::SelectNormal& s) {
                        return mesh::select_normal(m, exterior, s.direction, s.angle);
                    },
                },
                spec.select);
            if (region.nodes.empty() && faults_.size() == before)
                faults_.push_back(fault("sets." + name, "at least one node of body '" + spec.body + "'",
                                        "an empty set: nothing lies there"));
            model::Set global{name, b, region.nodes, region.facets};
            const Index shift = plan_.model.bodies[b].first_node;
            for (Index& node : global.nodes) node += shift;
            for (mesh::Facet& facet : global.facets)
                for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += shift;
            plan_.model.sets.push_back(std::move(global));
        }
    }

    [[nodiscard]] time::StepLimits step_limits(const scene::Stage& spec, bool dynamic) const {
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
        if (audited()) limits.audited_depth = scene_.solver.audited_depth;
        limits.dt_max = spec.duration / spec.steps;
        limits.dt_min = scene_.solver.smallest_step * limits.dt_max;
        limits.growth = spec.control.growth;
        limits.easy_iterations = scene_.solver.max_iterations;
        return limits;
    }

    /// Held directions of every stage and external forces at its ends.
    void add_stages() {
        Driving now;          // keeps its values in later stages
        bool settled = false; // courses of the stage before have become values
        for (const auto& [name, spec] : scene_.stages) {
            time::Stage stage;
            stage.name = name;
            stage.duration = spec.duration;
            stage.steps = spec.steps;
            stage.ramp = spec.ramp;
            if (const auto* analysis = std::get_if<scene::DynamicAnalysis>(&spec.analysis)) {
                stage.dynamics =
                    equilibrium::Dynamics{integrator(*analysis), analysis->mass == scene::MassMatrix::lumped,
                                          analysis->mass_damping, analysis->stiffness_damping};
            }
            const bool dynamic = stage.dynamics.has_value();
            stage.limits = step_limits(spec, dynamic);
            stage.follow_paths = dynamic && !scene_.contact.empty();
            const Driving before = now;
            now.update(spec);
            CourseList courses(stage.courses);
            add_constraints(now, courses, stage.constraints);
            const bool varying = now.has_load_courses();
            if (plan_.stages.empty() || settled || varying)
                stage.force_start = ramped_forces(before.without_courses_of(now));
            else
                stage.force_start = plan_.stages.back().force_end;
            stage.force_end = ramped_forces(now);
            if (varying) add_course_forces(now, courses, stage.course_forces);
            for (const auto& [set_name, value] : now.follower_pressure) {
                const auto was = before.follower_pressure.find(set_name);
                const bool known = was != before.follower_pressure.end();
                stage.follower_pressures.push_back(
                    {faces(set(set_name)), known ? ramped(was->second) : 0, ramped(value),
                     value.is_value() ? -1 : courses.index("follower_pressure." + set_name, value)});
            }
            for (const auto& [key, loaded] :
                 {std::pair{"pressure", &now.pressure}, std::pair{"follower_pressure", &now.follower_pressure}})
                for (const auto& [set_name, value] : *loaded)
                    if (set(set_name).facets.empty())
                        faults_.push_back(fault("stages." + name + "." + key + "." + set_name, "a set with facets",
                                                "a set of nodes that cover no facet"));
            now.settle(spec.duration);
            settled = varying;
            try {
                (void)linear::Constraints(plan_.model.nodes(), stage.constraints);
            } catch (const std::invalid_argument& error) {
                faults_.push_back(fault("supports", "compatible directions at every node", error.what()));
            }
            plan_.stages.push_back(std::move(stage));
        }
        for (std::size_t s = 0; s < plan_.model.sets.size(); ++s) {
            const std::string& name = plan_.model.sets[s].name;
            if (scene::find(scene_.supports, name) != nullptr || now.displacement.contains(name))
                plan_.constrained_sets.push_back(static_cast<Index>(s));
        }
    }

    void add_pressure(const std::string& set_name, double pressure, std::vector<Vec3>& force) const {
        for (const mesh::SurfaceFace& face : faces(set(set_name)))
            fe::add_pressure_forces(face, plan_.model.X, pressure, force);
    }

    /// Loads that follow no course.
    [[nodiscard]] std::vector<Vec3> ramped_forces(const Driving& driving) const {
        std::vector<Vec3> force(plan_.model.X.size(), Vec3::Zero());
        for (const auto& [set_name, value] : driving.pressure) add_pressure(set_name, ramped(value), force);
        for (const auto& [body, b] : driving.body_force)
            model::add_body_force(plan_.model.bodies[body_index(body)], {ramped(b[0]), ramped(b[1]), ramped(b[2])},
                                  force);
        return force;
    }

    void add_course_forces(const Driving& driving, CourseList& courses, std::vector<time::CourseForce>& forces) const {
        const auto pattern = [&](const std::string& name, const scene::Course& course) -> std::vector<Vec3>& {
            forces.push_back({courses.index(name, course), std::vector<Vec3>(plan_.model.X.size(), Vec3::Zero())});
            return forces.back().pattern;
        };
        for (const auto& [set_name, value] : driving.pressure)
            if (!value.is_value()) add_pressure(set_name, 1, pattern("pressure." + set_name, value));
        for (const auto& [body, components] : driving.body_force)
            for (int k = 0; k < 3; ++k)
                if (const scene::Course& course = components[static_cast<std::size_t>(k)]; !course.is_value())
                    model::add_body_force(plan_.model.bodies[body_index(body)], Vec3::Unit(k),
                                          pattern("body_force." + body + "." + std::string(1, "xyz"[k]), course));
    }

    static equilibrium::Integrator integrator(const scene::DynamicAnalysis& analysis) {
        return std::visit(
            Overloaded{
                [](const scene::GeneralisedAlpha& s) { return equilibrium::generalised_alpha(s.rho_inf); },
                [](const scene::Newmark& s) { return equilibrium::newmark(s.beta, s.gamma); },
                [](const scene::Hht& s) { return equilibrium::hht(s.alpha); },
                [](const scene::BackwardEuler&) { return equilibrium::backward_euler(); },
            },
            analysis.integrator);
    }

    /// Nodes without mass of their own: slave nodes, where the scene asks for it.
    [[nodiscard]] std::vector<char> massless_nodes() const {
        std::vector<char> massless;
        for (const auto& [name, stage] : scene_.stages) {
            const auto* dynamic = std::get_if<scene::DynamicAnalysis>(&stage.analysis);
            if (dynamic == nullptr || dynamic->contact_mass == scene::ContactMass::kept) continue;
            massless.assign(plan_.model.X.size(), 0);
            for (const auto& pair : plan_.model.pairs)
                for (const Index node : pair->slaves().node) massless[static_cast<std::size_t>(node)] = 1;
            break;
        }
        return massless;
    }

    /// Masses and velocities, where a stage is dynamic.
    void add_mass() {
        model::Model& m = plan_.model;
        const std::vector<char> massless = massless_nodes();
        for (const time::Stage& stage : plan_.stages) {
            if (!stage.dynamics) continue;
            linear::BlockMatrix& mass = stage.dynamics->lumped_mass ? m.lumped_mass : m.consistent_mass;
            if (mass.empty()) {
                model::AssembledMass assembled =
                    model::assemble_mass(m.bodies, m.nodes(), stage.dynamics->lumped_mass, massless);
                mass = std::move(assembled.M);
                std::vector<Index> kept;
                std::ranges::set_union(m.kept_contact_mass, assembled.kept, std::back_inserter(kept));
                m.kept_contact_mass = std::move(kept);
            }
            if (!m.initial_velocity.empty()) continue;
            for (std::size_t b = 0; b < m.bodies.size(); ++b) {
                const model::Body& body = m.bodies[b];
                const scene::Body& spec = scene_.bodies[b].second;
                const Vec3 centre = model::centre_of_mass(body);
                for (const Vec3& X : body.mesh.nodes)
                    m.initial_velocity.push_back(spec.initial_velocity + spec.initial_spin.cross(X - centre));
            }
        }
    }

    /// A node with mass loses its speed in the step in which it lands, however short that is, and rings the faster the
    /// shorter steps are: cuts for what landing costs would make it worse.
    void leave_steps_where_mass_lands() {
        if (plan_.model.kept_contact_mass.empty()) return;
        for (time::Stage& stage : plan_.stages)
            stage.limits.velocity_error = stage.limits.closing_energy = std::numeric_limits<double>::infinity();
    }

    /// Whose mass a stage weighs: its own, in statics that of the dynamic stage it leads to, or else comes from.
    [[nodiscard]] const equilibrium::Dynamics* weighed(std::size_t s) const {
        for (std::size_t k = s; k < plan_.stages.size(); ++k)
            if (plan_.stages[k].dynamics) return &*plan_.stages[k].dynamics;
        for (std::size_t k = s; k-- > 0;)
            if (plan_.stages[k].dynamics) return &*plan_.stages[k].dynamics;
        return nullptr;
    }

    /// In full from the start. It acts on mass where the mass is, so that bodies fall without strain, and in statics on the
    /// same mass, so that what rests goes on resting when inertia sets in.
    void add_gravity() {
        if (scene_.gravity.isZero(0)) return;
        const model::Model& m = plan_.model;
        for (std::size_t s = 0; s < plan_.stages.size(); ++s) {
            std::vector<Vec3> weight(m.X.size(), Vec3::Zero());
            if (const equilibrium::Dynamics* dynamics = weighed(s))
                m.mass(dynamics->lumped_mass)
                    .multiply_add(std::vector<Vec3>(m.X.size(), scene_.gravity), weight, threads_);
            else
                for (const model::Body& body : m.bodies)
                    if (body.density > 0) model::add_body_force(body, body.density * scene_.gravity, weight);
            for (auto* force : {&plan_.stages[s].force_start, &plan_.stages[s].force_end})
                for (std::size_t i = 0; i < weight.size(); ++i) (*force)[i] += weight[i];
        }
    }

    void add_constraints(const Driving& driving, CourseList& courses,
                         std::vector<linear::NodeConstraint>& constraints) const {
        for (std::size_t s = 0; s < plan_.model.sets.size(); ++s) {
            const model::Set& group = plan_.model.sets[s];
            const scene::Support* support = scene::find(scene_.supports, group.name);
            const auto motion = driving.displacement.find(group.name);
            const Mat3 axes = support != nullptr ? support->axes : Mat3::Identity();
            for (int k = 0; k < 3; ++k) {
                const bool moved = motion != driving.displacement.end() && motion->second[static_cast<std::size_t>(k)];
                const bool fixed = support != nullptr &&
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
                    constraints.push_back({node, axes.col(k), target, moved, support != nullptr && support->symmetry,
                                           static_cast<Index>(s), course});
            }
        }
    }

    /// How many facets of a set belong to six-node faces.
    Index facets_of_six_node_faces(const model::Set& set) const {
        const auto& blocks = plan_.model.bodies[static_cast<std::size_t>(set.body)].mesh.blocks;
        return static_cast<Index>(std::ranges::count_if(set.facets, [&](const mesh::Facet& facet) {
            return blocks[static_cast<std::size_t>(facet.block)].type == mesh::CellType::tet10;
        }));
    }

    void add_pairs() {
        const bool paths = std::ranges::any_of(plan_.stages, &time::Stage::follow_paths);
        for (const auto& [name, spec] : scene_.contact) {
            const model::Set& slave = set(spec.slave);
            const model::Set& master = set(spec.master.set);
            const std::string key = "contact." + name;
            bool broken = false;
            for (const auto& [part, group] : {std::pair{".slave", &slave}, std::pair{".master.set", &master}})
                if (group->facets.empty()) {
                    faults_.push_back(fault(key + part, "a set with facets", "a set of nodes that cover no facet"));
                    broken = true;
                } else if (const Index six = facets_of_six_node_faces(*group); six > 0) {
                    // Their corners carry nothing under a uniform pressure, but contact has one law and one share of the
                    // area per node: linear shares on them would press with 0.8 to 1.7 times the pressure.
                    faults_.push_back(
                        fault(key + part,
                              "facets of hex8, wedge6 or tet4 elements (tet10 carries loads, but no contact: mesh this "
                              "body with `element: hex8` or `tet4`, `cad: {quadratic: false}` or C3D4)",
                              fmt::format("{} of its {} facets are parts of faces of tet10 elements of body '{}'", six,
                                          group->facets.size(), plan_.model.bodies[group->body].name)));
                    broken = true;
                }
            if (broken) continue;
            const ScopedTimer timer(timings_, Part::patches);
            try {
                plan_.model.pairs.push_back(make_contact_pair(scene_, name, spec, plan_.model, slave, master,
                                                              paths ? &exterior_[master.body] : nullptr));
            } catch (const std::runtime_error& error) {
                faults_.push_back(fault(key + ".master.set", "an oriented manifold surface", error.what()));
            }
        }
    }

    void check_supports() {
        if (std::all_of(plan_.stages.begin(), plan_.stages.end(),
                        [](const time::Stage& s) { return s.dynamics.has_value(); }))
            return; // inertia holds every body
        for (const std::string& body : unsupported_bodies(plan_))
            faults_.push_back(fault("bodies." + body, "supports or contact that hold the body",
                                    "free rigid-body motions: add supports, or a contact pair that touches it"));
    }

    void check_gaps() {
        for (std::size_t p = 0; p < plan_.model.pairs.size(); ++p) {
            model::ContactEvaluation evaluation(*plan_.model.pairs[p]);
            const PairGaps gaps = initial_gaps(evaluation, plan_.model.X, timings_, threads_);
            const double limit = scene_.contact[p].second.initial_overlap_limit;
            if (gaps.largest_overlap > limit)
                faults_.push_back(
                    fault("contact." + scene_.contact[p].first,
                          fmt::format("bodies that overlap by less than {:.3g} of the facet size at the start", limit),
                          fmt::format("an overlap of {:.4g} m at slave {}, {:.3g} of the facet size", -gaps.least,
                                      node_name(plan_.model, gaps.worst_node), gaps.largest_overlap)));
        }
    }

    const scene::Scene& scene_;
    int threads_;
    Timings& timings_;
    Plan plan_;
    std::vector<std::vector<mesh::Facet>> exterior_;
    std::vector<Fault> faults_;
};

} // namespace

Plan compile(const scene::Scene& scene, std::vector<mesh::Mesh> meshes, int threads, Timings& timings) {
    return Compiler(scene, threads, timings).run(std::move(meshes));
}

} // namespace osculate::app
