/// Bodies with parts of other materials.

#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// Soft up to the middle, hard beyond it; without lateral strain, so that uniform stress is exact.
const std::string bar = R"(
bodies:
  bar:
    mesh: {block: {size: [4 m, 1 m, 1 m], divisions: [4, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0, density: 1000 kg/m^3}}
    sections:
      hard: {box: {min: [2 m, -1 m, -1 m], max: [5 m, 2 m, 2 m]}, material: {linear_elastic: {E: 4 MPa, nu: 0, density: 3000 kg/m^3}}}
sets:
  left: {body: bar, surface: x_min}
  right: {body: bar, surface: x_max}
supports:
  left: {fix: [x, y, z]}
stages:
  pull: {pressure: {right: -1 kPa}}
)";

std::unique_ptr<support::SceneRun> run(const std::string& text, const std::vector<scene::Override>& overrides = {}) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, support::scene_file("bar.yaml", text), overrides);
    return found;
}

TEST(BodyOfSections, StretchesAsSpringsInSeries) {
    for (const char* element : {"hex8", "tet4", "tet10", "hex20", "wedge15"}) {
        const auto found = run(bar, {{"bodies.bar.mesh.block.element", element}});
        const auto& X = found->plan.model.X;
        const auto& u = found->steps.back().state.u;
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double x = X[i].x(), expected = 1e3 * (std::min(x, 2.0) / 1e6 + std::max(x - 2, 0.0) / 4e6);
            EXPECT_NEAR(u[i].x(), expected, 1e-9 * 2.5e-3) << element;
        }
    }
}

TEST(BodyOfSections, OfWhichOneIsAtFiniteStrainStretchesAsTwoLaws) {
    const auto found = run(bar, {{"bodies.bar.sections.hard.material", "{neo_hookean: {E: 4 MPa, nu: 0}}"},
                                 {"stages.pull.pressure.right", "-1 MPa"}});
    // nu = 0: lambda = 0, so that P = mu (F - F^-1) = 1 MPa along the bar, mu = 2 MPa
    const double stretch = (0.5 + std::sqrt(0.25 + 4)) / 2;
    const auto& u = found->steps.back().state.u;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (found->plan.model.X[i].x() == 4) {
            EXPECT_NEAR(u[i].x(), 2 * 1.0 + 2 * (stretch - 1), 1e-8);
        }
}

TEST(BodyOfSections, WeighsWhatItsPartsDo) {
    const auto found = run(bar, {{"gravity", "[0 m/s^2, 0 m/s^2, -10 m/s^2]"}, {"stages.pull", "{analysis: static}"}});
    Vec3 held = Vec3::Zero();
    const Field f = model::internal_force(found->plan.model, found->steps.back().state.at_rest(), 1);
    for (std::size_t i = 0; i < f.size(); ++i)
        if (found->plan.model.X[i].x() == 0) held += f[i];
    // the nodes there carry a quarter of an element's weight themselves
    EXPECT_NEAR(held.z() + 0.5 * 1000 * 10, (2 * 1000 + 2 * 3000) * 10, 1e-6);
    const Vec3 centre = model::centre_of_mass(found->plan.model.bodies[0]);
    EXPECT_NEAR(centre.x(), (2000 * 1 + 6000 * 3) / 8000.0, 1e-12);
}

TEST(BodyOfSections, IsThrownOutwardByTheMassOfItsParts) {
    const auto found =
        run(bar, {{"stages.pull", "{centrifugal: {bar: {point: [0 m, 0 m, 0 m], axis: [0, 0, 1], speed: 2 rad/s}}}"}});
    double held = 0;
    const Field f = model::internal_force(found->plan.model, found->steps.back().state.at_rest(), 1);
    for (std::size_t i = 0; i < f.size(); ++i)
        if (found->plan.model.X[i].x() == 0) held += f[i].x();
    // int rho w^2 x dV, but for what the held nodes carry: rho w^2 int (1 - x) x dx of the first element
    EXPECT_NEAR(-held, 4 * (1000 * 2 + 3000 * 6) - 4 * 1000 / 6.0, 1e-6);
}

TEST(BodyOfSections, GrowsWhereItExpands) {
    const auto found =
        run(bar, {{"bodies.bar.sections.hard.material.linear_elastic.expansion", "1e-5 1/K"},
                  {"supports", "{left: {fix: [x]}, below: {fix: [y, z]}, above: {fix: [y]}}"},
                  {"sets.below", "{body: bar, box: {min: [-1 mm, -1 mm, -1 mm], max: [5 m, 1 mm, 1 mm]}}"},
                  {"sets.above", "{body: bar, box: {min: [-1 mm, -1 mm, 0.99 m], max: [5 m, 1 mm, 1.01 m]}}"},
                  {"stages.pull", "{temperature: {bar: 100 K}}"}});
    const auto& X = found->plan.model.X;
    const auto& u = found->steps.back().state.u;
    double mean = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (X[i].x() == 4) mean += (X[i].y() == 0.5 ? 2 : 1) * (X[i].z() == 0.5 ? 2 : 1) / 16.0 * u[i].x();
    // work of a uniform tension, a field of the elements: the mean elongation is the expansion of the hard half
    EXPECT_NEAR(mean, 2 * 1e-5 * 100, 1e-9 * 2e-3);
}

TEST(BodyOfSections, IsTheSameWhicheverPartIsTheSection) {
    const auto one = run(bar);
    const auto other = run(bar, {{"bodies.bar.material.linear_elastic.E", "4 MPa"},
                                 {"bodies.bar.sections.hard.box", "{min: [-1 m, -1 m, -1 m], max: [2 m, 2 m, 2 m]}"},
                                 {"bodies.bar.sections.hard.material.linear_elastic.E", "1 MPa"}});
    for (std::size_t i = 0; i < one->plan.model.X.size(); ++i)
        EXPECT_LT((one->steps.back().state.u[i] - other->steps.back().state.u[i]).norm(), 1e-12 * 2.5e-3);
}

TEST(BodyOfSections, IsAsTwoBodiesTiedWhereTheyMeet) {
    const std::string two = R"(
bodies:
  soft:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
  hard:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [2, 2, 2]}, translate: [2 m, 0 m, 0 m]}
    material: {linear_elastic: {E: 4 MPa, nu: 0.3}}
sets:
  left: {body: soft, surface: x_min}
  meets: {body: soft, surface: x_max}
  met: {body: hard, surface: x_min}
  right: {body: hard, surface: x_max}
ties:
  joint: {slave: meets, master: met}
supports:
  left: {fix: [x, y, z]}
stages:
  bend: {nodal_force: {right: [0 N, 0 N, 10 N]}}
)";
    const auto tied = run(two);
    const auto glued = run(bar, {{"bodies.bar.material.linear_elastic.nu", "0.3"},
                                 {"bodies.bar.sections.hard.material.linear_elastic.nu", "0.3"},
                                 {"stages.pull", "{nodal_force: {right: [0 N, 0 N, 10 N]}}"}});
    const auto tip = [](const support::SceneRun& of) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < of.plan.model.X.size(); ++i)
            if (of.plan.model.X[i].x() == 4) sum += of.steps.back().state.u[i];
        return sum;
    };
    EXPECT_LT((tip(*tied) - tip(*glued)).norm(), 1e-9 * tip(*glued).norm());
}

TEST(BodyOfSections, WithAxesOfItsOwnIsAsTheIsotropicOneOfItsConstants) {
    const std::vector<scene::Override> load{{"gravity", "[1 mm/s^2, 2 mm/s^2, -10 mm/s^2]"},
                                            {"stages.pull", "{temperature: {bar: 0.01 K}}"}};
    const auto with = [&](const std::string& material) {
        std::vector<scene::Override> all = load;
        all.push_back({"bodies.bar.sections.hard.material", material});
        return run(bar, all);
    };
    const auto isotropic = with("{linear_elastic: {E: 4 MPa, nu: 0.25, density: 700 kg/m^3, expansion: 1e-5 1/K}}");
    const auto axes =
        with("{orthotropic: {E: [4 MPa, 4 MPa, 4 MPa], nu: [0.25, 0.25, 0.25], G: [1.6 MPa, 1.6 MPa, 1.6 MPa], "
             "axes: [[1, 2, 3], [0, 1, -1]], density: 700 kg/m^3, expansion: 1e-5 1/K}}");
    // Hooke's law at finite strain differs by the strains, which are below 1e-4
    const auto finite =
        with("{saint_venant_kirchhoff: {E: 4 MPa, nu: 0.25, density: 700 kg/m^3, expansion: 1e-5 1/K}}");
    double largest = 0;
    for (const Vec3& u : isotropic->steps.back().state.u) largest = std::max(largest, u.norm());
    for (std::size_t i = 0; i < isotropic->plan.model.X.size(); ++i) {
        const Vec3& u = isotropic->steps.back().state.u[i];
        EXPECT_LT((axes->steps.back().state.u[i] - u).norm(), 1e-9 * largest);
        EXPECT_LT((finite->steps.back().state.u[i] - u).norm(), 1e-2 * largest);
    }
}

TEST(BodyOfSections, GivesAnElementToTheLastThatHasIt) {
    const auto found =
        run(bar, {{"bodies.bar.sections.harder", "{box: {min: [3 m, -1 m, -1 m], max: [5 m, 2 m, 2 m]}, "
                                                 "material: {linear_elastic: {E: 8 MPa, nu: 0, density: 1 kg/m^3}}}"}});
    const auto& u = found->steps.back().state.u;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (found->plan.model.X[i].x() == 4) {
            EXPECT_NEAR(u[i].x(), 1e3 * (2 / 1e6 + 1 / 4e6 + 1 / 8e6), 1e-11);
        }
}

/// What is said about a scene that is refused.
std::string said(const std::vector<scene::Override>& overrides) {
    try {
        (void)run(bar, overrides);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

TEST(BodyOfSections, IsRefusedWithoutElementsOrAsAPartThatIsNotThere) {
    const std::string away = "{min: [7 m, 7 m, 7 m], max: [8 m, 8 m, 8 m]}";
    EXPECT_NE(said({{"bodies.bar.sections.hard.box", away}}).find("bodies.bar.sections.hard"), std::string::npos);
    EXPECT_NE(said({{"bodies.bar.sections.hard.box", "{min: [2 m, 2 m, 2 m], max: [1 m, 3 m, 3 m]}"}})
                  .find("bodies.bar.sections.hard.box"),
              std::string::npos);
    EXPECT_NE(said({{"bodies.bar.sections",
                     "{hard: {elements: HARD, material: {linear_elastic: {E: 4 MPa, nu: 0, density: 1 kg/m^3}}}}"}})
                  .find("bodies.bar.sections.hard"),
              std::string::npos);
}

TEST(SetsByNumbers, NeedAMeshFromAFile) {
    EXPECT_NE(said({{"sets.some", "{body: bar, node_numbers: [1, 2]}"}})
                  .find("sets.some.node_numbers: expected a body whose mesh is from a file"),
              std::string::npos);
}

TEST(BodyOfSections, NeedsADensityInEveryPartThatMoves) {
    const std::vector<scene::Override> moves{{"stages.pull.analysis", "dynamic"},
                                             {"bodies.bar.sections.hard.material.linear_elastic.density", "0 kg/m^3"}};
    EXPECT_NE(said(moves).find("bodies.bar.sections.hard.material"), std::string::npos);
    const std::vector<scene::Override> rigid{{"bodies.bar.rigid", "true"}, {"supports", "{}"}};
    EXPECT_NE(said(rigid).find("bodies.bar.sections"), std::string::npos);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
