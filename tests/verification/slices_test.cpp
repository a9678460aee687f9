/// Layers of elements that stand for plane bodies and for bodies of revolution, against closed solutions.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::scene_file;
using support::with;

std::unique_ptr<support::SceneRun> run(const std::string& text) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, scene_file("slices.yaml", text));
    return found;
}

const model::Set& set_of(const support::SceneRun& found, const char* name) {
    return *std::ranges::find(found.plan.model.sets, name, &model::Set::name);
}

Vec3 mean_of(const support::SceneRun& found, const char* set) {
    Vec3 sum = Vec3::Zero();
    for (const Index node : set_of(found, set).nodes) sum += found.steps.back().state.u[node];
    return sum / static_cast<double>(set_of(found, set).nodes.size());
}

// ---- in the plane ----

const std::string plate = R"(
bodies:
  plate:
    mesh: {block: {size: [4 m, 1 m, 0.2 m], divisions: [8, 4, 1], element: ELEMENT}ROTATED}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
    slice: {kind: KIND, axis: [AXIS]}
sets:
  root: {body: plate, surface: x_min}
  low: {body: plate, surface: y_min}
  end: {body: plate, surface: x_max}
supports:
  root: {axes: [[XAXIS], [YAXIS]], fix: [x]}
  low: {axes: [[XAXIS], [YAXIS]], fix: [y]}
stages:
  pull: {pressure: {end: -1 MPa}}
)";

TEST(Slices, PullStretchesAPlateAsPlaneStressAndPlaneStrainSay) {
    constexpr double p = 1e6, E = 1e7, nu = 0.3, round_off = 1e-9;
    for (const char* element : {"hex8", "hex20"})
        for (const bool strain : {false, true})
            for (const bool turned : {false, true}) {
                // about y by 30 degrees
                const auto found =
                    run(with(plate, {{"ELEMENT", element},
                                     {"KIND", strain ? "plane_strain" : "plane_stress"},
                                     {"ROTATED", turned ? ", rotate: {axis: [0, 1, 0], angle: 30 deg}" : ""},
                                     {"XAXIS", turned ? "0.8660254037844387, 0, -0.5" : "1, 0, 0"},
                                     {"YAXIS", "0, 1, 0"},
                                     {"AXIS", turned ? "0.5, 0, 0.8660254037844387" : "0, 0, -2"}}));
                const Vec3 x = turned ? Vec3(std::sqrt(0.75), 0, -0.5) : Vec3::UnitX(), z = x.cross(Vec3::UnitY());
                const double modulus = strain ? E / (1 - nu * nu) : E;
                EXPECT_NEAR(mean_of(*found, "end").dot(x), 4 * p / modulus, round_off) << element << strain << turned;
                const double across = strain ? 0 : -nu * p / E * 0.2;
                double least = 0, most = 0;
                for (const Vec3& u : found->steps.back().state.u) {
                    least = std::min(least, u.dot(z));
                    most = std::max(most, u.dot(z));
                }
                EXPECT_NEAR(most - least, std::abs(across), round_off) << element << strain << turned;
            }
}

TEST(Slices, ABeamInThePlaneBendsAsTheTheoryOfBeamsSays) {
    // a shear force along the edge at the end; I = b h^3 / 12 with the modulus of the plane
    constexpr double F = 1e3, E = 1e7, nu = 0.3, L = 8, h = 1, b = 0.2;
    for (const bool strain : {false, true}) {
        const auto found = run(
            with(plate, {{"[4 m, 1 m, 0.2 m], divisions: [8, 4, 1]", "[8 m, 1 m, 0.2 m], divisions: [16, 2, 1]"},
                         {"ELEMENT", "hex20"},
                         {"KIND", strain ? "plane_strain" : "plane_stress"},
                         {"ROTATED", ""},
                         {"XAXIS", "1, 0, 0"},
                         {"YAXIS", "0, 1, 0"},
                         {"AXIS", "0, 0, 1"},
                         {"  low: {body: plate, surface: y_min}\n",
                          "  low: {body: plate, box: {min: [-1 m, 0.49 m, -1 m], max: [0.01 m, 0.51 m, 1 m]}}\n  tip: "
                          "{body: plate, box: {min: [7.99 m, 0.49 m, -0.01 m], max: [9 m, 0.51 m, 0.01 m]}}\n"},
                         {"pressure: {end: -1 MPa}", "nodal_force: {tip: [0 N, 1 kN, 0 N]}"}}));
        const double modulus = strain ? E / (1 - nu * nu) : E, I = b * h * h * h / 12,
                     shear = 6.0 / 5 * F * L * 2 * (1 + nu) / (E * b * h);
        // what the force on one node of the end does there is local
        const double w = mean_of(*found, "end").y();
        EXPECT_NEAR(w, F * L * L * L / (3 * modulus * I) + shear, 0.01 * w) << strain;
    }
}

