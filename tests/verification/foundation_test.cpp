/// The paper's foundation on soil (Qian 2014, sec. 5.1), full size, on quadrilateral, triangular and hybrid masters.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::SceneRun;

const SceneRun& foundation(const std::string& mesh, const std::string& surface) {
    static std::map<std::string, SceneRun> runs; // full size: solved once for all claims
    const auto [entry, fresh] = runs.try_emplace(mesh + surface);
    if (fresh)
        support::run_scene(entry->second, support::shipped("paper/foundation_" + mesh + ".yaml"),
                           {{"contact.base.surface", surface}});
    return entry->second;
}

/// Nodal contact pressure along the line y = 0 of the interface, by x.
std::vector<double> centre_line(const SceneRun& run) {
    const model::ContactEvaluation& evaluation = run.contact[0];
    const model::ContactPair& pair = evaluation.pair();
    std::vector<std::pair<double, double>> line;
    for (Index j = 0; j < pair.size(); ++j) {
        const Vec3 X = run.plan.model.X[pair.slaves().node[j]];
        if (std::abs(X.y()) < 1e-9)
            line.emplace_back(X.x(), run.steps[0].state.contact[0].lambda[j].dot(evaluation.point(j).normal) /
                                         pair.slaves().area[j]);
    }
    std::sort(line.begin(), line.end());
    std::vector<double> pressure;
    for (const auto& [x, p] : line) pressure.push_back(p);
    return pressure;
}

/// Root mean square of the second differences over the mean, without the singular nodes at the foundation's edges.
double roughness(const std::vector<double>& p) {
    double squares = 0, sum = 0;
    int count = 0;
    for (std::size_t i = 2; i + 2 < p.size(); ++i, ++count) {
        squares += std::pow(p[i - 1] - 2 * p[i] + p[i + 1], 2);
        sum += p[i];
    }
    return std::sqrt(squares / count) / (sum / count);
}

class Foundation : public testing::TestWithParam<std::tuple<const char*, const char*>> {
protected:
    const SceneRun& run() const { return foundation(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(Foundation, ConvergesToRoundOffInFewIterations) {
    const SceneRun& r = run();
    ASSERT_EQ(r.attempts, 1);
    EXPECT_LE(r.steps[0].iterations, 12);
    EXPECT_LT(r.steps[0].records.back().residual, 1e-10);
}

TEST_P(Foundation, CarriesTheWholeLoad) {
    const support::PairForces& f = run().steps[0].pairs[0];
    const double load = 36e6; // 1 MPa on 6 m x 6 m
    EXPECT_NEAR(f.on_slave.z(), load, 1e-9 * load);
    EXPECT_NEAR(f.normal, load, 0.002 * load);           // the dish under the foundation tilts the normals a little
    EXPECT_LT(f.on_slave.head<2>().norm(), 1e-9 * load); // held sideways by friction alone
}

INSTANTIATE_TEST_SUITE_P(Masters, Foundation,
                         testing::Combine(testing::Values("quad", "tri", "hybrid"), testing::Values("facets", "rpim")));

TEST(FoundationPressure, IsSmootherOnTheSmoothMaster) {
    const double facets = roughness(centre_line(foundation("quad", "facets")));
    const double rpim = roughness(centre_line(foundation("quad", "rpim")));
    RecordProperty("roughness_facets", std::to_string(facets));
    RecordProperty("roughness_rpim", std::to_string(rpim));
    EXPECT_LT(rpim, 0.4 * facets);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
