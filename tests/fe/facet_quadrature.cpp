#include "osculate/fe/facet_quadrature.hpp"

#include "element_cases.hpp"
#include "support/differences.hpp"

#include <Eigen/Geometry>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <utility>

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-13; // sums of a few products of order one
constexpr double pressure = 2.5;

mesh::SurfaceFace face_of(const std::vector<Index>& nodes) {
    mesh::SurfaceFace face;
    face.count = static_cast<int>(nodes.size());
    std::copy(nodes.begin(), nodes.end(), face.nodes.begin());
    return face;
}

const mesh::SurfaceFace triangle = face_of({2, 0, 1});
const mesh::SurfaceFace quadrilateral = face_of({0, 1, 2, 3});
const mesh::SurfaceFace six_nodes = face_of({0, 1, 2, 3, 4, 5});
const mesh::SurfaceFace eight_nodes = face_of({0, 1, 2, 3, 4, 5, 6, 7});
const std::vector<Vec3> bent{{0, 0, 0},        {2, 0.1, 0.3},    {2.2, 1.5, -0.4}, {-0.3, 1, 0.5},
                             {1.1, -0.1, 0.3}, {2.3, 0.9, -0.1}, {0.9, 1.4, 0.2},  {-0.2, 0.4, 0.1}};
const std::vector<Vec3> straight{{0, 0, 0},       {2, 0.1, 0.3},     {0.2, 1.5, -0.4},
                                 {1, 0.05, 0.15}, {1.1, 0.8, -0.05}, {0.1, 0.75, -0.2}};
const std::vector<Vec3> curved{{0, 0, 0},        {2, 0.1, 0.3},   {0.2, 1.5, -0.4},
                               {1.1, -0.1, 0.4}, {1.2, 0.9, 0.3}, {0, 0.7, 0.1}};
const std::vector<Vec3> warped{{0, 0, 0}, {2, 0.1, 0.3}, {2.2, 1.5, -0.4}, {-0.3, 1, 0.5}};
const std::vector<Vec3> flat{{0, 0, 0}, {2, 0, 2}, {3, 2, 3}, {0, 1, 0}}; // in the plane x = z

Vec3 area_vector(const mesh::SurfaceFace& face, const std::vector<Vec3>& x) {
    Vec3 sum = Vec3::Zero();
    for (int i = 1; i + 1 < face.count; ++i) {
        const auto at = [&](int k) { return x[std::size_t(face.nodes[std::size_t(k)])]; };
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
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(areas[i], 1.5, round_off);
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
    for (const auto& face : {triangle, quadrilateral}) {
        const auto forces = pressure_forces(face, warped, pressure);
        const Vec3 sum = forces[0] + forces[1] + forces[2] + forces[3];
        EXPECT_LT((sum + pressure * area_vector(face, warped)).norm(), round_off);
    }
    EXPECT_EQ(pressure_forces(triangle, warped, pressure)[3], Vec3::Zero());
}

TEST(PressureForces, OfPositivePressurePushAgainstTheNormal) {
    const auto forces = pressure_forces(quadrilateral, flat, pressure);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(forces[i].dot(area_vector(quadrilateral, flat)), 0);
}

TEST(PressureForces, OnAFlatFacetFollowTheTributaryAreas) {
    const auto areas = tributary_areas(quadrilateral, flat);
    const auto forces = pressure_forces(quadrilateral, flat, pressure);
    const Vec3 normal = area_vector(quadrilateral, flat).normalized();
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((forces[i] + pressure * areas[i] * normal).norm(), round_off);
}

TEST(PressureTangent, IsTheDerivativeOfTheForces) {
    mesh::SurfaceFace part = six_nodes;
    part.pieces = {true, false, false, true};
    mesh::SurfaceFace cut = eight_nodes;
    cut.pieces = {false, true, false, false, true};
    for (const mesh::SurfaceFace& facet : {face_of({0, 1, 2}), quadrilateral, six_nodes, part, eight_nodes, cut}) {
        const int count = facet.count;
        Vector at(3 * count);
        for (int i = 0; i < count; ++i)
            at.segment<3>(3 * i) = (count == 8 ? bent : count == 6 ? curved : warped)[std::size_t(i)];
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
        const Matrix slope = osculate::support::central_differences(forces, at, 1e-5);
        // quadratic in the positions: central differences are exact but for round-off over the step
        EXPECT_LT((slope - pressure_tangent(facet, positions, pressure)).norm(), 1e-9 * pressure);
    }
}

// ---- six-node faces ---------------------------------------------------------------------------------------------------

/// Integral of f(N, x, n dA) over parts of a six-node face, from its shape functions by products of barycentric
/// coordinates written out anew, and a product rule of Gauss points collapsed into the triangle (exact to degree 8).
/// @param inside  whether the point (xi, eta) counts; the rule goes over each of the four quarters
void over_six_nodes(const std::vector<Vec3>& X, const std::array<bool, 4>& quarters,
                    const std::function<void(const std::array<double, 6>&, const Vec3&, const Vec3&)>& f) {
    constexpr std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                       0.9061798459386640};
    constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                           0.4786286704993665, 0.2369268850561891};
    const std::array<std::array<Vec2, 3>, 4> corners{{{Vec2(0, 0), Vec2(0.5, 0), Vec2(0, 0.5)},
                                                      {Vec2(0.5, 0), Vec2(1, 0), Vec2(0.5, 0.5)},
                                                      {Vec2(0, 0.5), Vec2(0.5, 0.5), Vec2(0, 1)},
                                                      {Vec2(0.5, 0), Vec2(0.5, 0.5), Vec2(0, 0.5)}}};
    for (std::size_t q = 0; q < 4; ++q) {
        if (!quarters[q]) continue;
        for (std::size_t i = 0; i < 5; ++i)
            for (std::size_t j = 0; j < 5; ++j) {
                const double a = (1 + at[i]) / 2, b = (1 + at[j]) / 2 * (1 - a);
                const Vec2 xi =
                    corners[q][0] + a * (corners[q][1] - corners[q][0]) + b * (corners[q][2] - corners[q][0]);
                const double w = weight[i] * weight[j] / 4 * (1 - a) / 4; // a quarter of the unit triangle's 1/2
                const double r = xi[0], s = xi[1], t = 1 - r - s;
                const std::array<double, 6> N{t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1),
                                              4 * t * r,       4 * r * s,       4 * s * t};
                const std::array<double, 6> Nr{1 - 4 * t, 4 * r - 1, 0, 4 * (t - r), 4 * s, -4 * s};
                const std::array<double, 6> Ns{1 - 4 * t, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)};
                Vec3 x = Vec3::Zero(), x_r = x, x_s = x;
                for (std::size_t c = 0; c < 6; ++c) {
                    x += N[c] * X[c];
                    x_r += Nr[c] * X[c];
                    x_s += Ns[c] * X[c];
                }
                f(N, x, w * x_r.cross(x_s));
            }
    }
}

constexpr std::array<bool, 4> all_quarters{true, true, true, true};

TEST(SixNodeFace, HasAThirdOfItsAreaAtMiddleNodesAndNoneAtCorners) {
    const double area = (straight[1] - straight[0]).cross(straight[2] - straight[0]).norm() / 2;
    const auto areas = tributary_areas(six_nodes, straight);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(areas[i], 0, round_off);
        EXPECT_NEAR(areas[3 + i], area / 3, round_off);
    }
    EXPECT_NEAR(fe::area(six_nodes, straight), area, round_off);
}

TEST(SixNodeFace, UnderPressureHasTheForcesOfGaussQuadratureWhenCurved) {
    const std::vector<std::array<bool, 4>> parts{
        all_quarters, {true, false, false, false}, {false, true, false, true}, {false, false, true, false}};
    for (const auto& quarters : parts) {
        mesh::SurfaceFace face = six_nodes;
        face.pieces = {quarters[0], quarters[1], quarters[2], quarters[3]};
        std::array<Vec3, 6> expected;
        expected.fill(Vec3::Zero());
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
        over_six_nodes(curved, quarters, [&](const auto& N, const Vec3& x, const Vec3& n_dA) {
            for (std::size_t i = 0; i < 6; ++i) expected[i] -= pressure * N[i] * n_dA;
            force -= pressure * n_dA;
            moment -= x.cross(pressure * n_dA);
        });
        const auto forces = pressure_forces(face, curved, pressure);
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_LT((forces[i] - expected[i]).norm(), round_off);
            force -= forces[i];
            moment -= curved[i].cross(forces[i]);
        }
        EXPECT_LT(force.norm(), round_off);
        EXPECT_LT(moment.norm(), round_off);
    }
}

TEST(SixNodeFace, IsTheSumOfItsQuarters) {
    std::array<double, 6> areas{};
    for (std::size_t q = 0; q < 4; ++q) {
        mesh::SurfaceFace part = six_nodes;
        part.pieces = {q == 0, q == 1, q == 2, q == 3};
        const auto own = tributary_areas(part, straight);
        for (std::size_t i = 0; i < 6; ++i) areas[i] += own[i];
        EXPECT_NEAR(fe::area(part, straight), fe::area(six_nodes, straight) / 4, round_off) << q;
    }
    const auto whole = tributary_areas(six_nodes, straight);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(areas[i], whole[i], round_off);
}

TEST(SixNodeFace, CoversASphereAtFourthOrderAndItsPlaneQuartersAtSecond) {
    // an octant of the unit sphere: the triangle x + y + z = 1, cut evenly, all nodes moved out to the sphere
    const auto errors = [](int n) {
        const auto node = [&](int i, int j) { return Vec3(2 * n - i - j, i, j).normalized(); };
        double six = 0, plane = 0;
        const auto add = [&](std::array<int, 2> a, int s) { // s = -1: the other way round
            const std::vector<Vec3> x{node(a[0], a[1]),     node(a[0] + 2 * s, a[1]), node(a[0], a[1] + 2 * s),
                                      node(a[0] + s, a[1]), node(a[0] + s, a[1] + s), node(a[0], a[1] + s)};
            six += fe::area(six_nodes, x);
            for (const auto& quarter : {face_of({0, 3, 5}), face_of({3, 1, 4}), face_of({5, 4, 2}), face_of({3, 4, 5})})
                plane += fe::area(quarter, x);
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add({2 * i, 2 * j}, 1);
                if (i + j + 1 < n) add({2 * i + 2, 2 * j + 2}, -1);
            }
        const double octant = std::numbers::pi / 2;
        return std::pair{std::abs(six - octant), std::abs(plane - octant)};
    };
    const auto [six, plane] = errors(8);
    const auto [six_fine, plane_fine] = errors(16);
    EXPECT_NEAR(std::log2(six / six_fine), 4, 0.15);
    EXPECT_NEAR(std::log2(plane / plane_fine), 2, 0.15);
}

TEST(SixNodeFaces, AroundACurvedTet10UnderPressureHaveNoNetForceNorMomentAndEncloseItsVolume) {
    Eigen::Matrix3Xd X = distorted_element(mesh::CellType::tet10);
    for (int k = 12; k < 30; ++k) X(k % 3, k / 3) += 0.05 * scatter(k);
    std::vector<Vec3> positions;
    for (int a = 0; a < X.cols(); ++a) positions.emplace_back(X.col(a));
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double work = 0; // of the position field: -p times the integral of x . n dA = -3 p V
    for (const auto& nodes : {face_of({0, 1, 3, 4, 8, 7}), face_of({1, 2, 3, 5, 9, 8}), face_of({2, 0, 3, 6, 7, 9}),
                              face_of({0, 2, 1, 6, 5, 4})}) {
        const auto forces = pressure_forces(nodes, positions, pressure);
        for (std::size_t i = 0; i < 6; ++i) {
            const Vec3& x = positions[static_cast<std::size_t>(nodes.nodes[i])];
            force += forces[i];
            moment += x.cross(forces[i]);
            work += x.dot(forces[i]);
        }
    }
    EXPECT_LT(force.norm(), round_off);
    EXPECT_LT(moment.norm(), round_off);
    const double volume =
        make_kernel(mesh::CellType::tet10, HexFormulation::full, material::LinearElastic{1, 0.3})->volume(X);
    EXPECT_NEAR(work, -3 * pressure * volume, 100 * round_off);
}

// ---- eight-node faces -------------------------------------------------------------------------------------------------

TEST(EightNodeFace, HasAThirdOfAParallelogramsAreaAtMiddleNodesAndMinusATwelfthAtCorners) {
    const Vec3 a(2, 0.1, 0.3), b(0.4, 1.5, -0.2), o(1, 1, 1);
    const std::vector<Vec3> x{o, o + a, o + a + b, o + b, o + a / 2, o + a + b / 2, o + a / 2 + b, o + b / 2};
    const double area = a.cross(b).norm();
    const auto areas = tributary_areas(eight_nodes, x);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(areas[i], -area / 12, round_off);
        EXPECT_NEAR(areas[4 + i], area / 3, round_off);
    }
}

TEST(EightNodeFace, UnderPressureIsTheSumOfItsPieces) {
    std::array<Vec3, 8> sum;
    sum.fill(Vec3::Zero());
    for (std::size_t piece = 0; piece < 5; ++piece) {
        mesh::SurfaceFace part = eight_nodes;
        part.pieces.fill(false);
        part.pieces[piece] = true;
        const auto forces = pressure_forces(part, bent, pressure);
        for (std::size_t i = 0; i < 8; ++i) sum[i] += forces[i];
    }
    const auto whole = pressure_forces(eight_nodes, bent, pressure);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_LT((sum[i] - whole[i]).norm(), 10 * round_off) << i;
}

TEST(EightNodeFace, WithMiddleNodesHalfwayIsTheQuadrilateral) {
    std::vector<Vec3> x = warped;
    for (std::size_t i = 0; i < 4; ++i) x.push_back((warped[i] + warped[(i + 1) % 4]) / 2);
    // each bilinear function is that of its corner and half of those of the middles next to it
    const auto eight = pressure_forces(eight_nodes, x, pressure),
               four = pressure_forces(quadrilateral, warped, pressure);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT((eight[i] + (eight[4 + i] + eight[4 + (i + 3) % 4]) / 2 - four[i]).norm(), 10 * round_off) << i;
}

TEST(EightNodeFace, HasPiecesThatCoverItOnce) {
    const Vec3 a(2, 0.1, 0.3), b(0.4, 1.5, -0.2);
    const std::vector<Vec3> x{Vec3::Zero(), a, a + b, b, a / 2, a + b / 2, a / 2 + b, b / 2};
    for (std::size_t piece = 0; piece < 5; ++piece) {
        mesh::SurfaceFace part = eight_nodes;
        part.pieces.fill(false);
        part.pieces[piece] = true;
        EXPECT_NEAR(fe::area(part, x), a.cross(b).norm() * (piece == 4 ? 1.0 / 2 : 1.0 / 8), round_off) << piece;
    }
}

// ---- closed surfaces --------------------------------------------------------------------------------------------------

class ClosedSurface : public ::testing::TestWithParam<ElementCase> {};

TEST_P(ClosedSurface, UnderPressureHasNoNetForceNorMomentAndEnclosesTheVolume) {
    const Eigen::Matrix3Xd X = distorted_element(GetParam().type);
    std::vector<Vec3> positions;
    for (int a = 0; a < X.cols(); ++a) positions.emplace_back(X.col(a));
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double work = 0; // of the position field: -p times the integral of x . n dA = -3 p V
    for (const auto& face : cell_faces(GetParam().type)) {
        const auto forces = pressure_forces(face_of(face), positions, pressure);
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
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE
