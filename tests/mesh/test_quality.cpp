#include "mesh/shapes.hpp"
#include "osculate/mesh/quality.hpp"
#include "support/floating_point_traps.hpp"

#include <gmock/gmock.h>
#include <limits>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class EveryElement : public ::testing::TestWithParam<std::pair<std::string, CellType>> {
protected:
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, GetParam().second);
    int stride = nodes_per_cell(GetParam().second);
};

TEST_P(EveryElement, IsCaughtWhenTurnedInsideOut) {
    auto& connectivity = mesh.blocks[0].connectivity;
    const std::vector<Index> before = connectivity;
    for (int i = 0; i < stride; ++i)
        connectivity[3 * stride + i] = before[3 * stride + cell_info(GetParam().second).mirrored[i]];
    EXPECT_THAT(faults(mesh),
                ElementsAre(AllOf(HasSubstr(GetParam().first + " element 3 of block 0"), HasSubstr("Jacobian"))));
    EXPECT_LT(cell_volume(GetParam().second, {connectivity.data() + 3 * stride, std::size_t(stride)}, mesh.nodes), 0);
}

TEST_P(EveryElement, IsCaughtWhenFlat) {
    for (Vec3& node : mesh.nodes) node.z() = 0;
    EXPECT_THAT(faults(mesh, 1000), SizeIs(mesh.element_count()));
}

INSTANTIATE_TEST_SUITE_P(Quality, EveryElement, ::testing::ValuesIn(fixtures::element_types()),
                         [](const auto& element) { return element.param.first; });

TEST(Quality, CatchesACornerFoldedInward) {
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    mesh.nodes[7] = {0.2, 0.2, 0.2}; // still a positive volume
    EXPECT_GT(cell_volume(CellType::hex8, mesh.blocks[0].connectivity, mesh.nodes), 0);
    EXPECT_THAT(faults(mesh), ElementsAre(HasSubstr("hex8 element 0 of block 0")));
}

TEST(Quality, CatchesAMidsideNodeTooCloseToACorner) {
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, CellType::tet10);
    mesh.blocks[0].connectivity.resize(10);
    const auto& nodes = mesh.blocks[0].connectivity;
    const Vec3 a = mesh.nodes[nodes[0]], b = mesh.nodes[nodes[1]];
    // on the edge at a fraction t the map is (4 t - 1) at corner 0: singular at a quarter
    const auto jacobian_faults = [&](double t) {
        mesh.nodes[nodes[4]] = (1 - t) * a + t * b;
        const auto all = faults(mesh, 1000);
        return std::count_if(all.begin(), all.end(),
                             [](const std::string& fault) { return fault.find("tet10") != std::string::npos; });
    };
    EXPECT_EQ(jacobian_faults(0.26), 0);
    EXPECT_EQ(jacobian_faults(0.24), 1);
    EXPECT_EQ(jacobian_faults(0.74), 0);
    EXPECT_EQ(jacobian_faults(0.76), 1);
}

TEST(Quality, NamesNodesThatAreNotFiniteOrNotUsedOrMissing) {
    const support::FloatingPointTraps suspended(false); // a comparison with NaN is an invalid operation
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 1, 1});
    mesh.nodes[5].y() = std::numeric_limits<double>::quiet_NaN();
    mesh.nodes.emplace_back(9, 9, 9);
    EXPECT_THAT(faults(mesh), ElementsAre(HasSubstr("node 5: position"), HasSubstr("node 12: no element")));
    mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 1, 1});
    mesh.blocks[0].connectivity[8] = 99;
    EXPECT_THAT(faults(mesh)[0], HasSubstr("element 1 of block 0: a node number is out of range"));
}

TEST(Quality, CountsTheFaultsBeyondTheLimit) {
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    for (int n = 0; n < 10; ++n) mesh.nodes.emplace_back(0, 0, 0);
    EXPECT_THAT(faults(mesh, 3),
                ElementsAre(HasSubstr("node 8"), HasSubstr("node 9"), HasSubstr("node 10"), HasSubstr("7 more")));
}

TEST(Quality, MeasuresTheVolumeOfATwistedHexahedron) {
    // x = X + c Y Z: twisted faces, Jacobian 1 everywhere.
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    for (Vec3& node : mesh.nodes) node.x() += 0.7 * node.y() * node.z();
    EXPECT_NEAR(cell_volume(CellType::hex8, mesh.blocks[0].connectivity, mesh.nodes), 1, 1e-15);
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
