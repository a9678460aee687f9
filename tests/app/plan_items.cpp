/// What the plan of every shipped scene holds and leaves out.

#include "support/scene_runner.hpp"

#include <gmock/gmock.h>
#include <iomanip>
#include <sstream>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

using testing::HasSubstr;
using testing::Not;

Plan plan_of(const std::string& path, const std::vector<scene::Override>& changes = {}) {
    const scene::Scene scene = scene::read_scene(path, changes);
    Timings timings;
    return compile(scene, build_meshes(scene), 1, timings);
}

const PlanItem& item(const Plan& plan, const std::string& part) {
    const auto at = std::ranges::find(plan.items, part, &PlanItem::part);
    if (at == plan.items.end()) throw std::out_of_range("no part " + part);
    return *at;
}

constexpr const char* scenes[] = {
    "tutorials/block_on_incline.yaml", "tutorials/bouncing_ball.yaml", "tutorials/contactor_in_half_tube.yaml",
    "tutorials/ring_on_cylinder.yaml", "tutorials/two_bars.yaml",      "paper/foundation_hybrid.yaml",
    "paper/foundation_quad.yaml",      "paper/foundation_tri.yaml",    "paper/half_tube.yaml",
    "paper/half_tube_dynamic.yaml",    "paper/half_tube_fast.yaml",    "paper/half_tube_line.yaml",
    "paper/half_tube_line_axial.yaml", "paper/half_tube_pressure.yaml"};

/// A row per part; x where it is in the plan of a scene, in the order above.
const std::string expected = R"(
stiffness                    x x x x x x x x x x x x x x
nonlinear elements           . . . x . . . . . . . . . .
rigid bodies                 . . . . . . . . . . . . . .
couplings                    . . . . . . . . . . . . . .
ties                         . . . . . . . . . . . . . .
cyclic symmetry              . . . . . . . . . . . . . .
equations                    . . . . . . . . . . . . . .
inertia                      x x x x x . . . . x x . . .
damping                      . . . . . . . . . . . . . .
energy ledger                x x x x x . . . . x x . . .
time error control           . x x x x . . . . x x . . .
massless contact nodes       . x x x x . . . . x x . . .
gravity                      x x . x . . . . . . . . . .
follower pressure            . . . . . . . . . . . . . .
courses over time            x . x . . . . . . x x . . .
predictor                    . . x . . . . . x x x x x x
moved origin                 . . . . . . . . . . . . . .
contact                      x x x x x x x x x x x x x x
general contact              . . . . . . . . . . . . . .
choice of slaves             . . . . . . . . . . . . . .
friction                     x . x x . x x x x x x x x x
smooth master surface        . . x x . x x x x x x x x x
mirror images                . . . . . . . . . . . . . .
averaged forces              . . . . . x x x x . . x x x
interpenetration control     x x x x x x x x x x x x x x
collision check              x x x x x . . . . x x . . .
multigrid                    . . . . . x x x . . . . . .
condensation                 x x x . x . . . x x x x x x
LU factorisation             . . . . . . . . . . . . . .
Cholesky factorisation       x x x x x . . . x x x x x x
GMRES                        x x x x x x x x x x x x x x
stabilisation springs        . . . . . . . . . . . . . .
audit of geometry            x x x x x x x x x x x x x x
threads                      . . . . . . . . . . . . . .
field displacement           x x x x x x x x x x x x x x
field velocity               . . . . . . . . . . . . . .
field acceleration           . . . . . . . . . . . . . .
field stress                 x . x . . x x x x x x x x x
field von_mises              x . x . . x x x x x x x x x
field stress_max             . . . . . . . . . . . . . .
field stress_mid             . . . . . . . . . . . . . .
field stress_min             . . . . . . . . . . . . . .
field strain                 . . . . . . . . . . . . . .
field energy_density         . . . . . . . . . . . . . .
field plastic_strain         . . . . . . . . . . . . . .
field reaction               x . x . . x x x x x x x x x
field out_of_balance         . . . . . . . . . . . . . .
field penetration            . . . . . . . . . . . . . .
field contact_force          . . . . . . . . . . . . . .
field contact_pressure       . . . . . . . . . . . . . .
field contact_gap            . . . . . . . . . . . . . .
field contact_status         . . . . . . . . . . . . . .
field contact_slip           . . . . . . . . . . . . . .
slave field gap              x . x . . x x x x x x x x x
slave field contact_force    x . x . . x x x x x x x x x
slave field normal_stress    x . x . . x x x x x x x x x
slave field tangential_traction . . . . . . . . . . . . . .
slave field friction_use     . . . . . . . . . . . . . .
slave field slip_rate        . . . . . . . . . . . . . .
slave field master_facet     . . . . . . . . . . . . . .
slave field slip             x . x . . x x x x x x x x x
slave field status           x . x . . x x x x x x x x x
slave field normal           x . x . . x x x x x x x x x
slave field area             . . . . . . . . . . . . . .
master field contact_force   x . x . . x x x x x x x x x
master field normal_stress   . . . . . . . . . . . . . .
frames                       x x x x x x x x x x x x x x
frames on a second thread    . . . . . . . . . . . . . .
nodal stresses               x . x . . x x x x x x x x x
nodal reactions              x . x . . x x x x x x x x x
history.csv                  x x x x x x x x x x x x x x
history of pairs             x x x x x x x x x x x x x x
history of reactions         x . x . . x x x x x x x x x
history of energies          x x x x x . . . . x x . . .
steps.csv                    x x x x x x x x x x x x x x
iterations.csv               . . . . . . . . . . . x x x
checks                       x x x x x x x x x x x x x x
probes                       . . x . . x x x x . . . . .
derivatives                  . . . . . . . . . . . . . .
gradients                    . . . . . . . . . . . . . .
plots                        . . . . . x x x x . . . . .
show_in_paraview.py          x . x . . x x x x x x x x x
report                       . . . . . . . . . . . . . .
expectation                  . . . . . . . . . . . . . .
post-mortem                  . . . . . . . . . . . . . .
failed iterate               . . . . . . . . . . . . . .
)";

TEST(PlanItems, OfEveryTutorialAndPaperSceneAreThese) {
    std::vector<std::pair<std::string, std::string>> rows;
    for (const char* scene : scenes) {
        const Plan plan = plan_of(support::shipped(scene));
        if (rows.empty())
            for (const PlanItem& part : plan.items) rows.emplace_back(part.part, "");
        ASSERT_EQ(plan.items.size(), rows.size()) << scene << ": every plan lists every part";
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const PlanItem& part = plan.items[i];
            EXPECT_EQ(part.part, rows[i].first) << scene;
            EXPECT_FALSE(part.reason.empty()) << scene << ": " << part.part;
            EXPECT_EQ(part.cost.count > 0, !part.cost.unit.empty() && part.present) << scene << ": " << part.part;
            EXPECT_TRUE(part.present || part.cost.bytes == 0) << scene << ": " << part.part;
            rows[i].second += part.present ? " x" : " .";
        }
    }
    std::ostringstream found;
    found << '\n';
    for (const auto& [part, row] : rows) found << std::left << std::setw(28) << part << row << '\n';
    EXPECT_EQ(found.str(), expected);
}

TEST(PlanItems, CostWhatIsHeldAndCounted) {
    const Plan plan = plan_of(support::shipped("paper/half_tube.yaml"));
    const model::Model& model = plan.model;
    // 27 neighbours of an inner node of hexahedra, fewer at the surface, most nodes of these thin bodies
    EXPECT_GT(item(plan, "stiffness").cost.count, 12 * model.nodes());
    EXPECT_LT(item(plan, "stiffness").cost.count, 27 * model.nodes());
    EXPECT_GE(item(plan, "stiffness").cost.bytes, sizeof(Mat3) * item(plan, "stiffness").cost.count);
    EXPECT_EQ(item(plan, "contact").cost.count, 13 * 17) << "slave nodes";
    EXPECT_EQ(item(plan, "friction").cost.count, 13 * 17);
    EXPECT_EQ(item(plan, "smooth master surface").cost.count, 14 * 13) << "a patch per vertex";
    EXPECT_EQ(item(plan, "nodal stresses").cost.count, 13 * 12 * 3 + 12 * 16 * 3) << "elements";
    EXPECT_EQ(item(plan, "field stress").cost.count, 6 * 8 * model.nodes()) << "bytes a frame";

    const Plan moving = plan_of(support::shipped("paper/half_tube_fast.yaml"));
    const double matrix = item(moving, "stiffness").cost.bytes; // a mass and an effective stiffness, and some vectors
    EXPECT_GT(item(moving, "inertia").cost.bytes, 2 * matrix);
    EXPECT_LT(item(moving, "inertia").cost.bytes, 3 * matrix);
}

