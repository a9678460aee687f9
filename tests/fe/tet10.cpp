#include "element_cases.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/generators.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

const ElementCase tet10{"tet10", mesh::CellType::tet10, HexFormulation::full};
const ElementCase tet4{"tet4", mesh::CellType::tet4, HexFormulation::full};
const material::LinearElastic material{1.0, 0.3};
constexpr double round_off = 1e-11; // of dense solves with a few hundred unknowns

using Field = std::function<Vec3(const Vec3&)>;

/// Solves with `exact` prescribed on the surface of the unit cube and the body force b; returns u.
Eigen::Matrix3Xd solve(const Grid& grid, const Field& exact, const Field& b) {
    const auto [l, m, n] = grid.divisions;
    Eigen::Matrix3Xd prescribed = Eigen::Matrix3Xd::Zero(3, grid.X.cols());
    std::vector<bool> fixed(static_cast<std::size_t>(grid.X.size()), false);
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= m; ++j)
            for (int i = 0; i <= l; ++i) {
                if (i > 0 && i < l && j > 0 && j < m && k > 0 && k < n) continue;
                const int node = grid.node(i, j, k);
                prescribed.col(node) = exact(grid.X.col(node));
                for (int d = 0; d < 3; ++d) fixed[static_cast<std::size_t>(3 * node + d)] = true;
            }
    // b taken as constant in every element, at its centre: second order, as the gradients
    Eigen::Matrix3Xd f = Eigen::Matrix3Xd::Zero(3, grid.X.cols()), fe(3, grid.kernel->nodes());
    for (const auto& cell : grid.cells) {
        const Eigen::Matrix3Xd X = grid.gather(cell, grid.X);
        grid.kernel->body_force(X, b(X.leftCols<4>().rowwise().mean()), fe);
        for (std::size_t a = 0; a < cell.size(); ++a) f.col(cell[a]) += fe.col(int(a));
    }
    return grid.solve(fixed, prescribed, f);
}

Grid cube(const ElementCase& element, int boxes) {
    return {element, material, {boxes, boxes, boxes}, [](const Vec3& x) { return x; }};
}

TEST(Tet10, ReproducesEveryQuadraticField) {
    // u = (x^2 + y z, x y, z^2 - x z): Navier's equation mu lap u + (lambda + mu) grad div u + b = 0 with
    // lap u = (2, 0, 2), div u = 2 x + x + 2 z - x = 2 x + 2 z, its gradient (2, 0, 2)
    const Field exact = [](const Vec3& x) {
        return Vec3(x[0] * x[0] + x[1] * x[2], x[0] * x[1], x[2] * x[2] - x[0] * x[2]);
    };
    const Vec3 b = -(material.lambda() + 2 * material.mu()) * Vec3(2, 0, 2);
    Grid grid = cube(tet10, 4);
    for (const auto& cell : grid.cells) // inner corners move, edges stay straight
        for (std::size_t a = 0; a < 4; ++a) {
            const Vec3 x = grid.X.col(cell[a]);
            if ((x - Vec3::Constant(0.5)).norm() < 1e-9) grid.X.col(cell[a]) = Vec3(0.56, 0.47, 0.52);
        }
    grid.straighten_edges();
    const Eigen::Matrix3Xd u = solve(grid, exact, [&](const Vec3&) { return b; });
    for (int a = 0; a < grid.X.cols(); ++a) EXPECT_LT((u.col(a) - exact(grid.X.col(a))).norm(), round_off);
}

/// L2 norm of the error of the displacement gradient, by the rule of degree five.
double gradient_error(const ElementCase& element, int boxes) {
    // a shear u = (sin(pi y), 0, 0): lap u = -pi^2 u, div u = 0
    const double pi = 3.14159265358979323846;
    const Field exact = [&](const Vec3& x) { return Vec3(std::sin(pi * x[1]), 0, 0); };
    const Field b = [&](const Vec3& x) { return Vec3(material.mu() * pi * pi * std::sin(pi * x[1]), 0, 0); };
    const Grid grid = cube(element, boxes);
    const Eigen::Matrix3Xd u = solve(grid, exact, b);
    double sum = 0;
    for (const auto& cell : grid.cells) {
        const Eigen::Matrix3Xd X = grid.gather(cell, grid.X), ue = grid.gather(cell, u);
        for (const auto& [xi, weight] : Tet10::mass_quadrature()) {
            Matrix dN = Tet4::gradient(xi), N = Tet4::shape(xi);
            if (element.type == mesh::CellType::tet10) dN = Tet10::gradient(xi), N = Tet10::shape(xi);
            const Mat3 J = X * dN;
            Mat3 H = ue * dN * J.inverse();
            H(0, 1) -= pi * std::cos(pi * (X * N)(1, 0));
            sum += weight * J.determinant() * H.squaredNorm();
        }
    }
    return std::sqrt(sum);
}

