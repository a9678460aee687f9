/// Parts of a plan: what bodies do by themselves.

#include "app/plan/plan_items.hpp"
#include "osculate/linear/dependence.hpp"
#include "osculate/model/general_contact.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace osculate::app {

namespace {

constexpr const char* every_static = "every stage is static";

bool is_nonlinear(const model::Body& body) {
    return std::ranges::any_of(body.kernels, [](const auto& kernel) { return !kernel->linear(); });
}

/// Nonlinear elements, with their places in the stiffness.
PlanCost nonlinear_cost(const model::Model& model) {
    PlanCost cost{2 * bytes_of(model.K), 0, "elements an iteration"}; // the tangent and what of it is constant
    for (const model::Body& body : model.bodies) {
        if (!is_nonlinear(body)) continue;
        for (std::size_t b = 0; b < body.kernels.size(); ++b) {
            const double n = body.kernels[b]->nodes(), elements = body.mesh.blocks[b].size();
            cost.count += elements;
            cost.bytes += elements * (n + n * n) * sizeof(Index);
        }
    }
    return cost;
}

/// How many bodies have slave nodes, which is how many could have massless ones.
std::size_t bodies_with_slaves(const model::Model& model) {
    const std::vector<Index> general = model.general ? model.general->possible_slaves() : std::vector<Index>{};
    return static_cast<std::size_t>(std::ranges::count_if(model.bodies, [&](const model::Body& body) {
        const auto own = [&](Index any) {
            const Index node = model::material_node(model, any);
            return node >= body.first_node && node < body.first_node + body.nodes();
        };
        return std::ranges::any_of(general, own) || std::ranges::any_of(model.pairs, [&](const auto& pair) {
                   return std::ranges::any_of(pair->slaves().node, own);
               });
    }));
}

} // namespace