TEST(PlanItems, SayWhyFieldsAreLeftOut) {
    const std::string press = support::shipped("../tests/scenes/press.yaml");
    EXPECT_THAT(item(plan_of(press, {{"output.frame_every", "0"}}), "field stress").reason,
                HasSubstr("no frame is written"));
    EXPECT_FALSE(item(plan_of(press, {{"output.frame_every", "0"}}), "nodal stresses").present);
    EXPECT_THAT(item(plan_of(press, {{"output.template", "minimal"}}), "field stress").reason, HasSubstr("'minimal'"));
}

/// A block drawn over another that is held at every node, so that its top stays plane.
std::string on_a_plate(const std::string& surface, const std::string& bed = "{fix: [x, y, z]}") {
    return R"(
bodies:
  plate:
    mesh: {block: {size: [4 m, 2 m, 0.5 m], divisions: [8, 4, 1]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
  cap:
    mesh: {block: {origin: [0.3 m, 0.45 m, 0.5 m], size: [1 m, 1 m, 0.5 m], divisions: [3, 3, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  bottom: {body: plate, surface: z_min}
  ground: {body: plate, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, surface: z_max}
  rear: {body: cap, surface: x_min}
supports:
  bottom: {fix: [x, y, z]}
  ground: )" +
           bed + R"(
contact:
  joint: {discretisation: node, slave: under, master: {set: ground, surface: )" +
           surface + R"(}, friction: 0.3}
stages:
  press: {pressure: {top: 100 kPa}, displacement: {rear: {x: 0 m}}}
  pull: {steps: 4, displacement: {rear: {x: 0.3 m}}}
solver: {tolerance: 1.0e-11}
)";
}

Plan plan_of_text(const std::string& text) {
    const scene::Scene scene = scene::parse_scene(text, "scene.yaml");
    Timings timings;
    return compile(scene, build_meshes(scene), 1, timings);
}

TEST(FlatMaster, IsSaidToNeedNoSmoothSurfaceOnlyWhereItStaysFlat) {
    const auto reason = [](const std::string& text) {
        return item(plan_of_text(text), "smooth master surface").reason;
    };
    EXPECT_THAT(reason(on_a_plate("blend")), HasSubstr("joint stays flat"));
    EXPECT_THAT(reason(on_a_plate("rpim")), HasSubstr("joint stays flat"));
    EXPECT_THAT(reason(on_a_plate("blend", "{fix: [x, z]}")), Not(HasSubstr("flat"))) << "moves along y, node by node";
    std::string round = on_a_plate("blend");
    const auto change = [&](const std::string& from, const std::string& to) {
        round.replace(round.find(from), from.size(), to);
    };
    change("divisions: [8, 4, 1]}}", "divisions: [8, 4, 1], crown: {radius: 50 m}}, "
                                     "rotate: {axis: [1, 0, 0], angle: 180 deg}, translate: [0, 2 m, 0.5 m]}");
    change("bottom: {body: plate, surface: z_min}", "bottom: {body: plate, surface: z_max}");
    change("ground: {body: plate, surface: z_max}", "ground: {body: plate, surface: z_min}");
    EXPECT_THAT(reason(round), Not(HasSubstr("flat"))) << "held, but round";
}

TEST(FlatMaster, GivesTheSameForcesOnSlaveNodesWithFacetsButOthersOnItsOwn) {
    const auto run = [](const char* surface) {
        struct Last final : time::StepObserver {
            void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
            void accepted(const time::AcceptedStep& step) override {
                force = step.state.contact[0].lambda;
                unbalanced = step.equilibrium.unbalanced();
            }
            std::vector<Vec3> force, unbalanced;
        } last;
        Plan plan = plan_of_text(on_a_plate(surface));
        Timings timings;
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        stepper.run(last);
        last.unbalanced.resize(static_cast<std::size_t>(plan.model.bodies[0].nodes()));
        return last;
    };
    const auto largest = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
        double most = 0;
        for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
        return most;
    };
    const auto facets = run("facets");
    const double scale = largest(facets.force, std::vector<Vec3>(facets.force.size(), Vec3::Zero()));
    for (const char* surface : {"blend", "rpim"}) {
        const auto smooth = run(surface);
        EXPECT_LT(largest(smooth.force, facets.force), 1e-8 * scale) << surface << ": solved to 1e-11 of 1e5 N";
        EXPECT_GT(largest(smooth.unbalanced, facets.unbalanced), 1e-2 * scale) << surface;
    }
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
