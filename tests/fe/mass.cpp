#include "element_cases.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

const material::LinearElastic material{1.0, 0.3}; // mass does not depend on it
constexpr double rho = 2.5;
constexpr double round_off = 1e-13; // relative to the mass; a few hundred products

class Mass : public ::testing::TestWithParam<ElementCase> {
protected:
    const std::unique_ptr<ElementKernel> kernel = GetParam().kernel(material);
    const int n = kernel->nodes();

    [[nodiscard]] Matrix mass(const Eigen::Matrix3Xd& X) const {
        Matrix M(n, n);
        kernel->mass(X, rho, M);
        return M;
    }
    [[nodiscard]] Vector lumped(const Eigen::Matrix3Xd& X) const {
        Vector m(n);
        kernel->lumped_mass(X, rho, m);
        return m;
    }
};

TEST_P(Mass, SumsToDensityTimesVolume) {
    const Eigen::Matrix3Xd X = distorted_element(GetParam().type);
    const double total = rho * kernel->volume(X);
    EXPECT_NEAR(mass(X).sum(), total, round_off * total);
    EXPECT_NEAR(lumped(X).sum(), total, round_off * total);
}

TEST_P(Mass, IsSymmetricAndPositiveDefinite) {
    const Matrix M = mass(distorted_element(GetParam().type));
    EXPECT_EQ((M - M.transpose()).norm(), 0);
    const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(M).eigenvalues();
    EXPECT_GT(values.minCoeff(), 1e-3 * values.maxCoeff()); // 1/27 for a straight hexahedron, 1/63 for tet10
}

TEST_P(Mass, LumpedIsPositiveAtEveryNode) {
    // far more distorted than a mesh should be, and flattened
    const Eigen::Matrix3Xd flat = Vec3(1, 1, 0.01).asDiagonal() * distorted_element(GetParam().type);
    for (const double amount : {0.0, 0.15}) {
        const Vector m = lumped(distorted_element(GetParam().type, amount));
        EXPECT_GT(m.minCoeff(), 0.01 * m.sum()) << "distortion " << amount;
    }
    EXPECT_GT(lumped(flat).minCoeff(), 0.01 * lumped(flat).sum());
}

TEST_P(Mass, LumpedByRowsKeepsTheCentreOfMass) {
    if (!mesh::cell_info(GetParam().type).edges.empty()) GTEST_SKIP() << "row sums are negative at its corners";
    const Eigen::Matrix3Xd X = distorted_element(GetParam().type);
    const Vec3 moment = X * mass(X).rowwise().sum();
    EXPECT_LT((X * lumped(X) - moment).norm(), round_off * moment.norm());
}

TEST_P(Mass, OfABlockHasTheKineticEnergyAndInertiaOfTheRigidBody) {
    const Vec3 size(2, 3, 0.5);
    const Grid grid(GetParam(), material, {2, 2, 2}, [&](const Vec3& x) { return Vec3(size.cwiseProduct(x)); });
    const auto bilinear = [&](const Eigen::Matrix3Xd& v, const Eigen::Matrix3Xd& w) {
        double sum = 0;
        for (const auto& cell : grid.cells) {
            const Matrix M = mass(grid.gather(cell, grid.X));
            sum += (grid.gather(cell, v) * M).cwiseProduct(grid.gather(cell, w)).sum();
        }
        return sum;
    };
    const double total = rho * size.prod();
    const Vec3 velocity(1, -2, 0.5), spin(0.3, 0.7, -1.1);
    const Eigen::Matrix3Xd arms = grid.X.colwise() - size / 2;

    // inertia tensor about the centre: I_xx = m (b^2 + c^2) / 12, no products
    Mat3 inertia;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            inertia(i, j) = bilinear(-arms.colwise().cross(Vec3::Unit(i)), -arms.colwise().cross(Vec3::Unit(j)));
    const Vec3 squares = size.cwiseAbs2();
    const Vec3 expected = total / 12 * (Vec3::Constant(squares.sum()) - squares);
    EXPECT_LT((inertia - Mat3(expected.asDiagonal())).norm(), round_off * expected.norm());

    const Eigen::Matrix3Xd v = (-arms.colwise().cross(spin)).colwise() + velocity;
    const double energy = total * velocity.squaredNorm() / 2 + spin.dot(expected.asDiagonal() * spin) / 2;
    EXPECT_NEAR(bilinear(v, v) / 2, energy, round_off * energy);
}

INSTANTIATE_TEST_SUITE_P(Every, Mass, ::testing::ValuesIn(all_cases), case_name);

} // namespace
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE
