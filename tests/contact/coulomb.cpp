#include "osculate/contact/coulomb.hpp"

#include "support/differences.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using osculate::support::central_differences;
using osculate::support::Random;
using osculate::support::relative_difference;

constexpr double mu = 0.3, c = 2.5;
constexpr double round_off = 1e-14; // of a dozen products of order one
// Round-off 1e-15 / 2e-6 and curvature (2e-6)^2, the latter times up to 1e3 where L_T is short and its direction turns fast.
constexpr double difference_step = 2e-6, difference_tolerance = 1e-8;
constexpr double shortest_slip_force = 0.2;
const Coulomb law(mu, c);

std::vector<ContactState> random_states() {
    Random random(11);
    std::vector<ContactState> states;
    while (states.size() < 200) {
        ContactState s;
        s.normal = random.direction();
        s.lambda = random.vector(2);
        s.gap = random.uniform();
        s.drift = random.vector();
        states.push_back(s);
    }
    return states;
}

struct Augmented {
    double L_N;
    Vec3 L_T;
};
Augmented augmented(const ContactState& s) {
    const Mat3 T = Mat3::Identity() - s.normal * s.normal.transpose();
    return {s.lambda.dot(s.normal) - c * s.gap, T * (s.lambda - c * s.drift)};
}

TEST(Coulomb, NamesTheBranchOfEveryState) {
    int count[4] = {0, 0, 0, 0};
    for (const ContactState& s : random_states()) {
        const auto [L_N, L_T] = augmented(s);
        const Status expected = L_N <= 0 ? Status::open : L_T.norm() <= mu * L_N ? Status::stick : Status::slip;
        EXPECT_EQ(law.status(s), expected);
        EXPECT_EQ(Coulomb(0, c).status(s), L_N <= 0 ? Status::open : Status::glide);
        ++count[static_cast<int>(expected)];
    }
    EXPECT_GT(count[static_cast<int>(Status::open)], 0);
    EXPECT_GT(count[static_cast<int>(Status::stick)], 0);
    EXPECT_GT(count[static_cast<int>(Status::slip)], 0);
}

TEST(Coulomb, HasTheResidualOfEachBranch) {
    for (const ContactState& s : random_states()) {
        const auto [L_N, L_T] = augmented(s);
        const Vec3& n = s.normal;
        EXPECT_LT((law.residual(s, Status::open).value - s.lambda).norm(), round_off);
        EXPECT_LT((law.residual(s, Status::stick).value - (s.lambda - L_N * n - L_T)).norm(), round_off);
        EXPECT_LT((law.residual(s, Status::glide).value - (s.lambda - L_N * n)).norm(), round_off);
        const Vec3 slip = s.lambda - L_N * n - mu * L_N * L_T.normalized();
        EXPECT_LT((law.residual(s, Status::slip).value - slip).norm(), round_off);
    }
}

/// Of slave nodes that are held: a spring of stiffness k from the force at the start of the step.
constexpr double k = 40;
const Vec3 lambda_start(0.2, -0.1, 0.3);
const Coulomb elastic = Coulomb::elastic(mu, c, k, lambda_start);

Vec3 trial_of_spring(const ContactState& s) {
    const Vec3 v = lambda_start - k * s.drift;
    return v - s.normal * s.normal.dot(v);
}

TEST(ElasticCoulomb, SticksByASpringFromTheForceAtTheStart) {
    int sticking = 0;
    for (ContactState s : random_states()) {
        if (s.drift.x() > 0) s.drift *= 0.01; // else all that are closed would slip
        const double L_N = s.lambda.dot(s.normal) - c * s.gap;
        const Vec3 L_T = trial_of_spring(s);
        const Status expected = L_N <= 0 ? Status::open : L_T.norm() <= mu * L_N ? Status::stick : Status::slip;
        EXPECT_EQ(elastic.status(s), expected);
        EXPECT_LT((elastic.residual(s, Status::stick).value - (s.lambda - L_N * s.normal - L_T)).norm(), k * round_off);
        const Vec3 slip = s.lambda - L_N * s.normal - mu * L_N * L_T.normalized();
        EXPECT_LT((elastic.residual(s, Status::slip).value - slip).norm(), k * round_off);
        sticking += expected == Status::stick;
    }
    EXPECT_GT(sticking, 5);
}

class Branch : public ::testing::TestWithParam<Status> {
protected:
    static void expect_exact_derivatives(const Coulomb& tested, const auto& tangential_force);
};

void Branch::expect_exact_derivatives(const Coulomb& tested, const auto& tangential_force) {
    for (ContactState s : random_states()) {
        if (GetParam() == Status::slip && tangential_force(s).norm() < shortest_slip_force) continue;
        const ContactResidual R = tested.residual(s, GetParam());
        Vector y(10); // lambda, gap, normal (a free vector), drift
        y << s.lambda, s.gap, s.normal, s.drift;
        const Matrix J = central_differences(
            [&](const Vector& at) -> Vector {
                const ContactState moved{at.head<3>(), at(3), at.segment<3>(4), at.tail<3>()};
                return tested.residual(moved, GetParam()).value;
            },
            y, difference_step);
        EXPECT_LT(relative_difference(R.by_lambda, J.leftCols<3>()), difference_tolerance);
        EXPECT_LT(relative_difference(R.by_gap, J.col(3)), difference_tolerance);
        EXPECT_LT(relative_difference(R.by_normal, J.middleCols<3>(4)), difference_tolerance);
        EXPECT_LT(relative_difference(R.by_drift, J.rightCols<3>()), difference_tolerance);
    }
}

TEST_P(Branch, HasExactDerivatives) {
    expect_exact_derivatives(law, [](const ContactState& s) { return augmented(s).L_T; });
}

TEST_P(Branch, HasExactDerivativesWhereStickIsElastic) {
    expect_exact_derivatives(elastic, trial_of_spring);
}

TEST_P(Branch, HasExactDerivativesWhereItYields) {
    Coulomb yielding = elastic;
    yielding.yield(0.2);
    expect_exact_derivatives(yielding, trial_of_spring);
}

TEST_P(Branch, HasExactDerivativesWhereSlidingMeetsMore) {
    Coulomb resisting = law;
    resisting.resist(0.7);
    expect_exact_derivatives(resisting, [](const ContactState& s) { return augmented(s).L_T; });
}

TEST(ResistingCoulomb, HasThatForceBesideFrictionAndNoneWhereItSticks) {
    // solutions: lambda_T = -(mu p + drag |d|) d/|d| in slip, d = 0 in stick
    Coulomb resisting(mu, c);
    const double drag = 0.7, p = 1.5;
    resisting.resist(drag);
    for (ContactState s : random_states()) {
        const Vec3 n = s.normal, along = (s.drift - n * n.dot(s.drift)).normalized();
        s.gap = 0;
        s.drift = 0.3 * along;
        s.lambda = p * n - (mu * p + drag * 0.3) * along;
        EXPECT_EQ(resisting.status(s), Status::slip);
        EXPECT_LT(resisting.residual(s, Status::slip).value.norm(), 10 * round_off);
        s.gap = 1;
        s.lambda = -drag * 0.3 * along;
        EXPECT_EQ(resisting.status(s), Status::open);
        EXPECT_LT(resisting.residual(s, Status::open).value.norm(), 10 * round_off);
        s.gap = 0;
        s.drift.setZero();
        s.lambda = p * n + 0.5 * mu * p * along;
        EXPECT_EQ(resisting.status(s), Status::stick);
        EXPECT_LT(resisting.residual(s, Status::stick).value.norm(), 10 * round_off);
    }
}

TEST(YieldingCoulomb, HasTheGapThatItsForceOpens) {
    Coulomb yielding(mu, c);
    yielding.yield(0.2);
    EXPECT_DOUBLE_EQ(yielding.normal_compliance(), 0.2 / c);
    for (ContactState s : random_states()) {
        ContactState yielded = s;
        yielded.gap += yielding.normal_compliance() * s.lambda.dot(s.normal);
        EXPECT_EQ(yielding.status(s), law.status(yielded));
        for (const Status status : {Status::open, Status::stick, Status::slip, Status::glide})
            EXPECT_LT((yielding.residual(s, status).value - law.residual(yielded, status).value).norm(), 4 * round_off);
    }
}

std::string branch_name(const ::testing::TestParamInfo<Status>& tested) {
    const char* names[] = {"Open", "Stick", "Slip", "Glide"};
    return names[static_cast<int>(tested.param)];
}

INSTANTIATE_TEST_SUITE_P(Of, Branch, ::testing::Values(Status::open, Status::stick, Status::slip, Status::glide),
                         branch_name);

/// A state by its normal and tangential parts: tangential force at `angle` to the drift's opposite.
struct Grid {
    double p_N, gap, p_T, slip, angle;
};

std::vector<Grid> grid() {
    std::vector<Grid> all;
    for (const double p_N : {-1.0, 0.0, 1.0})
        for (const double gap : {-0.5, 0.0, 0.5})
            for (const double p_T : {0.0, 0.5 * mu, mu, 1.5 * mu})
                for (const double slip : {0.0, 0.2})
                    for (const double angle : {0.0, 1.0, 3.141592653589793})
                        all.push_back({p_N, gap, p_T, slip, angle});
    return all;
}

/// p_N >= 0, g >= 0, p_N g = 0; |p_T| <= mu p_N; slip only where p_T is at its bound, and against it.
bool obeys_coulomb(const Grid& s) {
    if (s.p_N < 0 || s.gap < 0 || (s.p_N > 0 && s.gap > 0)) return false;
    if (s.p_N == 0) return s.p_T == 0; // whatever the slip
    if (s.p_T > mu * s.p_N) return false;
    return s.slip == 0 || (s.p_T == mu * s.p_N && s.angle == 0);
}

bool solves(const Grid& g, double friction, double complementarity) {
    const Vec3 n = Vec3(2, -1, 2) / 3, t1 = Vec3(1, 2, 0).normalized(), t2 = n.cross(t1);
    const Vec3 direction = std::cos(g.angle) * t1 + std::sin(g.angle) * t2;
    const ContactState s{g.p_N * n + g.p_T * direction, g.gap, n, 0.7 * n - g.slip * t1}; // normal drift is no slip
    const Coulomb tested(friction, complementarity);
    const double solved = 1e-12;  // round-off; the smallest violation of the grid leaves far more,
    const double violated = 1e-5; // even with the smallest c
    const double R = tested.residual(s, tested.status(s)).value.norm();
    EXPECT_TRUE(R < solved || R > violated) << R;
    return R < solved;
}

TEST(Coulomb, IsSolvedExactlyByTheContactConditionsWhateverC) {
    int solutions = 0;
    for (const Grid& s : grid())
        for (const double complementarity : {1e-3, 0.1, 1.0, 40.0, 1e3}) {
            EXPECT_EQ(solves(s, mu, complementarity), obeys_coulomb(s))
                << "p_N " << s.p_N << " g " << s.gap << " p_T " << s.p_T << " slip " << s.slip << " angle " << s.angle
                << " c " << complementarity;
            solutions += obeys_coulomb(s);
        }
    EXPECT_GT(solutions, 0);
}

TEST(Coulomb, IsSolvedWithoutFrictionByAPressureOrAGapAlone) {
    for (const Grid& s : grid())
        for (const double complementarity : {1e-3, 1.0, 1e3})
            EXPECT_EQ(solves(s, 0, complementarity),
                      s.p_N >= 0 && s.gap >= 0 && !(s.p_N > 0 && s.gap > 0) && s.p_T == 0);
}

double jump(const Coulomb& tested, const ContactState& a, const ContactState& b) {
    EXPECT_NE(tested.status(a), tested.status(b)) << "the states are on one side of the border";
    return (tested.residual(a, tested.status(a)).value - tested.residual(b, tested.status(b)).value).norm();
}

/// Residuals are Lipschitz with a constant of order one, so a jump is one that does not shrink with the distance.
constexpr double distance = 1e-8, largest_jump = 10 * distance;

TEST(Coulomb, IsContinuousWhereContactOpens) {
    const Vec3 n = Vec3(2, -1, 2) / 3, t = Vec3(1, 2, 0).normalized();
    for (const double gap : {-0.4, 0.0, 0.3})
        for (const double p_T : {0.0, 0.5}) { // with and without a tangential force left over
            const auto at = [&](double L_N) {
                return ContactState{(L_N + c * gap) * n + p_T * t, gap, n, 0.1 * n.cross(t)};
            };
            EXPECT_LT(jump(law, at(distance), at(-distance)), largest_jump);
            EXPECT_LT(jump(Coulomb(0, c), at(distance), at(-distance)), largest_jump);
        }
}

TEST(Coulomb, IsContinuousWhereStickTurnsToSlip) {
    const Vec3 n = Vec3(2, -1, 2) / 3, t = Vec3(1, 2, 0).normalized();
    const double L_N = 0.8;
    for (const double slip : {-0.2, 0.0, 0.2}) {
        const auto at = [&](double L_T) {
            return ContactState{(L_N + c * 0.1) * n + (L_T + c * slip) * t, 0.1, n, slip * t};
        };
        EXPECT_LT(jump(law, at(mu * L_N + distance), at(mu * L_N - distance)), largest_jump);
    }
}

TEST(Coulomb, LeavesNoFrictionWithoutADirectionToSlipIn) {
    const ContactState s{2 * Vec3::UnitZ(), 0, Vec3::UnitZ(), Vec3::Zero()};
    const ContactResidual R = law.residual(s, Status::slip);
    EXPECT_TRUE(R.value.allFinite());
    EXPECT_TRUE(R.by_lambda.allFinite());
    EXPECT_LT((R.value - law.residual(s, Status::glide).value).norm(), round_off);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