void add_body_items(const scene::Scene& scene, const Plan& plan, PlanList& list) {
    const model::Model& model = plan.model;
    const double blocks = model.K.row_end(model.K.rows() - 1),
                 vectors = sizeof(Vec3) * static_cast<double>(model.nodes());
    const bool nonlinear = model.nonlinear != nullptr;
    list.say("stiffness", true, nonlinear ? "of the linear elements, assembled once" : "assembled once: constant",
             {bytes_of(model.K), blocks, "3x3 blocks an iteration"});
    list.say("nonlinear elements", nonlinear,
             nonlinear ? "forces and tangent anew at every iterate" : "every body is linear",
             nonlinear ? nonlinear_cost(model) : PlanCost{});

    const auto following = [&](bool couplings) {
        double followers = 0;
        for (const model::RigidBody& one : model.rigid)
            if (one.coupling == couplings) followers += static_cast<double>(one.nodes.size());
        return PlanCost{followers * (sizeof(std::vector<int>) + 2 * sizeof(linear::Dependence::Carrier)), followers,
                        "nodes an iteration"};
    };
    const auto couplings = std::ranges::count_if(model.rigid, &model::RigidBody::coupling),
               rigid = static_cast<std::ptrdiff_t>(model.rigid.size()) - couplings;
    list.say("rigid bodies", rigid > 0,
             rigid == 0 ? "every body deforms"
                        : fmt::format("{} of {} bodies, six unknowns each", rigid, model.bodies.size()),
             following(false));
    list.say("couplings", couplings > 0,
             couplings == 0 ? "no nodes follow a reference point"
                            : fmt::format("{} of {:.0f} nodes, six unknowns each", couplings, following(true).count),
             following(true));

    double tied = 0, carriers = 0;
    for (const model::Tie& tie : model.ties)
        for (const model::TiedNode& node : tie.nodes) {
            ++tied;
            carriers += static_cast<double>(node.carriers.size());
        }
    list.say("ties", tied > 0,
             tied == 0
                 ? "no surfaces are glued together"
                 : fmt::format("{} of {:.0f} nodes, which have no unknowns of their own", model.ties.size(), tied),
             {carriers * sizeof(linear::Dependence::Carrier), carriers, "weights an iteration"});

    double ends = 0;
    for (const model::CyclicSymmetry& ring : model.cyclic) ends += static_cast<double>(ring.nodes.size());
    list.say("cyclic symmetry", ends > 0,
             ends == 0
                 ? "no body is a sector of a ring"
                 : fmt::format("{} of {:.0f} nodes, which have no unknowns of their own", model.cyclic.size(), ends),
             {ends * sizeof(linear::Dependence::Carrier), ends, "turned nodes an iteration"});

    double terms = 0;
    for (const model::LedNode& one : model.led) terms += static_cast<double>(one.by.size());
    list.say("equations", !model.led.empty(),
             model.led.empty() ? "displacements follow no equations of the scene"
                               : fmt::format("{}, each with one unknown less", model.led.size()),
             {terms * sizeof(linear::Dependence::Carrier), terms, "terms an iteration"});

    const std::size_t dynamic = dynamic_stages(plan);
    constexpr double states = 10; // u, v, a: of the state, of the start of the step and after it; force at the start
    list.say("inertia", dynamic > 0, dynamic > 0 ? fmt::format("{} dynamic stage(s)", dynamic) : every_static,
             {bytes_of(model.consistent_mass) + bytes_of(model.lumped_mass) + bytes_of(model.K) + states * vectors,
              2 * blocks, "3x3 blocks a step"});
    const auto damped = std::ranges::count_if(plan.stages, [](const time::Stage& stage) {
        return stage.dynamics && (stage.dynamics->mass_damping > 0 || stage.dynamics->stiffness_damping > 0);
    });
    list.say("damping", damped > 0,
             damped > 0    ? fmt::format("{} stage(s) with mass_damping or stiffness_damping", damped)
             : dynamic > 0 ? "no stage has mass_damping or stiffness_damping"
                           : every_static,
             {0, 2 * blocks, "3x3 blocks a step"});
    list.say("energy ledger", dynamic > 0,
             dynamic > 0 ? "judges dynamic steps, and columns of history.csv" : every_static,
             {0, 4 * blocks, "3x3 blocks a step"});
    const auto controlled = std::ranges::count_if(plan.stages, [](const time::Stage& stage) {
        return stage.dynamics &&
               (std::isfinite(stage.limits.error_tolerance) || std::isfinite(stage.limits.velocity_error));
    });
    list.say("time error control", controlled > 0,
             controlled > 0
                 ? fmt::format("{} stage(s) whose steps are cut for their error and for closing gaps", controlled)
             : dynamic > 0 ? "control.step_size is fixed"
                           : every_static,
             {0, blocks, "3x3 blocks a step"});
    const bool asked = std::ranges::any_of(scene.stages, [](const auto& stage) {
        const auto* analysis = std::get_if<scene::DynamicAnalysis>(&stage.second.analysis);
        return analysis != nullptr && analysis->contact_mass != scene::ContactMass::kept;
    });
    std::string keepers;
    for (const Index b : model.kept_contact_mass)
        keepers += fmt::format("{}'{}'", keepers.empty() ? "" : ", ", model.bodies[static_cast<std::size_t>(b)].name);
    const bool massless = asked && model.kept_contact_mass.size() < bodies_with_slaves(model);
    list.say("massless contact nodes", massless,
             !asked ? (dynamic > 0 ? "contact nodes keep their mass" : every_static)
             : keepers.empty()
                 ? massless ? "contact_mass: redistributed, with mass, centre and inertia of every body"
                            : "no body has slave nodes"
                 : fmt::format("{} of body {} keep their mass: no other nodes can carry its centre and inertia",
                               massless ? "contact_mass: redistributed, but the slave nodes" : "slave nodes", keepers));

    const bool gravity = !scene.gravity.isZero(0);
    list.say("gravity", gravity, gravity ? "on every body with a density" : "not given",
             {0, gravity ? static_cast<double>(plan.stages.size()) : 0, "sum(s) over all elements, once"});
    double faces = 0, values = 0;
    for (const time::Stage& stage : plan.stages) {
        double own = 0;
        for (const time::FollowerPressure& pressure : stage.follower_pressures)
            own += static_cast<double>(pressure.faces.size());
        faces = std::max(faces, own);
        values = std::max(values, static_cast<double>(stage.courses.size()));
    }
    list.say("follower pressure", faces > 0,
             faces > 0 ? "forces and tangent anew at every iterate" : "no pressure follows",
             {0, faces, "faces an iteration"});
    list.say("courses over time", values > 0,
             values > 0 ? "load(s) and motion(s) by tables or expressions"
                        : "every load and motion ramps or jumps to its value",
             {0, values, "value(s) a step"});
    const bool driven = std::ranges::any_of(plan.stages, [](const time::Stage& stage) {
        return !stage.dynamics && std::ranges::any_of(stage.constraints, &linear::NodeConstraint::driven);
    });
    list.say("predictor", driven && plan.stepper.predictor,
             !driven                  ? "no static stage moves a set"
             : plan.stepper.predictor ? "driven bodies are moved rigidly before the first iteration"
                                      : "solver.predictor is off",
             {0, static_cast<double>(model.nodes()), "nodes a step"});
    const bool shifted = !model.origin.isZero(0);
    list.say("moved origin", shifted,
             shifted ? "digits would be lost far from the scene's origin" : "the scene is near its origin");
}

} // namespace osculate::app
