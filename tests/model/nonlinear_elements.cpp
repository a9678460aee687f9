/// Sums over the elements of models, at small and at finite strain.

#include "osculate/mesh/generators.hpp"
#include "osculate/model/model.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

const material::LinearElastic hooke{1.0, 0.3}; // forces of order one

/// A body of hexahedra and wedges, each in its block.
Body hybrid_block(Index first_node, const Vec3& origin, const std::array<int, 3>& divisions, bool linear) {
    Body body{
        "block",    mesh::make_block(origin, {1, 1, 1}, divisions, mesh::CellType::hex8, mesh::BlockPattern::hybrid),
        first_node, {},
        {},         {}};
    for (const mesh::ElementBlock& block : body.mesh.blocks)
        body.kernels.push_back(linear ? fe::make_kernel(block.type, HexFormulation::full, hooke)
                                      : fe::make_kernel(block.type, HexFormulation::full, material::NeoHookean(hooke)));
    return body;
}

Model model_of(std::vector<Body> bodies) {
    Model model;
    model.bodies = std::move(bodies);
    for (const Body& body : model.bodies)
        model.X.values().insert(model.X.values().end(), body.mesh.nodes.begin(), body.mesh.nodes.end());
    model.K = assemble_stiffness(model.bodies, neighbours(model.bodies, model.nodes()));
    model.nonlinear = std::make_unique<NonlinearElements>(model.bodies, model.K);
    return model;
}

/// Hundreds of elements a block: several batches. One linear body behind another at finite strain.
struct TwoKinds : ::testing::Test {
    const Model model = [] {
        std::vector<Body> bodies;
        bodies.push_back(hybrid_block(0, Vec3::Zero(), {9, 9, 9}, false));
        bodies.push_back(hybrid_block(bodies[0].nodes(), {2, 0, 0}, {2, 2, 2}, true));
        return model_of(std::move(bodies));
    }();
    Random random{61};
    const MaterialHistory nothing;
    const Field u = scattered(), way = scattered();
    const double step = 1e-4; // differences: round-off 1e-15 / step, step^2 over the strain

    Field scattered() {
        std::vector<Vec3> result;
        for (Index i = 0; i < model.nodes(); ++i) result.push_back(random.vector(0.01));
        return result;
    }
    [[nodiscard]] Field along(double t) const { return weighted(1, u, t, way); }
    [[nodiscard]] Field forces(const Field& at, int threads) const {
        return internal_force(model, {at, at, nothing}, threads);
    }
};

TEST_F(TwoKinds, ForcesAreTheDerivativeOfTheEnergy) {
    ASSERT_GT(model.bodies[0].mesh.blocks[0].size(), 256) << "one batch only";
    const double slope =
        (strain_energy(model, along(step), nothing, 1) - strain_energy(model, along(-step), nothing, 1)) / (2 * step);
    const double work = dot(forces(u, 1), way);
    EXPECT_NEAR(slope, work, 1e-6 * std::abs(work));
}

TEST_F(TwoKinds, TangentIsTheDerivativeOfTheForces) {
    linear::BlockMatrix K = model.K;
    model.nonlinear->add_tangent(model.X, {u, u, nothing}, K, 2);
    Field change(u.size());
    K.multiply_add(way, change, 1);
    const Field ahead = forces(along(step), 1), behind = forces(along(-step), 2);
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        worst = std::max(worst, ((ahead[i] - behind[i]) / (2 * step) - change[i]).norm());
        largest = std::max(largest, change[i].norm());
    }
    EXPECT_LT(worst, 1e-6 * largest);
}

TEST(FiniteStrainModel, NamesTheWorstElementByItsNumberInItsBody) {
    std::vector<Body> bodies;
    bodies.push_back(hybrid_block(0, Vec3::Zero(), {2, 2, 1}, false));
    bodies.push_back(hybrid_block(bodies[0].nodes(), {2, 0, 0}, {3, 3, 1}, false));
    const Model model = model_of(std::move(bodies));
    const Body& body = model.bodies[1];
    ASSERT_EQ(body.mesh.blocks.size(), 2u);
    const Index first = body.mesh.blocks[0].size();
    const auto& wedges = body.mesh.blocks[1];
    for (Index e = 0; e < wedges.size(); ++e) {
        // shear leaves volumes alone; one of the element's nodes is pushed through its opposite face
        Field u(model.X.size()), f(u);
        Vec3 centre = Vec3::Zero();
        for (Index i = 0; i < 6; ++i) centre += body.mesh.nodes[wedges.connectivity[6 * e + i]] / 6;
        for (Index i = 0; i < 6; ++i) { // turned inside out as a whole: neighbours suffer less
            const Index local = wedges.connectivity[6 * e + i];
            u[body.first_node + local] = -1.5 * (body.mesh.nodes[local] - centre);
        }
        const WorstElement worst = model.nonlinear->add_force(model.X, {u, u, MaterialHistory{}}, f, 1);
        EXPECT_FALSE(worst.admissible());
        EXPECT_EQ(worst.body, 1);
        double least = 1; // as the kernel has it, element by element
        Index expected = -1, number = 0;
        for (std::size_t b = 0; b < body.mesh.blocks.size(); ++b) {
            const auto& block = body.mesh.blocks[b];
            const int n = body.kernels[b]->nodes();
            for (Index k = 0; k < block.size(); ++k, ++number) {
                Eigen::Matrix3Xd X(3, n), ue(3, n), fe(3, n);
                for (int i = 0; i < n; ++i) {
                    X.col(i) = body.mesh.nodes[block.connectivity[n * k + i]];
                    ue.col(i) = u[body.first_node + block.connectivity[n * k + i]];
                }
                const double J = body.kernels[b]->internal_force({X, ue}, fe).smallest_J;
                if (J < least) least = J, expected = number;
            }
        }
        EXPECT_EQ(worst.element, expected);
        EXPECT_EQ(worst.J, least);
        EXPECT_GE(expected, first) << "in the first block: nothing shown";
    }
}

/// Two bricks of unlike height under unlike stretch: where they meet, the larger one counts for more.
TEST(NodalStress, IsTheMeanOverTheElementsByTheirVolume) {
    const double low = 1, high = 3;
    Model model;
    Body& body = model.bodies.emplace_back();
    body = Body{"pile", mesh::make_block(Vec3::Zero(), {1, 1, 2}, {1, 1, 2}), 0, {}, {}, {}};
    State state;
    for (Vec3& X : body.mesh.nodes) {
        if (X.z() == 2) X.z() = low + high;
        state.u.values().emplace_back(0, 0, X.z() <= low ? 0.01 * X.z() : 0.01 * low + 0.05 * (X.z() - low));
    }
    body.kernels.push_back(fe::make_kernel(mesh::CellType::hex8, HexFormulation::full, hooke));
    const auto stress = nodal_stress(model, 0, state);
    const double modulus = hooke.lambda() + 2 * hooke.mu(), round_off = 1e-14;
    for (Index i = 0; i < body.nodes(); ++i) {
        const double z = body.mesh.nodes[i].z();
        const double strain = z == 0 ? 0.01 : z == low ? (low * 0.01 + high * 0.05) / (low + high) : 0.05;
        EXPECT_NEAR(stress(i, 2), modulus * strain, round_off) << z;
        EXPECT_NEAR(stress(i, 0), hooke.lambda() * strain, round_off) << z;
    }
}

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
