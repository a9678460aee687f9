#include "element_cases.hpp"
#include "exact_rule.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <numeric>

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

const material::LinearElastic material{1.0, 0.3}; // stiffnesses and stresses of order one
constexpr double round_off = 1e-12;               // relative to them; a few hundred products each
constexpr double zero_energy = 1e-12;             // eigenvalues of rigid motions, relative to the largest
constexpr double resisting = 5e-4;                // the smallest other eigenvalue of these elements is above this

class Kernel : public ::testing::TestWithParam<ElementCase> {
protected:
    const Eigen::Matrix3Xd X = distorted_element(GetParam().type);
    const int n = static_cast<int>(X.cols());
    const mesh::CellInfo& info = mesh::cell_info(GetParam().type);
    const std::unique_ptr<ElementKernel> kernel = GetParam().kernel(material);

    [[nodiscard]] Matrix stiffness(const Eigen::Matrix3Xd& at) const {
        Matrix K(3 * n, 3 * n);
        kernel->stiffness(at, K);
        return K;
    }
};

/// A displacement gradient with no symmetry, and the strain it stands for.
Mat3 displacement_gradient() {
    Mat3 H;
    H << 0.3, -0.2, 0.5, 0.7, -0.4, 0.1, 0.25, 0.6, 0.35;
    return H;
}
Vec6 strain_of(const Mat3& H) {
    Vec6 e;
    e << H(0, 0), H(1, 1), H(2, 2), H(0, 1) + H(1, 0), H(1, 2) + H(2, 1), H(2, 0) + H(0, 2);
    return e;
}

TEST_P(Kernel, KnowsItsNodes) {
    EXPECT_EQ(kernel->nodes(), mesh::nodes_per_cell(GetParam().type));
}

TEST_P(Kernel, RigidMotionsGiveNoForce) {
    const Matrix K = stiffness(X);
    for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix3Xd shift = Vec3::Unit(k).replicate(1, n);
        const Eigen::Matrix3Xd turn = X.colwise().cross(Vec3::Unit(k));
        EXPECT_LT((K * shift.reshaped()).norm(), round_off) << "translation " << k;
        EXPECT_LT((K * turn.reshaped()).norm(), round_off) << "rotation " << k;
    }
}

TEST_P(Kernel, HasNoZeroEnergyModesButRigidMotions) {
    // eight points of a hex20 leave six modes to those that have a share of the weights
    const double share = GetParam().formulation == HexFormulation::reduced ? Hex20Reduced::share : 1;
    const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(stiffness(X)).eigenvalues();
    EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), zero_energy * values.maxCoeff());
    EXPECT_GT(values[6], share * resisting * values.maxCoeff());
}

TEST_P(Kernel, StiffnessIsSymmetric) {
    const Matrix K = stiffness(X);
    EXPECT_EQ((K - K.transpose()).norm(), 0);
}

TEST_P(Kernel, EnergyForceAndTangentAreThoseOfTheStiffness) {
    Eigen::Matrix3Xd u(3, n), f(3, n);
    for (int k = 0; k < u.size(); ++k) u(k % 3, k / 3) = scatter(50 + k);
    const Matrix K = stiffness(X);
    Matrix tangent(3 * n, 3 * n);
    double W = 0;
    EXPECT_TRUE(kernel->linear());
    EXPECT_TRUE(kernel->energy({X, u}, W).admissible());
    EXPECT_TRUE(kernel->internal_force({X, u}, f).admissible());
    EXPECT_TRUE(kernel->tangent({X, u, u}, tangent).admissible());
    const Vector expected = K * u.reshaped();
    EXPECT_LT((f.reshaped() - expected).norm(), round_off * expected.norm());
    EXPECT_NEAR(W, u.reshaped().dot(expected) / 2, round_off * W);
    EXPECT_EQ(tangent, K);
}

TEST_P(Kernel, EnergyOfALinearFieldIsExact) {
    const Mat3 H = displacement_gradient();
    const Vector u = (H * X).reshaped();
    const Vec6 strain = strain_of(H);
    const double energy = 0.5 * strain.dot(material.stress(strain)) * kernel->volume(X);
    EXPECT_NEAR(0.5 * u.dot(stiffness(X) * u), energy, round_off * energy);
}

TEST_P(Kernel, LinearFieldGivesItsConstantStressAtEveryNode) {
    const Mat3 H = displacement_gradient();
    Matrix stress(6, n);
    kernel->nodal_stress({X, H * X}, stress);
    const Vec6 expected = material.stress(strain_of(H));
    EXPECT_LT((stress.colwise() - expected).norm(), round_off);
}

TEST_P(Kernel, StiffnessTurnsAndTravelsWithTheElement) {
    const Mat3 R = Eigen::AngleAxisd(0.9, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
    Matrix T = Matrix::Zero(3 * n, 3 * n);
    for (int a = 0; a < n; ++a) T.block<3, 3>(3 * a, 3 * a) = R;
    const Matrix expected = T * stiffness(X) * T.transpose();
    const Matrix moved = stiffness((R * X).colwise() + Vec3(3, -2, 5));
    EXPECT_LT((moved - expected).norm(), round_off * expected.norm());
}

TEST_P(Kernel, StiffnessGrowsWithTheSizeOfTheElement) {
    const Matrix K = stiffness(X);
    EXPECT_LT((stiffness(1000 * X) - 1000 * K).norm(), 1000 * round_off * K.norm());
}

TEST_P(Kernel, EverySymmetryOfTheShapePermutesTheStiffness) {
    // a permutation is a symmetry when an orientation-keeping affine map carries the reference nodes into that order
    const Eigen::Matrix3Xd c = reference_positions(GetParam().type);
    Matrix affine(n, 4);
    affine << c.transpose(), Vector::Ones(n);
    const Matrix inverse = affine.completeOrthogonalDecomposition().pseudoInverse();
    const Matrix misfit = Matrix::Identity(n, n) - affine * inverse;
    const Matrix K = stiffness(X);
    std::vector<int> p(static_cast<std::size_t>(n));
    std::iota(p.begin(), p.end(), 0);
    const auto corners_end = p.begin() + info.corners();
    int symmetries = 0;
    do {
        for (std::size_t m = 0; m < info.edges.size(); ++m) { // midside nodes follow the corners
            const auto& [a, b] = info.edges[m];
            const Vec3 middle = (c.col(p[std::size_t(a)]) + c.col(p[std::size_t(b)])) / 2;
            Index nearest = 0;
            (c.colwise() - middle).colwise().norm().minCoeff(&nearest);
            p[std::size_t(info.corners()) + m] = nearest;
        }
        const Matrix permuted = c(Eigen::all, p).transpose();
        if ((misfit * permuted).norm() > round_off || (inverse * permuted).topRows<3>().determinant() < 0) continue;
        ++symmetries;
        std::vector<int> dofs;
        for (const int a : p)
            for (int d = 0; d < 3; ++d) dofs.push_back(3 * a + d);
        const Matrix expected = K(dofs, dofs);
        EXPECT_LT((stiffness(X(Eigen::all, p)) - expected).norm(), round_off * K.norm());
    } while (std::next_permutation(p.begin(), corners_end));
    const std::map<std::size_t, int> rotations{{4, 12}, {5, 6}, {6, 24}}; // by the number of faces
    EXPECT_EQ(symmetries, rotations.at(info.faces.size()));
}

TEST_P(Kernel, BodyForceSumsToForcePerVolumeTimesVolume) {
    const Vec3 b(1, -2, 3);
    Eigen::Matrix3Xd f(3, n);
    kernel->body_force(X, b, f);
    EXPECT_LT((f.rowwise().sum() - b * kernel->volume(X)).norm(), round_off);
}

TEST_P(Kernel, BodyForceOfAnAffineElementIsSharedAsItsShapeFunctionsAre) {
    const Eigen::Matrix3Xd affine = distorted_element(GetParam().type, 0);
    const Vec3 b(1, -2, 3);
    Eigen::Matrix3Xd f(3, n);
    kernel->body_force(affine, b, f);
    Vector share = Vector::Zero(n);
    with_element(GetParam().type, [&]<class E>() {
        for (const auto& [xi, weight] : exact_rule<E>()) share += weight * E::shape(xi);
    });
    share /= share.sum();
    EXPECT_LT((f - b * kernel->volume(affine) * share.transpose()).norm(), round_off);
}

TEST_P(Kernel, BodyForceOfATaperedElementLeansToItsThickEnd) {
    if (info.faces.size() == 4) GTEST_SKIP() << "a straight tetrahedron is always affine";
    if (!info.edges.empty()) GTEST_SKIP() << "midside nodes have other shares";
    // the top shrinks to half: over a height z from 0 to 1 the section is A (1 - z/2)^2; with N = 1 - z and z its
    // integrals are 17/48 A and 11/48 A
    Eigen::Matrix3Xd tapered = reference_positions(GetParam().type);
    const double straight = kernel->volume(tapered);
    tapered.topRightCorner(2, n / 2) /= 2;
    Eigen::Matrix3Xd f(3, n);
    kernel->body_force(tapered, Vec3::UnitX(), f);
    for (int a = 0; a < n; ++a) {
        const double section = straight / (n / 2);
        EXPECT_NEAR(f(0, a), section * (a < n / 2 ? 17 : 11) / 48, round_off) << "node " << a;
    }
}

TEST_P(Kernel, StressLinearInSpaceIsExactAtTheNodesOfAStraightElement) {
    if (GetParam().type == mesh::CellType::tet4 || GetParam().formulation != HexFormulation::full) {
        GTEST_SKIP() << "strain is not the displacement's own, or constant";
    }
    const Eigen::Matrix3Xd straight = Vec3(2, 1.5, 0.5).asDiagonal() * reference_positions(GetParam().type);
    Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, n);
    u.row(0) = straight.row(0).cwiseProduct(straight.row(2)); // u = (x z, 0, 0): eps_xx = z, gamma_zx = x
    Matrix stress(6, n);
    kernel->nodal_stress({straight, u}, stress);
    for (int a = 0; a < n; ++a) {
        Vec6 strain = Vec6::Zero();
        strain[0] = straight(2, a);
        strain[5] = straight(0, a);
        EXPECT_LT((stress.col(a) - material.stress(strain)).norm(), round_off) << "node " << a;
    }
}

TEST_P(Kernel, InvertedElementIsRefused) {
    const Eigen::Matrix3Xd mirrored = Vec3(1, 1, -1).asDiagonal() * X;
    Matrix K(3 * n, 3 * n);
    EXPECT_THROW(kernel->stiffness(mirrored, K), std::runtime_error);
    EXPECT_THROW((void)kernel->volume(mirrored), std::runtime_error);
    EXPECT_THROW((void)kernel->volume(0 * X), std::runtime_error);
}

TEST_P(Kernel, PatchOfDistortedElementsReproducesConstantStrain) {
    // every node of the grid is moved off its place; only the surface nodes are told the linear field
    int count = 0;
    const int boxes = boxes_per_cell(GetParam().type) == 1 ? 3 : 4;
    Grid grid(GetParam(), material, {boxes, boxes, boxes}, [&](const Vec3& x) {
        const Vec3 shift(scatter(count), scatter(count + 1), scatter(count + 2));
        count += 3;
        return Vec3(x + 0.06 * shift);
    });
    grid.straighten_edges();
    const Mat3 H = displacement_gradient();
    const Eigen::Matrix3Xd linear = H * grid.X;
    std::vector<bool> fixed(static_cast<std::size_t>(grid.X.size()), true);
    Eigen::Matrix3Xd prescribed = linear;
    for (int k = 1; k < boxes; ++k)
        for (int j = 1; j < boxes; ++j)
            for (int i = 1; i < boxes; ++i)
                for (int d = 0; d < 3; ++d) {
                    fixed[static_cast<std::size_t>(3 * grid.node(i, j, k) + d)] = false;
                    prescribed(d, grid.node(i, j, k)) = 0;
                }
    const Eigen::Matrix3Xd u = grid.solve(fixed, prescribed, Eigen::Matrix3Xd::Zero(3, grid.X.cols()));
    const Eigen::Matrix3Xd error = u - linear;
    const Vec6 expected = material.stress(strain_of(H));
    Matrix stress(6, n);
    for (const auto& cell : grid.cells) {
        EXPECT_LT(grid.gather(cell, error).norm(), round_off); // some nodes of the grid may be in no cell
        kernel->nodal_stress({grid.gather(cell, grid.X), grid.gather(cell, u)}, stress);
        EXPECT_LT((stress.colwise() - expected).norm(), round_off);
    }
}

INSTANTIATE_TEST_SUITE_P(Every, Kernel, ::testing::ValuesIn(all_cases), case_name);

} // namespace
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE
