/// No number that is none is ever accepted: faults are planted where comparisons would let them pass.

#include "osculate/time/finite_check.hpp"

#include "osculate/core/error.hpp"
#include "osculate/time/post_mortem.hpp"
#include "osculate/time/stepper.hpp"
#include "support/floating_point_traps.hpp"
#include "support/small_run.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

/// The facets, but for the gap, or the normal, of what lies over them.
class FaultySurface final : public contact::MasterSurface {
public:
    FaultySurface(std::unique_ptr<contact::MasterSurface> sound, double gap, double normal)
        : sound_(std::move(sound)), gap_(gap), normal_(normal) {}
    [[nodiscard]] std::span<const Index> patch_vertices(Index facet) const override {
        return sound_->patch_vertices(facet);
    }
    void evaluate(const Vec3& s, const contact::FacetHit& hit, const std::vector<Vec3>& x, contact::ContactPoint& point,
                  contact::ContactVariation* variation, const contact::Placement*) const override {
        sound_->evaluate(s, hit, x, point, variation);
        point.gap += gap_;
        point.normal.x() += normal_;
    }

private:
    std::unique_ptr<contact::MasterSurface> sound_;
    double gap_, normal_;
};

/// A cube above a plate, moving down; nothing touches within the stage.
class Flight : public ::testing::Test, public StepObserver {
protected:
    void SetUp() override {
        small = std::make_unique<support::SmallModel>();
        const material::LinearElastic elastic{1e6, 0.3};
        small->add_body("plate", mesh::make_block({0, 0, -1}, {1, 1, 1}, {1, 1, 1}), elastic, 1000);
        small->add_body("cube", mesh::make_block({0.25, 0.25, 0.5}, {0.5, 0.5, 0.5}, {1, 1, 1}), elastic, 1000);
        small->add_pair("joint", {1, "z_min"}, {0, "z_max"}, elastic.E);
        small->fix(0, "z_min", "xyz");
        small->finish(true);
        for (Index i = 0; i < model().bodies[1].nodes(); ++i)
            small->model.initial_velocity[model().bodies[1].first_node + i] = -Vec3::UnitZ();
        stage = support::small_motion(*small, "fly", 0.1, 2, 0.8);
    }
    void plant(double gap, double normal) {
        const model::ContactPair& sound = *model().pairs[0];
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(sound.surface().facets(), model().X);
        auto master = std::make_unique<FaultySurface>(contact::make_facets_surface(*surface), gap, normal);
        model::MasterNodes nodes{surface->vertex_nodes()};
        small->model.pairs[0] =
            std::make_unique<const model::ContactPair>("joint", model().X, sound.slaves(), std::move(surface),
                                                       std::move(nodes), std::move(master), sound.options());
    }
    /// What the run failed by; empty: it did not.
    std::string run() {
        Stepper stepper(model(), {stage}, {}, timings);
        try {
            stepper.run(*this);
        } catch (const RunFailure& failure) {
            return failure.what();
        }
        return {};
    }
    void attempted(const Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const AcceptedStep& step) override {
        states.push_back(step.state);
        contact = step.equilibrium.contact();
        ledger = *step.ledger;
    }
    void gave_up(const PostMortem& post_mortem, const FailedIterate*) override { found = post_mortem; }

    [[nodiscard]] const model::Model& model() const { return small->model; }

    std::unique_ptr<support::SmallModel> small;
    Stage stage;
    Timings timings;
    std::vector<model::State> states;
    model::ContactEvaluations contact; ///< at the last of them
    Ledger ledger;
    PostMortem found;
};

TEST_F(Flight, WithoutFaultsIsAccepted) {
    plant(0, 0);
    EXPECT_EQ(run(), "");
    ASSERT_EQ(states.size(), 2u);
    EXPECT_FALSE(find_not_finite(contact, states.back(), &ledger));
}

TEST_F(Flight, IsGivenUpWhereTheGapOfAnOpenNodeIsNoNumber) {
    const support::FloatingPointTraps suspended(false); // numbers that are none are what it is about
    for (const auto& [gap, normal] : {std::pair{nan, 0.0}, std::pair{infinite, 0.0}, std::pair{0.0, nan}}) {
        SetUp();
        plant(gap, normal);
        const std::string failure = run();
        EXPECT_TRUE(states.empty()) << "accepted";
        EXPECT_THAT(failure, HasSubstr("not finite"));
        EXPECT_EQ(found.cause, Cause::not_finite);
        EXPECT_EQ(found.body, "cube");
        EXPECT_EQ(model().X[model().bodies[1].first_node + found.node].z(), 0.5) << "no node of its sole";
    }
}

TEST_F(Flight, IsGivenUpWhereAVelocityOverflowsThoughForcesBalance) {
    const support::FloatingPointTraps suspended(false); // numbers that are none are what it is about
    // velocities are made from the displacements afterwards, and nothing in these equations of motion needs them
    stage = support::small_motion(*small, "fly", 100, 1, 0.8);
    stage.weight = std::make_shared<const Field>(small->weight({0, 0, 10}));
    stage.limits.dt_min = stage.limits.dt_max;
    stage.dynamics->integrator = {.beta = 1, .gamma = std::numeric_limits<double>::max() / 2};
    const std::string failure = run();
    EXPECT_TRUE(states.empty()) << "accepted";
    EXPECT_EQ(found.cause, Cause::not_finite) << failure;
    EXPECT_THAT(failure, HasSubstr("velocity of node"));
    EXPECT_FALSE(found.body.empty());
}

TEST_F(Flight, EveryPartOfAStateIsLookedAt) {
    plant(0, 0);
    ASSERT_EQ(run(), "");
    const model::State sound = states.back();
    const Index node = model().bodies[1].first_node + 2, slave = 1;
    for (const double bad : {nan, infinite, -infinite}) {
        const auto expect = [&](const model::State& state, const Ledger& books, const std::string& what, Index where) {
            const auto flaw = find_not_finite(contact, state, &books);
            ASSERT_TRUE(flaw) << what;
            EXPECT_EQ(flaw->what, what);
            EXPECT_EQ(flaw->node, where);
            EXPECT_FALSE(std::isfinite(flaw->value));
        };
        for (const auto& [what, field] :
             {std::pair{"displacement", &model::State::u}, std::pair{"velocity", &model::State::v},
              std::pair{"acceleration", &model::State::a}}) {
            model::State state = sound;
            (state.*field)[node].y() = bad;
            expect(state, ledger, what, node);
        }
        model::State state = sound;
        state.contact[0].lambda[slave].z() = bad;
        expect(state, ledger, "contact force", model().pairs[0]->slaves().node[slave]);
        for (const auto& [what, term] :
             {std::pair{"energy.kinetic", &Ledger::kinetic}, std::pair{"energy.strain", &Ledger::strain},
              std::pair{"energy.external", &Ledger::external}, std::pair{"energy.friction", &Ledger::friction},
              std::pair{"energy.damping", &Ledger::damping}, std::pair{"energy.algorithmic", &Ledger::algorithmic},
              std::pair{"energy.contact", &Ledger::contact}, std::pair{"energy.balance", &Ledger::balance}}) {
            Ledger books = ledger;
            books.*term = bad;
            expect(sound, books, what, -1);
        }
        Ledger books = ledger;
        books.angular.x() = bad;
        expect(sound, books, "angular momentum", -1);
    }
}

TEST(NotFinite, IsExplainedByBodyNodeAndValue) {
    model::Model model;
    model.bodies.push_back({"cube", {}, 5, {}, {}, {}});
    model.bodies[0].mesh.nodes.resize(8);
    Attempt attempt;
    explain(NotFinite{"velocity", 7, infinite}, model, attempt);
    EXPECT_EQ(attempt.body, "cube");
    EXPECT_EQ(attempt.node, 2);
    EXPECT_THAT(attempt.cause, HasSubstr("velocity of node 2 of body 'cube' is inf"));
    explain(NotFinite{"energy.strain", -1, nan}, model, attempt);
    EXPECT_EQ(attempt.body, "");
    EXPECT_THAT(attempt.cause, HasSubstr("energy.strain is"));
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
