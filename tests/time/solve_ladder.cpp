/// What the ladder of solves does between its solves, from the statuses that an Equilibrium has seen.

#include "osculate/time/solve_ladder.hpp"

#include "support/small_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

using contact::Status;
using solve::KinsolOutcome;
using ::testing::Contains;

/// Facets that nothing is above where their vertices come near a certain place.
class Trap final : public contact::MasterSurface {
public:
    struct Place {
        std::vector<Vec3> vertices; ///< empty: none
        double radius = 0;          ///< m
    };
    Trap(std::unique_ptr<contact::MasterSurface> facets, const Place& place)
        : facets_(std::move(facets)), place_(place) {}
    [[nodiscard]] std::span<const Index> patch_vertices(Index facet) const override {
        return facets_->patch_vertices(facet);
    }
    void evaluate(const Vec3& s, const contact::FacetHit& hit, const std::vector<Vec3>& x, contact::ContactPoint& point,
                  contact::ContactVariation* variation, const contact::Placement*) const override {
        facets_->evaluate(s, hit, x, point, variation);
        if (!place_.vertices.empty()) point.found = point.found && distance(x, place_.vertices) > place_.radius;
    }
    static double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
        double largest = 0;
        for (std::size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
        return largest;
    }

private:
    std::unique_ptr<contact::MasterSurface> facets_;
    const Place& place_;
};

/// A cap that nothing but contact holds, pressed down at one edge: with all nodes of its sole closed, those at the other end
/// are pulled.
class Ladder : public ::testing::Test {
protected:
    Ladder() {
        small.add_body("base", mesh::make_block({0, 0, 0}, {2, 2, 1}, {2, 2, 1}), {30e6, 0});
        small.add_body("cap", mesh::make_block({0.3, 0.4, 1}, {1, 1, 0.5}, {3, 3, 1}), {10e6, 0});
        small.add_pair("joint", {1, "z_min"}, {0, "z_max"}, 10e6, 0.3);
        small.fix(0, "z_min", "xyz");
        small.finish();
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(pair().surface().facets(), model.X);
        auto facets = std::make_unique<Trap>(contact::make_facets_surface(*surface), trap);
        model::MasterNodes nodes{surface->vertex_nodes()};
        model.pairs[0] =
            std::make_unique<const model::ContactPair>("joint", model.X, pair().slaves(), std::move(surface),
                                                       std::move(nodes), std::move(facets), pair().options());
        constraints = std::make_unique<linear::Constraints>(model.nodes(), small.constraints);
        // an LU factorisation tells at once that nothing holds the cap
        equilibrium = std::make_unique<equilibrium::Equilibrium>(model, model.pairs, *constraints, nullptr,
                                                                 equilibrium::TangentChoice{}, timings, 1);
        solver = std::make_unique<solve::KinsolSolver>(equilibrium->size(), timings);
        state = small.at_rest();
        load = {state.u, state.u, {}};
        const Vec3 edge(0, 0, -1e4); // N, on each node of the upper edge at x_max
        for (Index i = model.bodies[1].first_node; i < model.nodes(); ++i)
            if (model.X[i].x() > 1.29 && model.X[i].z() > 1.49) load.force[i] = edge;
        begin();
        start = equilibrium->unknowns(state.u, state.contact);
        ladder.reference_force = edge.norm();
        ladder.characteristic_length = 3;
        ladder.farthest = 3;
        all.assign(1, std::vector<Status>(static_cast<std::size_t>(pair().size()), Status::stick));
    }
    /// An attempt, with nothing remembered of the one before.
    void begin() { equilibrium->begin_attempt(state, load, 1); }
    [[nodiscard]] const model::ContactPair& pair() const { return *model.pairs[0]; }
    /// Where the master's vertices are with statuses as given, and the statuses that the solution calls for.
    std::pair<std::vector<Vec3>, equilibrium::Statuses> solved_with(const equilibrium::Statuses& statuses) {
        Vector z = start;
        EXPECT_TRUE(solve_trial(*equilibrium, *solver, z, statuses, ladder).converged());
        return {pair().vertices(sum(equilibrium->displacements(z), model.X)), equilibrium->natural_statuses()};
    }

    Timings timings;
    support::SmallModel small;
    model::Model& model = small.model;
    Trap::Place trap;
    std::unique_ptr<linear::Constraints> constraints;
    std::unique_ptr<equilibrium::Equilibrium> equilibrium;
    std::unique_ptr<solve::KinsolSolver> solver;
    model::State state;
    equilibrium::StepLoad load;
    Vector start;
    LadderOptions ladder;
    equilibrium::Statuses all; ///< closed
};

/// With the nodes released that are pulled, the cap loses the base, and the tangent is singular: every second of them closes
/// again, and Newton starts from where all of them were closed, not from where the base was lost.
TEST_F(Ladder, TakesBackHalfOfTheReleasedNodesAndStartsFromTheLastSolution) {
    const equilibrium::Statuses pressed = solved_with(all).second;
    equilibrium::Statuses half = pressed;
    int released = 0;
    for (std::size_t j = 0; j < half[0].size(); ++j)
        if (half[0][j] == Status::open && released++ % 2 == 0) half[0][j] = Status::stick;
    ASSERT_GT(released, 3);
    ASSERT_LT(released, pair().size() - 3) << "the others hold the cap but for the trap";
    trap.vertices = solved_with(pressed).first;
    trap.radius = 0.1 * Trap::distance(trap.vertices, solved_with(half).first);

    begin();
    Vector z = start;
    const LadderResult result = climb(
        *equilibrium, *solver, z, [&] { return start; }, all, true, ladder);
    EXPECT_STREQ(result.rung, "frozen statuses");
    EXPECT_THAT(equilibrium->recent_statuses(), Contains(pressed));
    EXPECT_THAT(equilibrium->recent_statuses(), Contains(half)) << "not half, or tried where the base was lost";
}

TEST_F(Ladder, TakesItsSecondRungFromTheStartWithoutPrediction) {
    load.force.reset(load.force.size());
    const Vec3 down(0, 0, -1e3); // N, on each node of the cap: it is pressed all over
    std::fill(load.force.begin() + model.bodies[1].first_node, load.force.end(), down);
    begin();
    Field predicted = state.u;
    const Vec3 ahead(0.05, 0, 0); // m
    for (Vec3& u : predicted) u += ahead;
    Field x = model.X;
    for (Vec3& X : x) X += ahead;
    trap = {pair().vertices(x), 0.5 * ahead.norm()};

    Vector z = equilibrium->unknowns(predicted, state.contact);
    const LadderResult result = climb(
        *equilibrium, *solver, z, [&] { return start; }, all, true, ladder);
    EXPECT_TRUE(result.converged());
    EXPECT_STREQ(result.rung, "semismooth Newton without predictor");
}

/// What is accepted at round-off is the iterate at which the residual was found to rest.
TEST_F(Ladder, EndsAtTheIterateThatRests) {
    ladder.tolerance = 1e-30; // which no residual can meet
    Vector z = start;
    const LadderResult result = solve_trial(*equilibrium, *solver, z, all, ladder);
    EXPECT_TRUE(result.converged());
    EXPECT_TRUE(equilibrium->rests());
    EXPECT_EQ(z, equilibrium->last_iterate());
}

/// Round-off is some last digits: what is off by more is no equilibrium, however small it is.
TEST_F(Ladder, HoldsWithinItsLastDigitsAlone) {
    constexpr double none = 1e-30; // tolerance
    ladder.tolerance = none;
    Vector z = start;
    ASSERT_TRUE(solve_trial(*equilibrium, *solver, z, all, ladder).converged());
    EXPECT_TRUE(equilibrium->holds(z, all, none));
    const Vector beside = (1 + 1e-10) * z;
    EXPECT_FALSE(equilibrium->holds(beside, all, none));
}

/// A cap that is pulled off meets nothing: it is told so, and no springs are left for the next attempt to lean on.
TEST_F(Ladder, TakesItsSpringsAwayFromABodyThatNothingHolds) {
    load.force.reset(load.force.size());
    const Vec3 up(0, 0, 1e3); // N, on each node of the cap
    std::fill(load.force.begin() + model.bodies[1].first_node, load.force.end(), up);
    begin();
    const std::vector<double> shares = model::volume_shares(model);
    ladder.stabilisation = {.share = [&]() -> const std::vector<double>& { return shares; },
                            .finest = 0.05,
                            .gap = [] { return 0.1; },
                            .farthest = 0.5};
    Vector z = start;
    const LadderResult result = climb(
        *equilibrium, *solver, z, [&] { return start; }, all, true, ladder);
    EXPECT_EQ(result.outcome, KinsolOutcome::singular);
    EXPECT_GT(result.stabilised_solves, 0);
    EXPECT_GE(result.adrift, model.bodies[1].first_node);
    EXPECT_FALSE(equilibrium->bodies().stabilised());
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