// ---- what moves and rubs ----

TEST(Slices, ABoxThatFallsAndSlidesDoesSoAsBetweenPlanesThatHoldIt) {
    const std::string slice = "\n    slice: {kind: plane_strain, axis: [0, 0, 1]}";
    const std::string scene = R"(
bodies:
  floor:
    mesh: {block: {origin: [-1 m, -0.5 m, 0 m], size: [4 m, 0.5 m, 0.2 m], divisions: [12, 2, 1]}}
    material: {saint_venant_kirchhoff: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}SLICE
  box:
    mesh: {block: {origin: [0 m, 0.002 m, 0 m], size: [1 m, 1 m, 0.2 m], divisions: [4, 4, 1]}}
    material: {saint_venant_kirchhoff: {E: 20 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [0.5 m/s, -0.3 m/s, 0 m/s]SLICE
sets:
  bed: {body: floor, surface: y_min}
  ground: {body: floor, surface: y_max}
  under: {body: box, surface: y_min}
  box_low: {body: box, surface: z_min}
  box_high: {body: box, surface: z_max}
  floor_low: {body: floor, surface: z_min}
  floor_high: {body: floor, surface: z_max}
supports: {bed: {fix: [x, y]}HELD}
contact: {sole: {slave: under, master: {set: ground, surface: facets}, friction: 0.2}}
gravity: [0 m/s^2, -9.81 m/s^2, 0 m/s^2]
stages:
  fall: {duration: 0.1 s, steps: 20, analysis: {dynamic: {}}}
)";
    const auto layer = run(with(scene, {{"SLICE", slice}, {"HELD", ""}}));
    const auto held = run(
        with(scene,
             {{"SLICE", ""},
              {"HELD", ", box_low: {fix: [z]}, box_high: {fix: [z]}, floor_low: {fix: [z]}, floor_high: {fix: [z]}"}}));
    ASSERT_EQ(layer->steps.size(), held->steps.size());
    double most = 0, friction = 0;
    for (std::size_t k = 0; k < layer->steps.size(); ++k) {
        const support::RunStep &a = layer->steps[k], &b = held->steps[k];
        most = std::max(most, b.pairs[0].normal);
        friction = std::max(friction, b.ledger.friction);
        EXPECT_NEAR(a.pairs[0].normal, b.pairs[0].normal, 1e-5 * most);
        EXPECT_NEAR(a.ledger.friction, b.ledger.friction, 1e-5 * friction);
        EXPECT_LT((a.ledger.linear - b.ledger.linear).norm(), 1e-6 * b.ledger.linear.norm());
    }
    EXPECT_GT(friction, 1);
    // one slave for the two nodes above one another, with the area of both
    EXPECT_EQ(layer->plan.model.pairs[0]->size(), 5);
    double area = 0;
    for (const double one : layer->plan.model.pairs[0]->slaves().area) area += one;
    EXPECT_NEAR(area, 0.2, 1e-12);
}

// ---- of revolution ----

/// Blocks whose z is an angle about y: wedges of half a degree.
void make_wedges(std::vector<mesh::Mesh>& meshes) {
    for (mesh::Mesh& mesh : meshes)
        for (Vec3& X : mesh.nodes) X = Vec3(X.x() * std::cos(X.z()), X.y(), X.x() * std::sin(X.z()));
}

std::unique_ptr<support::SceneRun> run_wedges(const std::string& text,
                                              const std::vector<scene::Override>& overrides = {}) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, scene_file("slices.yaml", text), overrides, make_wedges);
    return found;
}

/// Radial displacement of a set where the angle is zero.
double radial(const support::SceneRun& found, const char* set) {
    double sum = 0;
    int count = 0;
    for (const Index node : set_of(found, set).nodes)
        if (std::abs(found.plan.model.X[node].z() + found.plan.model.origin.z()) < 1e-9) {
            sum += found.steps.back().state.u[node].x();
            ++count;
        }
    return sum / count;
}

const std::string rings = R"(
bodies:
  ring:
    mesh: {block: {origin: [1 m, 0 m, 0 m], size: [1 m, 0.3 m, 0.008726646259971648 m], divisions: [6, 2, 1], element: ELEMENT}}
    material: {LAW: {E: 10 MPa, nu: 0.3, expansion: 1e-5 1/K}}
    slice: {kind: axisymmetric, axis: [0, 1, 0], point: [0 m, 2 m, 0 m]}
