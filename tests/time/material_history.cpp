/// Elements with a past, in runs: what they remember is part of the state.

#include "osculate/core/error.hpp"
#include "support/small_run.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

/// Linear elements that soften for good with the largest strain they have had: with s = sqrt(u K u) and
/// kappa = max(kappa_start, s), forces are exp(-kappa / limit) K u. It carries kappa alone.
class Softening final : public fe::ElementKernel {
public:
    Softening(std::unique_ptr<fe::ElementKernel> elastic, double limit) : elastic_(std::move(elastic)), limit_(limit) {}

    [[nodiscard]] int nodes() const override { return elastic_->nodes(); }
    [[nodiscard]] bool linear() const override { return false; }
    [[nodiscard]] bool finite_strain() const override { return false; }
    [[nodiscard]] std::size_t history_size() const override { return 1; }
    void stiffness(const Eigen::Ref<const Eigen::Matrix3Xd>& X, Eigen::Ref<Matrix> Ke) const override {
        elastic_->stiffness(X, Ke);
    }
    fe::Deformation energy(const fe::ElementState& state, double& W) const override {
        (void)elastic_->energy(state, W);
        W *= left(state.history[0]);
        return {};
    }
    fe::Deformation update(const fe::ElementStep& step, std::span<double> history,
                           Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        const Matrix K = stiffness_of(step);
        const Vector u = step.u.reshaped();
        history[0] = std::max(step.history_start[0], std::sqrt(u.dot(K * u)));
        f.reshaped() = left(history[0]) * K * u;
        return {};
    }
    fe::Deformation tangent(const fe::ElementStep& step, Eigen::Ref<Matrix> Ke) const override {
        const Matrix K = stiffness_of(step);
        const Vector u = step.u.reshaped(), Ku = K * u;
        const double s = std::sqrt(u.dot(Ku));
        const bool grows = s > step.history_start[0];
        Ke = left(grows ? s : step.history_start[0]) * K;
        if (grows) Ke -= left(s) / (limit_ * s) * Ku * Ku.transpose();
        return {};
    }
    fe::Deformation nodal_stress(const fe::ElementState& state, Eigen::Ref<Matrix> stress) const override {
        (void)elastic_->nodal_stress(state, stress);
        stress *= left(state.history[0]);
        return {};
    }
    void body_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Vec3& b,
                    Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        elastic_->body_force(X, b, f);
    }
    void mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Matrix> Me) const override {
        elastic_->mass(X, rho, Me);
    }
    void heat(std::span<const double>, std::span<double>) const override {}
    void lumped_mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Vector> m) const override {
        elastic_->lumped_mass(X, rho, m);
    }
    [[nodiscard]] double volume(const Eigen::Ref<const Eigen::Matrix3Xd>& X) const override {
        return elastic_->volume(X);
    }

private:
    [[nodiscard]] double left(double kappa) const { return std::exp(-kappa / limit_); }
    [[nodiscard]] Matrix stiffness_of(const fe::ElementStep& step) const {
        Matrix K(3 * nodes(), 3 * nodes());
        elastic_->stiffness(step.X, K);
        return K;
    }
    std::unique_ptr<fe::ElementKernel> elastic_;
    double limit_;
};

/// Two bars side by side, 2 x 1 x 1 of eight cubes each that strain alike: an elastic one first, so that the other's
/// histories do not begin with its first element. Both are pulled to `far` and let go half the way back.
class PulledBar : public ::testing::Test {
protected:
    static constexpr double E = 1000, limit = 3, far = 0.02; // Pa, sqrt(N m), m
    PulledBar() {
        const material::LinearElastic elastic{E, 0};
        const auto bar = [](double y) { return mesh::make_block({0, y, 0}, {2, 1, 1}, {4, 2, 2}); };
        small.add_body("elastic", bar(2), elastic);
        small.add_body("softening", bar(0), [&](mesh::CellType type) {
            return std::make_unique<Softening>(fe::make_kernel(type, HexFormulation::full, elastic), limit);
        });
        for (const Index body : {0, 1}) {
            small.fix(body, "x_min", "xyz");
            small.fix(body, "x_max", "yz");
        }
        small.finish();
        for (const double target : {far, far / 2}) {
            stages.push_back(support::small_stage(small, target == far ? "pull" : "let go", 4));
            for (const Index body : {0, 1})
                for (const Index node : small.nodes(body, "x_max"))
                    stages.back().constraints.push_back({node, Vec3::UnitX(), target, true});
        }
    }
    using SmallModel = support::SmallModel;

    support::Record run(int reject_every = 0, const std::optional<Checkpoint>& from = {}) {
        StepperOptions options;
        options.reject_every = reject_every;
        Stepper stepper(small.model, stages, options, timings);
        if (from) stepper.resume(*from);
        support::Record record;
        record.keep_after = 3;
        stepper.run(record);
        return record;
    }
    /// Pull on the end of a bar, N.
    double pull(const support::Record::Step& step, Index body) const {
        double sum = 0;
        for (const Index node : small.nodes(body, "x_max")) sum += step.unbalanced[static_cast<std::size_t>(node)].x();
        return sum;
    }
    /// s of one element at an end displacement d: E (d/2)^2 over its volume of 1/8.
    static double measure(double d) { return std::sqrt(E * d * d / 4 / 8); }

    SmallModel small;
    std::vector<Stage> stages;
    Timings timings;
};

TEST_F(PulledBar, SoftensOnTheWayOutAndComesBackAlongTheStiffnessThatIsLeft) {
    const support::Record record = run();
    ASSERT_EQ(record.steps.size(), 8u);
    for (int k = 0; k < 8; ++k) {
        const double d = k < 4 ? far * (k + 1) / 4 : far * (1 - (k - 3) / 8.0);
        const double kappa = measure(k < 4 ? d : far), round_off = 1e-9;
        EXPECT_NEAR(pull(record.steps[static_cast<std::size_t>(k)], 0), E * d / 2, round_off * E) << k;
        EXPECT_NEAR(pull(record.steps[static_cast<std::size_t>(k)], 1), std::exp(-kappa / limit) * E * d / 2,
                    round_off * E)
            << k;
    }
}

TEST_F(PulledBar, GivesEveryElementItsOwnHistory) {
    // at rest an element remembers what it remembered
    model::MaterialHistory history(16);
    for (std::size_t e = 0; e < history.size(); ++e) history[e] = 0.1 * static_cast<double>(e + 1);
    const Field at_rest(small.model.X.size());
    EXPECT_EQ(small.model.nonlinear->history(small.model.X, {at_rest, at_rest, history}, 1), history);
}

TEST_F(PulledBar, CarriesOneNumberAnElementInItsState) {
    const support::Record record = run();
    const model::MaterialHistory& carried = record.steps.back().state.material;
    ASSERT_EQ(carried.size(), 16u) << "the softening bar's elements alone";
    for (const double kappa : carried) EXPECT_NEAR(kappa, measure(far), 1e-12);
}

TEST_F(PulledBar, HasTheStressAndTheEnergyThatAreLeft) {
    const model::State state = run().steps.back().state;
    const double strain = far / 4, left = std::exp(-measure(far) / limit), round_off = 1e-9;
    for (const Index body : {0, 1}) {
        const auto stress = model::nodal_stress(small.model, body, state);
        for (Index i = 0; i < stress.rows(); ++i)
            EXPECT_NEAR(stress(i, 0), (body == 0 ? 1 : left) * E * strain, round_off * E);
    }
    EXPECT_NEAR(model::strain_energy(small.model, state.u, state.material, 1), (1 + left) * E * strain * strain,
                round_off * E);
}

TEST_F(PulledBar, IsNotSoftenedByStepsThatAreRejected) {
    const support::Record smooth = run(), rejected = run(2);
    ASSERT_EQ(smooth.steps.size(), rejected.steps.size());
    for (std::size_t k = 0; k < smooth.steps.size(); ++k) {
        EXPECT_EQ(smooth.steps[k].state.u, rejected.steps[k].state.u) << k;
        EXPECT_EQ(smooth.steps[k].state.material, rejected.steps[k].state.material) << k;
    }
}

TEST_F(PulledBar, GoesOnFromACheckpointWithWhatItRemembers) {
    const support::Record whole = run();
    ASSERT_TRUE(whole.kept);
    ASSERT_FALSE(whole.kept->state.material.empty());
    const support::Record rest = run(0, whole.kept);
    ASSERT_EQ(rest.steps.size() + 3, whole.steps.size());
    EXPECT_EQ(rest.steps.back().state.u, whole.steps.back().state.u);
    EXPECT_EQ(rest.steps.back().state.material, whole.steps.back().state.material);
}

TEST_F(PulledBar, RefusesACheckpointThatRemembersNothing) {
    Checkpoint checkpoint = *run().kept;
    checkpoint.state.material.clear();
    EXPECT_THROW(run(0, checkpoint), RunFailure);
}

TEST_F(PulledBar, NeedsFewIterationsWithTheTangentOfItsForces) {
    for (const support::Record::Step& step : run().steps) EXPECT_LE(step.iterations, 6);
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
