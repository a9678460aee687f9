#include "osculate/fe/facet_quadrature.hpp"

#include "element_cases.hpp"
#include "support/differences.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::fe::testing {
namespace {

constexpr double round_off = 1e-13; // sums of a few products of order one
constexpr double pressure = 2.5;

mesh::Facet facet_of(const std::vector<Index>& nodes) {
    mesh::Facet facet;
    facet.count = static_cast<int>(nodes.size());
    std::copy(nodes.begin(), nodes.end(), facet.nodes.begin());
    return facet;
}

const mesh::Facet triangle = facet_of({2, 0, 1});
const mesh::Facet quadrilateral = facet_of({0, 1, 2, 3});
const std::vector<Vec3> warped{{0, 0, 0}, {2, 0.1, 0.3}, {2.2, 1.5, -0.4}, {-0.3, 1, 0.5}};
const std::vector<Vec3> flat{{0, 0, 0}, {2, 0, 2}, {3, 2, 3}, {0, 1, 0}}; // in the plane x = z

Vec3 area_vector(const mesh::Facet& facet, const std::vector<Vec3>& x) {
    Vec3 sum = Vec3::Zero();
    for (int i = 1; i + 1 < facet.count; ++i) {
        const auto at = [&](int k) { return x[std::size_t(facet.nodes[std::size_t(k)])]; };
        sum += (at(i) - at(0)).cross(at(i + 1) - at(0)) / 2;
    }
    return sum;
}

TEST(TributaryAreas, OfATriangleAreAThirdEach) {
    const double third = area_vector(triangle, warped).norm() / 3;
    const auto areas = tributary_areas(triangle, warped);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(areas[i], third, round_off);
    EXPECT_EQ(areas[3], 0);
}

TEST(TributaryAreas, OfAFlatQuadrilateralSumToItsArea) {
    const auto areas = tributary_areas(quadrilateral, flat);
    EXPECT_NEAR(areas[0] + areas[1] + areas[2] + areas[3], area_vector(quadrilateral, flat).norm(), round_off);
}

TEST(TributaryAreas, OfARectangleAreAQuarterEach) {
    const auto areas = tributary_areas(quadrilateral, {{0, 0, 1}, {3, 0, 1}, {3, 2, 1}, {0, 2, 1}});
    for (const double area : areas) EXPECT_NEAR(area, 1.5, round_off);
}

TEST(TributaryAreas, OfATrapezoidAreTheExactIntegralsOfTheShapeFunctions) {
    // dA = (3 - eta) / 8 dxi deta, N_0 = (1 - xi) (1 - eta) / 4: N_0 dA integrates to 2 (6 + 2/3) / 32
    const auto areas = tributary_areas(quadrilateral, {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const double below = 2 * (2 * 3 + 2.0 / 3) / 32, above = 2 * (2 * 3 - 2.0 / 3) / 32;
    EXPECT_NEAR(areas[0], below, round_off);
    EXPECT_NEAR(areas[1], below, round_off);
    EXPECT_NEAR(areas[2], above, round_off);
    EXPECT_NEAR(areas[3], above, round_off);
}

TEST(PressureForces, SumToMinusPressureTimesTheAreaVector) {
    for (const auto& facet : {triangle, quadrilateral}) {
        const auto forces = pressure_forces(facet, warped, pressure);
        const Vec3 sum = forces[0] + forces[1] + forces[2] + forces[3];
        EXPECT_LT((sum + pressure * area_vector(facet, warped)).norm(), round_off);
    }
    EXPECT_EQ(pressure_forces(triangle, warped, pressure)[3], Vec3::Zero());
}

TEST(PressureForces, OfPositivePressurePushAgainstTheNormal) {
    for (const Vec3& force : pressure_forces(quadrilateral, flat, pressure)) {
        EXPECT_LT(force.dot(area_vector(quadrilateral, flat)), 0);
    }
}

TEST(PressureForces, OnAFlatFacetFollowTheTributaryAreas) {
    const auto areas = tributary_areas(quadrilateral, flat);
    const auto forces = pressure_forces(quadrilateral, flat, pressure);
    const Vec3 normal = area_vector(quadrilateral, flat).normalized();
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((forces[i] + pressure * areas[i] * normal).norm(), round_off);
}

TEST(PressureTangent, IsTheDerivativeOfTheForces) {
    for (const int count : {3, 4}) {
        mesh::Facet facet;
        facet.count = count;
        facet.nodes = {0, 1, 2, count == 4 ? 3 : -1};
        const Vector at{{0.1, 0, 0, 1, 0.2, -0.1, 1.1, 0.9, 0.3, -0.1, 1, 0.1}}; // warped
        const auto forces = [&](const Vector& x) {
            std::vector<Vec3> positions;
            for (int i = 0; i < count; ++i) positions.emplace_back(x.segment<3>(3 * i));
            const auto f = pressure_forces(facet, positions, pressure);
            Vector stacked(3 * count);
            for (int i = 0; i < count; ++i) stacked.segment<3>(3 * i) = f[static_cast<std::size_t>(i)];
            return stacked;
        };
        std::vector<Vec3> positions;
        for (int i = 0; i < count; ++i) positions.emplace_back(at.segment<3>(3 * i));
        const Matrix slope = osculate::testing::central_differences(forces, at.head(3 * count), 1e-5);
        // quadratic in the positions: central differences are exact but for round-off over the step
        EXPECT_LT((slope - pressure_tangent(facet, positions, pressure)).norm(), 1e-9 * pressure);
    }
}

class ClosedSurface : public ::testing::TestWithParam<ElementCase> {};

TEST_P(ClosedSurface, UnderPressureHasNoNetForceNorMomentAndEnclosesTheVolume) {
    const Eigen::Matrix3Xd X = distorted_element(GetParam().type);
    std::vector<Vec3> positions;
    for (int a = 0; a < X.cols(); ++a) positions.emplace_back(X.col(a));
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double work = 0; // of the position field: -p times the integral of x . n dA = -3 p V
    for (const auto& face : cell_faces(GetParam().type)) {
        const auto facet = facet_of(face);
        const auto forces = pressure_forces(facet, positions, pressure);
        for (std::size_t i = 0; i < face.size(); ++i) {
            const Vec3& x = positions[static_cast<std::size_t>(face[i])];
            force += forces[i];
            moment += x.cross(forces[i]);
            work += x.dot(forces[i]);
        }
    }
    EXPECT_LT(force.norm(), round_off);
    EXPECT_LT(moment.norm(), round_off);
    const double volume = GetParam().kernel({1.0, 0.3})->volume(X);
    EXPECT_NEAR(work, -3 * pressure * volume, 100 * round_off);
}

INSTANTIATE_TEST_SUITE_P(Every, ClosedSurface, ::testing::ValuesIn(all_cases), case_name);

} // namespace
} // namespace osculate::fe::testing