SECOND
sets:
  inside: {body: ring, surface: x_min}
  outside: {body: ring, surface: x_max}
  low: {body: ring, surface: y_min}
SETS
supports:
  low: {fix: [y]}
SUPPORTS
stages:
  load: {LOAD}
)";

TEST(Slices, ARingUnderPressureWidensAsLameSays) {
    constexpr double p = 1e6, E = 1e7, nu = 0.3, a = 1, b = 2;
    for (const auto& [element, error] : {std::pair{"hex20", 1e-3}, {"hex8", 1e-2}}) {
        const auto found = run_wedges(with(rings, {{"ELEMENT", element},
                                                   {"LAW", "linear_elastic"},
                                                   {"SECOND", ""},
                                                   {"SETS", ""},
                                                   {"SUPPORTS", ""},
                                                   {"LOAD", "pressure: {inside: 1 MPa}"}}));
        const double inner = p * a / E * ((b * b + a * a) / (b * b - a * a) + nu),
                     outer = 2 * p * a * a * b / (E * (b * b - a * a));
        EXPECT_NEAR(radial(*found, "inside"), inner, error * inner) << element;
        EXPECT_NEAR(radial(*found, "outside"), outer, error * outer) << element;
        // every node is where the turned one of the other side is
        const Field& u = found->steps.back().state.u;
        for (const Index node : set_of(*found, "outside").nodes) {
            const Vec3 X = found->plan.model.X[node] + found->plan.model.origin, e = Vec3(X.x(), 0, X.z()).normalized();
            EXPECT_LT((u[node] - u[node].dot(e) * e - u[node].y() * Vec3::UnitY()).norm(), 1e-12);
        }
    }
}

TEST(Slices, AHeatedRingPressesOnAnotherAsLameSays) {
    constexpr double E = 1e7, nu = 0.3, a = 1, b = 2, c = 3, heat = 1e-5 * 100;
    const double inner = (b * b + a * a) / (b * b - a * a) - nu, outer = (c * c + b * b) / (c * c - b * b) + nu,
                 p = E * heat / (inner + outer);
    for (const char* law : {"linear_elastic", "saint_venant_kirchhoff"}) {
        const auto found = run_wedges(with(
            rings,
            {{"ELEMENT", "hex20"},
             {"SECOND",
              "  hub:\n    mesh: {block: {origin: [2 m, 0 m, 0 m], size: [1 m, 0.3 m, 0.008726646259971648 m], "
              "divisions: "
              "[6, 3, 1], element: hex20}}\n    material: {LAW: {E: 10 MPa, nu: 0.3}}\n    slice: {kind: axisymmetric, "
              "axis: [0, 1, 0]}\n"},
             {"SETS", "  bore: {body: hub, surface: x_min}\n  low_hub: {body: hub, surface: y_min}\n"},
             {"SUPPORTS", "  low_hub: {fix: [y]}\ncontact:\n  fit: {slave: outside, master: {set: bore}}\n"},
             {"LAW", law},
             {"LOAD", "temperature: {ring: 100 K}"}}));
        // between nodes of the wedges' middle and others, chords are b angle^2 / 8 inside: 0.01 of the interference
        EXPECT_NEAR(radial(*found, "bore"), p * b / E * outer, 0.01 * p * b / E * outer) << law;
        constexpr double angle = 0.5 * 3.14159265358979323846 / 180;
        EXPECT_NEAR(found->steps.back().pairs[0].normal, p * b * angle * 0.3, 0.01 * p * b * angle * 0.3) << law;
    }
}

TEST(Slices, ADiscThatTurnsWidensAsTheoryAndItsSectorSay) {
    // Timoshenko and Goodier 1970, section 32: an annular disc in plane stress
    constexpr double rho = 1000, w = 30, E = 1e7, nu = 0.3, a = 1, b = 2;
    const auto exact = [&](double r) {
        return rho * w * w / E * (3 + nu) / 8 *
               ((1 - nu) * (a * a + b * b) * r + (1 + nu) * a * a * b * b / r - (1 - nu * nu) / (3 + nu) * r * r * r);
    };
    const std::string text = with(rings, {{"ELEMENT", "hex20"},
                                          {"LAW", "linear_elastic"},
                                          {"size: [1 m, 0.3 m", "size: [1 m, 0.05 m"},
                                          {"divisions: [6, 2, 1]", "divisions: [6, 1, 1]"},
                                          {"expansion:", "density: 1000 kg/m^3, expansion:"},
                                          {"SECOND", ""},
                                          {"SETS", ""},
                                          {"SUPPORTS", ""}});
    const auto found = run_wedges(
        with(text, {{"LOAD", "centrifugal: {ring: {point: [0 m, 7 m, 0 m], axis: [0, -3, 0], speed: 30 rad/s}}"}}));
    EXPECT_NEAR(radial(*found, "inside"), exact(a), 2e-3 * exact(a));
    EXPECT_NEAR(radial(*found, "outside"), exact(b), 2e-3 * exact(b));
    // at twice the speed in a second stage, and none in a third
    const auto stages = run_wedges(
        with(text, {{"  load: {LOAD}",
                     "  first: {centrifugal: {ring: {point: [0 m, 0 m, 0 m], axis: [0, 1, 0], speed: 15 rad/s}}}\n"
                     "  second: {centrifugal: {ring: {point: [0 m, 0 m, 0 m], axis: [0, 1, 0], speed: 30 rad/s}}}\n"
                     "  third: {centrifugal: {ring: {point: [0 m, 0 m, 0 m], axis: [0, 1, 0], speed: 0 rad/s}}}\n"}}));
    const auto outside = [&](std::size_t step) {
        return stages->steps[step].state.u[set_of(*stages, "outside").nodes.front()].norm();
    };
    EXPECT_NEAR(outside(0), outside(1) / 4, 1e-9);
    EXPECT_NEAR(outside(2), 0, 1e-12);
    EXPECT_THROW(
        run_wedges(
            with(text, {{"LOAD", "centrifugal: {ring: {point: [1 m, 0 m, 0 m], axis: [0, 1, 0], speed: 1 rad/s}}"}})),
        SceneError);
}

TEST(Slices, RefuseWhatIsNoLayer) {
    const std::vector<scene::Override> elsewhere{{"bodies.ring.slice.point", "[1 m, 0 m, 0 m]"}};
    const auto faults = [&](const std::string& text, bool wedges = false) {
        try {
            (void)(wedges ? run_wedges(text, elsewhere) : run(text));
        } catch (const SceneError& error) {
            std::string all;
            for (const Fault& fault : error.faults())
                all += fault.key + ": " + fault.expected + "; " + fault.found + "\n";
            return all;
        }
        return std::string("none");
    };
    using testing::HasSubstr;
    const std::vector<std::pair<std::string, std::string>> usual{{"ELEMENT", "hex8"},  {"KIND", "plane_stress"},
                                                                 {"ROTATED", ""},      {"XAXIS", "1, 0, 0"},
                                                                 {"YAXIS", "0, 1, 0"}, {"AXIS", "0, 0, 1"}};
    EXPECT_EQ(faults(with(plate, usual)), "none");
    EXPECT_THAT(faults(with(with(plate, {{"[AXIS]", "[0.1, 0, 1]"}}), usual)),
                HasSubstr("a mesh of one layer along it"));
    // a layer pulled at one side alone
    EXPECT_THAT(
        faults(with(with(plate, {{"  end:", "  far: {body: plate, box: {min: [3.9 m, -1 m, -1 m], max: [5 m, 2 m, "
                                            "0.1 m]}}\n  end:"},
                                 {"pressure: {end: -1 MPa}", "displacement: {far: {x: 1 mm}, end: {y: 0 m}}"}}),
                    usual)),
        "none"); // the other side follows
    EXPECT_THAT(
        faults(with(with(plate, {{"  end:", "  far: {body: plate, box: {min: [3.9 m, -1 m, -1 m], max: [5 m, 2 m, "
                                            "0.1 m]}}\n  near: {body: plate, box: {min: [3.9 m, -1 m, 0.1 m], max: "
                                            "[5 m, 2 m, 1 m]}}\n  end:"},
                                 {"pressure: {end: -1 MPa}", "displacement: {far: {x: 1 mm}, near: {x: 2 mm}}"}}),
                    usual)),
        HasSubstr("supports and motions that are the same through the layer"));
    EXPECT_THAT(faults(with(rings, {{"ELEMENT", "hex8"},
                                    {"LAW", "linear_elastic"},
                                    {"SECOND", ""},
                                    {"SETS", ""},
                                    {"SUPPORTS", ""},
                                    {"LOAD", "pressure: {outside: 1 MPa}"}}),
                       true),
                HasSubstr("nodes apart from the axis"));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