TEST(Tet10, GradientsConvergeAtSecondOrderAndThoseOfTet4AtFirst) {
    constexpr double slack = 0.15; // coarse meshes are not quite asymptotic; measured 1.96 and 0.99
    EXPECT_NEAR(std::log2(gradient_error(tet10, 4) / gradient_error(tet10, 8)), 2, slack);
    EXPECT_NEAR(std::log2(gradient_error(tet4, 4) / gradient_error(tet4, 8)), 1, slack);
}

TEST(Tet10, WithCurvedEdgesHasRigidMotionsAndMassToo) {
    Eigen::Matrix3Xd X = Tet10::node_positions();
    for (int k = 12; k < 30; ++k) X(k % 3, k / 3) += 0.05 * scatter(k);
    const auto kernel = tet10.kernel(material);
    Matrix K(30, 30), M(10, 10);
    Vector m(10);
    kernel->stiffness(X, K);
    kernel->mass(X, 2, M);
    kernel->lumped_mass(X, 2, m);
    for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix3Xd shift = Vec3::Unit(k).replicate(1, 10), turn = X.colwise().cross(Vec3::Unit(k));
        EXPECT_LT((K * shift.reshaped()).norm(), round_off);
        EXPECT_LT((K * turn.reshaped()).norm(), round_off);
    }
    EXPECT_GT(m.minCoeff(), 0);
    EXPECT_NEAR(M.sum(), 2 * kernel->volume(X), round_off);
    EXPECT_NEAR(m.sum(), 2 * kernel->volume(X), round_off);
    // the volume by the divergence theorem over the six-node faces: det J is a cubic, the rule of degree five exact
    double volume = 0;
    constexpr std::array<std::array<int, 6>, 4> faces{
        {{0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {2, 0, 3, 6, 7, 9}, {0, 2, 1, 6, 5, 4}}};
    for (const auto& corners : faces) {
        constexpr int cells = 200; // midpoint rule on 200 x 200 triangles, error about 1 / 200^2 of a curvature of 0.1
        for (int i = 0; i < cells; ++i)
            for (int j = 0; i + j < cells; ++j)
                for (const bool upper : {false, true}) {
                    if (upper && i + j + 1 >= cells) continue;
                    const double third = upper ? 2.0 / 3 : 1.0 / 3;
                    const double r = (i + third) / cells, s = (j + third) / cells, t = 1 - r - s;
                    const std::array<double, 6> N{t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1),
                                                  4 * t * r,       4 * r * s,       4 * s * t};
                    const std::array<double, 6> Nr{1 - 4 * t, 4 * r - 1, 0, 4 * (t - r), 4 * s, -4 * s};
                    const std::array<double, 6> Ns{1 - 4 * t, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)};
                    Vec3 x = Vec3::Zero(), xr = Vec3::Zero(), xs = Vec3::Zero();
                    for (std::size_t c = 0; c < 6; ++c) {
                        x += N[c] * X.col(corners[c]);
                        xr += Nr[c] * X.col(corners[c]);
                        xs += Ns[c] * X.col(corners[c]);
                    }
                    volume += x.dot(xr.cross(xs)) / 6 / (cells * cells);
                }
    }
    EXPECT_NEAR(kernel->volume(X), volume, 1e-5);
}

TEST(Tet10, PressureOnAFacePushesOnItsMiddleNodesThroughItsCentre) {
    const mesh::Mesh block = mesh::make_block({0, 0, 0}, {2, 3, 1}, {2, 2, 1}, mesh::CellType::tet10);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    int faces = 0;
    for (const mesh::SurfaceFace& face : mesh::surface_faces(block, block.surfaces.at("z_max"))) {
        const auto forces = pressure_forces(face, block.nodes, 5);
        for (std::size_t i = 0; i < 6; ++i) {
            const Vec3& x = block.nodes[static_cast<std::size_t>(face.nodes[i])];
            force += forces[i];
            moment += (x - Vec3(1, 1.5, 1)).cross(forces[i]);
            EXPECT_NEAR(forces[i].z(), i < 3 ? 0 : -5 * (2.0 * 3 / 8) / 3, round_off); // eight faces
        }
        ++faces;
    }
    EXPECT_LT((force - Vec3(0, 0, -30)).norm(), round_off);
    EXPECT_LT(moment.norm(), round_off);
    EXPECT_EQ(faces, 8);
}

} // namespace
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE
