/// What several processes share, and that results do not depend on how many there are.

#include "scenes/distributed_run.hpp"

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

/// Grids of several processes are as good as those of one: there are four here. Each has as much to do.
TEST_F(DistributedRun, TakesAsManyGmresIterationsAndSharesTheWorkEvenly) {
    const std::string finer = "--set solver.linear_solver=multigrid --set solver.tolerance=1e-10 "
                              "--set 'bodies.lower.mesh.block.divisions=[20, 20, 20]' "
                              "--set 'bodies.upper.mesh.block.divisions=[16, 16, 16]' --set output.template=minimal ";
    const auto cube = [](long n) { return n * n * n; };
    std::vector<double> iterations;
    for (const int ranks : {1, 3, 4}) {
        const std::string run = "run_" + std::to_string(ranks);
        ASSERT_EQ(with_ranks(ranks, scene, finer + "-o " + run), 0) << content(folder / "said.txt");
        const auto summary = nlohmann::json::parse(content(folder / run / "summary.json"));
        iterations.push_back(summary["gmres_iterations"]);
        for (const auto& [what, all] :
             {std::pair("nodes", cube(21) + cube(17)), {"elements", cube(20) + cube(16)}, {"slave_nodes", 17 * 17}}) {
            long sum = 0, most = 0;
            for (const auto& process : summary["processes"]) {
                sum += process[what].get<long>();
                most = std::max(most, process[what].get<long>());
            }
            EXPECT_EQ(sum, all) << what;
            EXPECT_LE(ranks * most, 1.1 * static_cast<double>(all)) << what << " of " << ranks;
        }
    }
    EXPECT_GT(iterations.front(), 20);
    for (const double several : iterations) EXPECT_NEAR(several, iterations.front(), 0.1 * iterations.front() + 1);
}

/// Mesh, displacements and others, of 2 MB each: by what the system counts.
TEST_F(DistributedRun, KeepsLargeArraysOnceAMachine) {
    std::ofstream(folder / "large.yaml")
        << "bodies:\n"
           "  block:\n"
           "    mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [44, 44, 44]}}\n"
           "    material: {linear_elastic: {E: 1 GPa, nu: 0}}\n"
           "sets: {bottom: {body: block, surface: z_min}, top: {body: block, surface: z_max}}\n"
           "supports: {bottom: {fix: [x, y, z]}}\n"
           "stages: {press: {pressure: {top: 1 MPa}}}\n"
           "solver: {linear_solver: multigrid, tolerance: 1e-4}\n"
           "output: {template: minimal}\n";
    const double field = 45. * 45 * 45 * 3 * sizeof(double);
    for (const int ranks : {1, 2}) {
        const std::string run = "run_" + std::to_string(ranks);
        ASSERT_EQ(with_ranks(ranks, "large.yaml", "-o " + run), 0) << content(folder / "said.txt");
        for (const auto& process : nlohmann::json::parse(content(folder / run / "summary.json"))["processes"]) {
            const double shared = process["shared_memory_bytes"];
            EXPECT_TRUE(ranks == 1 ? shared < 3 * field : shared > 5 * field) << shared / field << " of " << ranks;
            EXPECT_LT(shared, process["peak_memory_bytes"]);
        }
    }
}

TEST_F(DistributedRun, GivesTheSameResultsWithAnyNumberOfProcesses) {
    for (const int ranks : {1, 2, 3, 4})
        ASSERT_EQ(with_ranks(ranks, scene, settings + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    for (const int ranks : {2, 3, 4}) {
        const fs::path run = folder / ("run_" + std::to_string(ranks));
        expect_the_same(folder / "run_1", run, 1e-9);
        expect_the_same_frames("upper_00002", {"displacement", "stress"}, folder / "run_1", run, 1e-8);
    }
    const Outcome report = osculate({"report", "run_3"});
    EXPECT_EQ(report.code, 0) << report.err;
    EXPECT_THAT(report.out, testing::Not(testing::HasSubstr("frames")));
    EXPECT_THAT(content(folder / "run_3/report.html"), testing::HasSubstr("<img")) << "a picture of the bodies";
}

/// Each process looks at its own elements; what they say is about the same one.
TEST_F(DistributedRun, WarnsOfTheSameRotation) {
    std::ofstream(folder / "bar.yaml")
        << "name: bar\n"
           "bodies:\n"
           "  bar:\n"
           "    mesh: {block: {origin: [1 m, 0 m, 0 m], size: [1 m, 0.3 m, 0.3 m], divisions: [9, 3, 3]}}\n"
           "    material: {linear_elastic: {E: 1 GPa, nu: 0}}\n"
           "sets: {held: {body: bar, surface: x_min}}\n"
           "couplings: {grip: {set: held, reference_point: [0 m, 0 m, 0 m]}}\n"
           "stages: {turn: {motion: {grip: {x: 0 m, y: 0 m, z: 0 m, rx: 0 deg, ry: 0 deg, rz: 30 deg}}}}\n"
           "output: {template: minimal}\n";
    std::vector<nlohmann::json> said;
    for (const int ranks : {1, 2, 3}) {
        const std::string run = "run_" + std::to_string(ranks);
        ASSERT_EQ(with_ranks(ranks, "bar.yaml", "-o " + run), 0) << content(folder / "said.txt");
        const auto summary = nlohmann::json::parse(content(folder / run / "summary.json"));
        said.push_back(summary["warnings"]);
        // 1 - cos 30 degrees is 0.134: the largest is of an element that the false strain turns a little further
        EXPECT_NEAR(summary["checks"]["rotation_strain"].get<double>(), 0.134, 0.01) << ranks;
    }
    EXPECT_FALSE(said.front().empty());
    for (const nlohmann::json& one : said) EXPECT_EQ(one, said.front());
}

TEST_F(DistributedRun, GivesTheSameBitsAgain) {
    for (const char* name : {"first", "second"})
        ASSERT_EQ(with_ranks(3, scene, settings + " -o " + name), 0) << content(folder / "said.txt");
    EXPECT_EQ(content(folder / "first/history.csv"), content(folder / "second/history.csv"));
}

/// Matrices that follow the displacements, whose values come from elements at own nodes.
TEST_F(DistributedRun, SharesFiniteStrain) {
    const std::string material = "'{neo_hookean: {E: 100 MPa, nu: 0.3}}'";
    const std::string options =
        settings + " --set bodies.lower.material=" + material + " --set bodies.upper.material=" + material;
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene, options + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

/// With a plastic one, whose histories all processes keep.
TEST_F(DistributedRun, SharesPlasticity) {
    const std::string plastic = "'{elastic_plastic: {E: 100 MPa, nu: 0.3, yield_stress: 0.05 MPa}}'";
    const std::string fields = " --set 'output.body_fields=[plastic_strain, stress]'";
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene,
                             settings + " --set bodies.upper.material=" + plastic + fields + " -o run_" +
                                 std::to_string(ranks)),
                  0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
    expect_the_same_frames("upper_00002", {"plastic_strain", "stress"}, folder / "run_1", folder / "run_3", 1e-8);
}

/// On faces whose nodes follow a coupling, with elements of their own, and on those of a rigid body, which have none.
TEST_F(DistributedRun, SharesPressuresThatFollow) {
    std::ofstream(folder / "follower.yaml") << R"(
bodies:
  bar:
    mesh: {block: {origin: [0, 0, 0], size: [2, 0.4, 0.4], divisions: [10, 2, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  ball:
    mesh: {ball: {radius: 0.25 m, divisions: [4, 1, 3]}, translate: [1, 0.2, 0.649]}
    rigid: {density: 2000, reference_point: [1.1, 0.25, 0.8], fix: [rx, ry, rz]}
sets:
  root: {body: bar, surface: x_min}
  tip: {body: bar, surface: x_max}
  side: {body: bar, surface: y_max}
  top: {body: bar, surface: z_max}
  below: {body: ball, normal: {direction: [0, 0, -1], angle: 60 deg}}
  above: {body: ball, normal: {direction: [0, 0, 1], angle: 60 deg}}
couplings:
  end: {set: tip, kind: rigid}
supports:
  root: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {set: below, surface: blend}, friction: 0.3, initial_overlap_limit: 1}
stages:
  press: {analysis: static, duration: 1 s, steps: 2, follower_pressure: {side: 1 kPa, tip: 2 kPa, above: 3 kPa}}
)";
    const std::string follower = (folder / "follower.yaml").string(), options = "--set solver.tolerance=1e-10 ";
    ASSERT_EQ(osculate({"run", follower, "--quiet", "--set", "solver.tolerance=1e-10", "-o", "alone"}).code, 0);
    for (const int ranks : {2, 3}) {
        const std::string name = "run_" + std::to_string(ranks);
        ASSERT_EQ(with_ranks(ranks, follower, options + "-o " + name), 0) << content(folder / "said.txt");
        expect_the_same(folder / "alone", folder / name, 1e-8);
    }
}

TEST_F(DistributedRun, SharesDynamics) {
    const std::string material = "'{linear_elastic: {E: 100 MPa, nu: 0.3, density: 1000 kg/m^3}}'";
    const std::string options = settings + " --set bodies.lower.material=" + material +
                                " --set bodies.upper.material=" + material +
                                " --set 'stages.press={analysis: dynamic, duration: 40 ms, steps: 4, displacement: "
                                "{top: {x: 0.2 mm, z: -1 mm}}}'";
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene, options + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

/// A slave 1e6 times as stiff, on which GMRES with multigrid does not converge: the first process factorises for all.
TEST_F(DistributedRun, FactorisesWhereGmresFails) {
    const std::string stiff = scene_file("configs/extreme/stiff_slave.yaml"),
                      options = "--set solver.tolerance=1e-10 --set solver.linear_solver=multigrid ";
    ASSERT_EQ(osculate({"run", stiff, "--quiet", "--set", "solver.tolerance=1e-10", "--set",
                        "solver.linear_solver=multigrid", "-o", "alone"})
                  .code,
              0);
    for (const int ranks : {1, 2}) {
        const std::string name = "run_" + std::to_string(ranks);
        ASSERT_EQ(with_ranks(ranks, stiff, options + "-o " + name), 0) << content(folder / "said.txt");
        expect_the_same(folder / "alone", folder / name, 1e-8);
    }
}

TEST_F(DistributedRun, SharesGeneralContact) {
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene,
                             settings + " --set 'contact={general: {friction: 0.3}}' -o run_" + std::to_string(ranks)),
                  0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

/// Each process evaluates some of the slave nodes, which it does not where surfaces are small.
TEST_F(DistributedRun, SharesGeneralContactOfLargeSurfaces) {
    const std::string options = settings + " --set 'contact={general: {friction: 0.3}}' --set stages.press.steps=1 "
                                           "--set 'bodies.lower.mesh.block.divisions=[34, 34, 1]' "
                                           "--set 'bodies.upper.mesh.block.divisions=[33, 33, 1]'";
    for (const int ranks : {1, 2})
        ASSERT_EQ(with_ranks(ranks, scene, options + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_2", 1e-9);
}

/// Nodes that follow others have rows where those have them: a tie, a sector whose ends move alike, a face that stays plane.
TEST_F(DistributedRun, SharesNodesThatFollowOthers) {
    std::ofstream(folder / "followers.yaml") << R"(
bodies:
  sector:
    mesh: {block: {origin: [0 m, -1 m, 0 m], size: [2 m, 2 m, 1 m], divisions: [8, 7, 4]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
  plate:
    mesh: {block: {origin: [0.4 m, -0.8 m, 1 m], size: [1 m, 1.2 m, 0.4 m], divisions: [5, 5, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
  pad:
    mesh: {block: {origin: [0.5 m, -0.6 m, 1.4 m], size: [0.7 m, 0.8 m, 0.5 m], divisions: [4, 4, 3]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  outside: {body: sector, surface: x_max}
  floor: {body: sector, surface: z_min}
  roof: {body: sector, surface: z_max}
  upper: {body: sector, box: {min: [-1 mm, 1 mm, -1 m], max: [1 mm, 3 m, 2 m]}}
  lower: {body: sector, box: {min: [-1 mm, -3 m, -1 m], max: [1 mm, -1 mm, 2 m]}}
  underside: {body: plate, surface: z_min}
  over: {body: plate, surface: z_max}
  sole: {body: pad, surface: z_min}
  top: {body: pad, surface: z_max}
  corner: {body: sector, box: {min: [1.9 m, 0.9 m, 0.9 m], max: [3 m, 3 m, 3 m]}}
supports:
  floor: {fix: [z]}
  corner: {fix: [y]}
cyclic:
  turn: {slave: upper, master: lower, point: [0 m, 0 m, 0 m], axis: [0, 0, 1], sectors: 2}
ties:
  glue: {slave: underside, master: roof}
equations:
  plane: {each: outside, terms: {outside: [1, 0, 0], corner: [-1, 0, 0]}}
contact:
  base: {slave: sole, master: {set: over}, friction: 0.2}
stages:
  load: {steps: 2, displacement: {top: {x: 1 mm, y: 0 m, z: -5 mm}}}
output: {template: contact}
)";
    for (const int ranks : {1, 2, 3})
        ASSERT_EQ(with_ranks(ranks, "followers.yaml", "--set solver.tolerance=1e-10 -o run_" + std::to_string(ranks)),
                  0)
            << content(folder / "said.txt");
    const Outcome factors = osculate({"run", "followers.yaml", "--set", "solver.tolerance=1e-10", "--set",
                                      "solver.linear_solver=iterative", "-o", "alone", "--quiet"});
    ASSERT_EQ(factors.code, 0) << factors.err;
    for (const int ranks : {1, 2, 3})
        expect_the_same(folder / ("run_" + std::to_string(ranks)), folder / "alone", 1e-9);
}

/// A sheet in a coupling between two exact tools, one of which is free: in statics, then in motion.
TEST_F(DistributedRun, SharesRigidBodiesAndCouplings) {
    const std::string tools = scene_file("tests/scenes/exact_tools.yaml"), exact = "--set solver.tolerance=1e-11";
    for (const int ranks : {1, 2, 3})
        ASSERT_EQ(with_ranks(ranks, tools, exact + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    const Outcome factors = osculate({"run", tools, "--set", "solver.tolerance=1e-11", "--set",
                                      "solver.linear_solver=iterative", "-o", "alone", "--quiet"});
    ASSERT_EQ(factors.code, 0) << factors.err;
    for (const int ranks : {1, 2, 3})
        expect_the_same(folder / ("run_" + std::to_string(ranks)), folder / "alone", 1e-8);
}

/// Whose grids have no unknown.
TEST_F(DistributedRun, SharesRigidBodiesAlone) {
    const std::string options = "--set stages.fall.duration='30 ms' --set stages.fall.steps=30 -o run_";
    for (const int ranks : {1, 2})
        ASSERT_EQ(with_ranks(ranks, scene_file("configs/tutorials/dominoes.yaml"), options + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    constexpr double of_an_impact = 20; // which last digits decide
    expect_the_same(folder / "run_1", folder / "run_2", 1e-9, of_an_impact);
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
