#include "osculate/fe/bad_jacobians.hpp"

#include "element_cases.hpp"
#include "osculate/mesh/quality.hpp"

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

std::vector<Vec3> as_list(const Eigen::Matrix3Xd& X) {
    return {X.colwise().begin(), X.colwise().end()};
}

/// One element of a type, with the nodes 0, 1, ...
mesh::ElementBlock one(mesh::CellType type) {
    mesh::ElementBlock block{type, {}};
    for (int a = 0; a < mesh::nodes_per_cell(type); ++a) block.connectivity.push_back(a);
    return block;
}

class BadJacobians : public ::testing::TestWithParam<mesh::CellType> {};

TEST_P(BadJacobians, AreNotInASoundElement) {
    EXPECT_TRUE(bad_jacobians(one(GetParam()), as_list(distorted_element(GetParam()))).empty());
}

TEST_P(BadJacobians, AreInAnElementInsideOutAndInAFlatOne) {
    const Eigen::Matrix3Xd X = distorted_element(GetParam());
    mesh::ElementBlock three = one(GetParam());
    const std::vector<Index> nodes = three.connectivity;
    const auto n = static_cast<Index>(nodes.size());
    Eigen::Matrix3Xd all(3, 3 * n);
    all << Vec3(1, 1, -1).asDiagonal() * X, X, Vec3(1, 1, 0).asDiagonal() * X;
    for (const Index shift : {n, 2 * n})
        for (const Index node : nodes) three.connectivity.push_back(node + shift);
    const auto bad = bad_jacobians(three, as_list(all));
    ASSERT_EQ(bad.size(), 2u);
    EXPECT_EQ(bad[0].element, 0);
    EXPECT_EQ(bad[1].element, 2);
    EXPECT_EQ(bad[1].place.z(), 0);
}

/// Whatever a kernel refuses has been found before.
TEST_P(BadJacobians, AreInEveryElementThatAKernelRefuses) {
    const auto kernel = make_kernel(GetParam(), HexFormulation::full, material::LinearElastic{1, 0.3});
    const int n = kernel->nodes();
    Matrix K(3 * n, 3 * n);
    int refused = 0;
    for (int k = 0; k < 500; ++k) {
        Eigen::Matrix3Xd X = reference_positions(GetParam());
        for (int i = 0; i < X.size(); ++i) X(i % 3, i / 3) += scatter(1000 * k + i);
        try {
            kernel->stiffness(X, K);
            (void)kernel->volume(X);
        } catch (const std::runtime_error&) {
            ++refused;
            EXPECT_FALSE(bad_jacobians(one(GetParam()), as_list(X)).empty()) << k;
        }
    }
    EXPECT_GT(refused, 0) << "nothing was asked";
}

INSTANTIATE_TEST_SUITE_P(Every, BadJacobians, ::testing::ValuesIn(all_types()),
                         [](const auto& type) { return std::string(mesh::cell_info(type.param).name); });

TEST(BadJacobiansOfTet10, AreFoundAtAQuadraturePointBetweenSoundNodes) {
    Eigen::Matrix3Xd X = Tet10::node_positions();
    X.col(4) = Vec3(0.5, -0.3, 0);
    X.col(5) = Vec3(0.1, 0.5, 0);
    X.col(6) = Vec3(0, 0.8, 0);
    const mesh::ElementBlock block = one(mesh::CellType::tet10);
    EXPECT_EQ(mesh::bad_corner(block.type, block.connectivity, as_list(X)), -1);
    const auto bad = bad_jacobians(block, as_list(X));
    ASSERT_EQ(bad.size(), 1u);
    EXPECT_LE((X * Tet10::gradient(Tet10::quadrature()[2].xi)).determinant(), 0);
}

TEST(BadJacobiansOfTet10, AreFoundAtAMidsideNodeWhereNoKernelTakesThem) {
    Eigen::Matrix3Xd X = Tet10::node_positions();
    X.col(6) = Vec3(0, 0.9, -0.1);
    X.col(9) = Vec3(-0.4, 0.5, 0.5);
    const auto kernel = make_kernel(mesh::CellType::tet10, HexFormulation::full, material::LinearElastic{1, 0.3});
    Matrix K(30, 30);
    EXPECT_NO_THROW(kernel->stiffness(X, K));
    EXPECT_NO_THROW((void)kernel->volume(X));
    const auto bad = bad_jacobians(one(mesh::CellType::tet10), as_list(X));
    ASSERT_EQ(bad.size(), 1u);
    EXPECT_LT((bad[0].place - X.col(9)).norm(), 1e-15);
}

} // namespace
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE
