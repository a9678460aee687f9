/// Mass taken off contact nodes leaves a body's mass, centre and inertia as they were.

#include "osculate/mesh/generators.hpp"
#include "osculate/model/model.hpp"
#include "support/random.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

constexpr double kept_to = 1e-12; ///< of mass, first and second moments over the body's extents: ten sums of round-off

Body body_of(mesh::Mesh mesh) {
    Body body;
    body.name = "body";
    body.mesh = std::move(mesh);
    body.density.assign(body.mesh.blocks.size(), 1000);
    for (const mesh::ElementBlock& block : body.mesh.blocks)
        body.kernels.push_back(fe::make_kernel(block.type, HexFormulation::full, material::LinearElastic{1e6, 0.3}));
    return body;
}

std::vector<Body> one(mesh::Mesh mesh) {
    std::vector<Body> bodies;
    bodies.push_back(body_of(std::move(mesh)));
    return bodies;
}

/// Masses of nodes and between nodes, kg.
Matrix scalar(const linear::BlockMatrix& M) {
    Matrix m = Matrix::Zero(M.rows(), M.rows());
    for (Index i = 0; i < M.rows(); ++i)
        for (Index k = M.row_begin(i); k < M.row_end(i); ++k) m(i, M.column(k)) = M.block(k)(0, 0);
    return m;
}

/// Mass, centre and the six second moments about `about`, in units of the mass and the body's half extents.
Eigen::Matrix<double, 10, 1> moments_about(const Matrix& m, const std::vector<Vec3>& X, const Vec3& about,
                                           const Vec3& half) {
    Eigen::Matrix3Xd x(3, static_cast<Index>(X.size()));
    for (std::size_t i = 0; i < X.size(); ++i) x.col(static_cast<Index>(i)) = (X[i] - about).cwiseQuotient(half);
    const Vec3 first = x * m.rowwise().sum();
    const Mat3 S = x * m * x.transpose();
    Eigen::Matrix<double, 10, 1> all;
    all << m.sum(), first, S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(1, 2), S(2, 0);
    return all;
}

mesh::Mesh random_mesh(support::Random& random, int k) {
    const auto many = [&](int low, int high) { return static_cast<int>(random.uniform(low, high + 0.999)); };
    const auto size = [&] { return random.uniform(0.5, 3); };
    mesh::Mesh m;
    switch (k % 5) {
    case 0: m = mesh::make_block({0, 0, 0}, {size(), size(), size()}, {many(1, 6), many(1, 6), many(1, 6)}); break;
    case 1:
        m = mesh::make_block({0, 0, 0}, {size(), size(), size()}, {many(2, 5), many(2, 5), many(2, 5)},
                             mesh::CellType::tet4);
        break;
    case 2:
        m = mesh::make_block({0, 0, 0}, {size(), size(), size()}, {many(1, 3), many(1, 3), many(1, 3)},
                             mesh::CellType::tet10);
        break;
    case 3: m = mesh::make_ball(size(), {2 * many(1, 2), many(2, 3), 2 * many(1, 2)}); break;
    default: m = mesh::make_half_tube(1, size(), size(), {many(4, 8), many(2, 5), many(1, 4)}); break;
    }
    mesh::place(m, random.direction(), random.uniform(0, 3), random.vector(10), random.uniform(0.01, 10));
    return m;
}

/// A cap of the outer surface, all of it now and then.
std::vector<char> random_slaves(support::Random& random, const mesh::Mesh& m, int k) {
    std::vector<char> outer(m.nodes.size(), 0);
    for (const mesh::Facet& facet : mesh::exterior_facets(m))
        for (int c = 0; c < facet.count; ++c) outer[static_cast<std::size_t>(facet.nodes[c])] = 1;
    if (k % 7 == 6) return outer;
    const Vec3 d = random.direction();
    double low = 1e300, high = -1e300;
    for (const Vec3& X : m.nodes) {
        low = std::min(low, d.dot(X));
        high = std::max(high, d.dot(X));
    }
    const double from = low + random.uniform(0.5, 0.99) * (high - low);
    for (std::size_t i = 0; i < outer.size(); ++i)
        if (d.dot(m.nodes[i]) < from) outer[i] = 0;
    return outer;
}

TEST(MassRedistribution, KeepsMassCentreAndInertiaOfFiftyRandomBodies) {
    support::Random random(7);
    int moved = 0, kept = 0;
    for (int k = 0; k < 50; ++k) {
        const std::vector<Body> bodies = one(random_mesh(random, k));
        const mesh::Mesh& m = bodies[0].mesh;
        const Index n = m.node_count();
        const std::vector<char> slaves = random_slaves(random, m, k);
        Eigen::AlignedBox3d box;
        for (const Vec3& X : m.nodes) box.extend(X);
        for (const bool lumped : {false, true}) {
            const Matrix before = scalar(assemble_mass(bodies, n, lumped, {}).M);
            const AssembledMass found = assemble_mass(bodies, n, lumped, slaves);
            const Matrix after = scalar(found.M);
            if (!found.kept.empty()) {
                ++kept;
                EXPECT_EQ(found.kept, std::vector<Index>{0});
                EXPECT_EQ(after, before) << "all or nothing";
                continue;
            }
            ++moved;
            const auto from = moments_about(before, m.nodes, box.center(), 0.5 * box.sizes()),
                       to = moments_about(after, m.nodes, box.center(), 0.5 * box.sizes());
            EXPECT_LT((to - from).cwiseAbs().maxCoeff(), kept_to * from(0)) << "body " << k;
            for (Index i = 0; i < n; ++i) {
                if (slaves[static_cast<std::size_t>(i)] == 0) continue;
                EXPECT_TRUE(after.row(i).isZero(0) && after.col(i).isZero(0));
            }
            const double least =
                lumped ? after.diagonal().minCoeff()
                       : Eigen::SelfAdjointEigenSolver<Matrix>(after, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
            const double round_off = 1e-15 * static_cast<double>(n);
            EXPECT_GE(least, lumped ? 0 : -round_off * after.diagonal().maxCoeff()) << "body " << k;
        }
    }
    EXPECT_GE(moved, 50); // of 100
    EXPECT_GE(kept, 10);
}

std::vector<char> top_of(const mesh::Mesh& m) {
    std::vector<char> top;
    for (const Vec3& X : m.nodes) top.push_back(X.z() == 1 ? 1 : 0);
    return top;
}

/// Two points cannot have the centre and the inertia of three.
TEST(MassRedistribution, KeepsTheMassOfBodiesTooThinForIt) {
    for (const int layers : {1, 2, 3}) {
        const std::vector<Body> bodies = one(mesh::make_block({0, 0, 0}, {1, 1, 1}, {4, 4, layers}));
        const mesh::Mesh& m = bodies[0].mesh;
        EXPECT_EQ(assemble_mass(bodies, m.node_count(), false, top_of(m)).kept.size(), 1u) << layers;
        EXPECT_EQ(assemble_mass(bodies, m.node_count(), true, top_of(m)).kept.size(), 1u) << layers;
    }
    const std::vector<Body> thick = one(mesh::make_block({0, 0, 0}, {1, 1, 1}, {4, 4, 5}));
    EXPECT_TRUE(assemble_mass(thick, thick[0].mesh.node_count(), false, top_of(thick[0].mesh)).kept.empty());
}

TEST(MassRedistribution, LeavesBodiesWithoutSlavesAlone) {
    std::vector<Body> bodies = one(mesh::make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 5}));
    bodies.push_back(body_of(mesh::make_block({2, 0, 0}, {1, 1, 1}, {2, 2, 2})));
    bodies[1].first_node = bodies[0].nodes();
    const Index n = bodies[0].nodes() + bodies[1].nodes();
    std::vector<char> slaves = top_of(bodies[0].mesh);
    slaves.resize(static_cast<std::size_t>(n), 0);
    const Matrix before = scalar(assemble_mass(bodies, n, false, {}).M),
                 after = scalar(assemble_mass(bodies, n, false, slaves).M);
    EXPECT_EQ(after.bottomRows(bodies[1].nodes()), before.bottomRows(bodies[1].nodes()));
}

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
