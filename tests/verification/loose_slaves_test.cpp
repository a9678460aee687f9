/// Single nodes as slaves, without facets between them.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// A table on three nodes of its underside, which no facet joins, above a rigid floor.
const std::string table = R"(
bodies:
  table:
    mesh: {block: {size: [2 m, 2 m, 0.5 m], divisions: [4, 4, 2], element: hex8}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 100 kg/m^3}}
  floor:
    mesh: {block: {origin: [-1 m, -1 m, -1 m], size: [4 m, 4 m, 1 m], divisions: [3, 3, 1]}}
    rigid: {fix: [x, y, z, rx, ry, rz]}
sets:
  feet: {body: table, nodes: feet}
  top: {body: table, surface: z_max}
  floor: {body: floor, surface: z_max}
  x: {body: table, surface: x_min}
  y: {body: table, surface: y_min}
supports:
  x: {fix: [x]}
  y: {fix: [y]}
contact:
  joint: {slave: feet, master: {set: floor, surface: facets}}
stages:
  press: {pressure: {top: 1 kPa}}
)";

const std::vector<Vec3> feet{{0, 0, 0}, {2, 0.5, 0}, {1, 2, 0}};

std::unique_ptr<support::SceneRun> run(const std::vector<scene::Override>& overrides,
                                       const std::vector<Vec3>& at = feet) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(
        *found, support::scene_file("table.yaml", table), overrides, [&](std::vector<mesh::Mesh>& meshes) {
            std::vector<Index>& set = meshes[0].node_sets["feet"];
            for (Index i = 0; i < meshes[0].node_count(); ++i)
                if (std::ranges::any_of(at, [&](const Vec3& X) { return (meshes[0].nodes[i] - X).norm() < 1e-9; }))
                    set.push_back(i);
        });
    return found;
}

TEST(LooseSlaves, CarryWhatSupportsAtTheirNodesWould) {
    const auto pressed = run({});
    const auto held = run({{"supports.feet", "{fix: [z]}"}, {"contact", "{}"}});
    ASSERT_EQ(pressed->contact[0].pair().size(), 3);
    EXPECT_EQ(pressed->contact[0].pair().options().discretisation, Discretisation::node);
    EXPECT_NEAR(pressed->steps.back().pairs[0].on_slave.z(), 4e3, 1e-6);
    // of elements of 0.5 m: a corner, and two nodes on edges, of which the sides do not count
    EXPECT_NEAR(pressed->contact[0].pair().slaves().area[0], 0.25 * 0.25, 1e-12);
    EXPECT_NEAR(pressed->contact[0].pair().slaves().area[1], 0.5 * 0.25, 1e-12);
    const auto& u = pressed->steps.back().state.u;
    double largest = 0;
    for (const Vec3& v : held->steps.back().state.u) largest = std::max(largest, v.norm());
    for (std::size_t i = 0; i < 75; ++i) // nodes of the table
        EXPECT_LT((u[i] - held->steps.back().state.u[i]).norm(), 1e-8 * largest);
}

TEST(LooseSlaves, OfASetThatCoversFacetsToo) {
    // a facet's four nodes and one beside them: all five are slaves
    const auto found = run({}, {{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0.5, 0.5, 0}, {2, 2, 0}});
    EXPECT_EQ(found->contact[0].pair().size(), 5);
    EXPECT_NEAR(found->steps.back().pairs[0].on_slave.z(), 4e3, 1e-6);
}

TEST(LooseSlaves, HaveNoAveragesAndAreOutside) {
    const auto said = [](const std::vector<scene::Override>& overrides, const std::vector<Vec3>& at) -> std::string {
        try {
            (void)run(overrides, at);
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(
        said({{"contact.joint.discretisation", "mortar"}}, feet),
        testing::HasSubstr("contact.joint.discretisation: expected node, where nodes of the slave cover no facet"));
    EXPECT_THAT(said({}, {{0, 0, 0}, {2, 0.5, 0}, {1, 1, 0.25}}),
                testing::HasSubstr("contact.joint.slave: expected nodes on the outside of their body"));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
