/// Slave nodes of a hole around a pin, after iterates in which the pin turned and came back.

#include "osculate/mesh/generators.hpp"
#include "osculate/model/contact_evaluation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

constexpr double clearance = 0.02; // of the pin's radius, 1 m

class PinInHole : public ::testing::TestWithParam<Discretisation> {
protected:
    PinInHole() {
        const mesh::Mesh pin = mesh::make_cylinder(1, 2, {6, 2, 8});
        x = pin.nodes;
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(pin.surfaces.at("outer"), x);
        std::vector<Vec3> vertices;
        for (const Index node : surface->vertex_nodes()) vertices.push_back(x[node]);
        constexpr int around = 30, along = 4;
        first = static_cast<Index>(x.size());
        SlaveNodes slaves;
        for (int k = 0; k <= along; ++k)
            for (int i = 0; i < around; ++i) {
                const double angle = 2 * std::numbers::pi * (i + 0.3) / around, r = 1 + clearance;
                slaves.node.push_back(static_cast<Index>(x.size()));
                x.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.5 + k * 0.25);
            }
        slaves.area.assign(slaves.node.size(), 0.05);
        slaves.stiffness.assign(slaves.node.size(), 1);
        for (int k = 0; k < along; ++k)
            for (int i = 0; i < around; ++i) { // facing the pin
                const Index a = first + k * around + i, b = first + k * around + (i + 1) % around;
                slaves.facets.push_back({{a, a + around, b + around, b}, 4});
            }
        contact::BlendOptions blend;
        auto shape = contact::make_blend_surface(*surface, vertices, blend);
        MasterNodes nodes{surface->vertex_nodes()};
        ContactOptions options;
        options.discretisation = GetParam();
        pair = std::make_unique<ContactPair>("eye", x, std::move(slaves), std::move(surface), std::move(nodes),
                                             std::move(shape), options);
        evaluation = std::make_unique<ContactEvaluation>(*pair);
        evaluation->begin_step(x, pair->initial_history(), timings, 1);
        evaluation->evaluate(x, timings, 1);
    }
    /// Positions with the pin turned about its axis.
    [[nodiscard]] std::vector<Vec3> turned(double degrees) const {
        std::vector<Vec3> now = x;
        const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, Vec3::UnitZ());
        for (Index i = 0; i < first; ++i) now[i] = turn * x[i];
        return now;
    }

    std::vector<Vec3> x;
    Index first = 0; ///< slave node
    std::unique_ptr<ContactPair> pair;
    std::unique_ptr<ContactEvaluation> evaluation;
    Timings timings;
};

/// A pin on which a load pulls before anything holds it. Nodes that were latched far from where they are had gaps of facets'
/// planes extended to them, of zero among others.
TEST_P(PinInHole, HasTheGapsOfTheFacetsBelowAgainWhenThePinIsBack) {
    std::vector<double> gaps;
    for (Index j = 0; j < pair->size(); ++j) {
        ASSERT_TRUE(evaluation->point(j).found);
        gaps.push_back(evaluation->point(j).gap);
        EXPECT_NEAR(gaps.back(), clearance, 0.1 * clearance) << "of the pin as the patches see it";
    }
    for (int k = 0; k < 7; ++k) evaluation->evaluate(turned(k % 2 == 0 ? 150 : 30), timings, 1);
    ASSERT_TRUE(evaluation->hit(0).latched);
    evaluation->evaluate(x, timings, 1);
    constexpr double round_off = 1e-12;
    for (Index j = 0; j < pair->size(); ++j) {
        ASSERT_TRUE(evaluation->point(j).found) << j;
        EXPECT_NEAR(evaluation->point(j).gap, gaps[static_cast<std::size_t>(j)], round_off) << j;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, PinInHole, ::testing::Values(Discretisation::node, Discretisation::petrov_galerkin),
                         [](const auto& one) { return one.param == Discretisation::node ? "Node" : "PetrovGalerkin"; });

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
