/// What `osculate check` says a run will take, against what runs took.

#include "osculate/app/estimate.hpp"

#include "osculate/app/load.hpp"
#include "support/source_tree.hpp"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

struct Measured {
    std::string scene;
    double seconds = 0, bytes = 0;
};

/// docs/data/estimates.csv: one processor; nothing is measured here.
std::vector<Measured> measured() {
    std::ifstream file(support::source_tree() + "/docs/data/estimates.csv");
    std::vector<Measured> runs;
    std::string line;
    for (std::getline(file, line); std::getline(file, line);) {
        std::ranges::replace(line, ',', ' ');
        Measured run;
        std::istringstream(line) >> run.scene >> run.seconds >> run.bytes;
        runs.push_back(run);
    }
    return runs;
}

TEST(Estimate, IsWithinItsFactorOfShippedScenes) {
    const std::vector<Measured> runs = measured();
    ASSERT_GT(runs.size(), 50u);
    Timings unused;
    // friction of 1, slaves or inclusions far stiffer than their bodies, a pressure as large as the modulus, gears: GMRES gets
    // nowhere, and the tangent is factorised dozens of times. Many iterations in two steps. A plane on a plane without friction:
    // two iterations of the six that a first step is taken to need. A free mesh: each version of Gmsh makes another.
    const std::set<std::string> known{
        "configs/extreme/half_tube_mu_1.yaml",      "configs/extreme/stiff_slave_mortar.yaml",
        "configs/extreme/half_tube_10_mpa.yaml",    "configs/extreme/stiff_slave.yaml",
        "configs/extreme/stiff_inclusion.yaml",     "configs/tutorials/spur_gears.yaml",
        "configs/validation/cattaneo_mindlin.yaml", "configs/tutorials/press_fit.yaml",
        "configs/extreme/many_contact_nodes.yaml",  "configs/validation/hertz_sphere_free.yaml"};
    int far = 0;
    for (const Measured& run : runs) {
        if (known.contains(run.scene)) continue;
        const LoadedScene loaded = load(support::source_tree() + "/" + run.scene, {}, 1, unused);
        const Estimate found = estimate(loaded.scene, loaded.plan);
        const double seconds = found.seconds / run.seconds, bytes = found.bytes / run.bytes;
        EXPECT_LT(std::max(bytes, 1 / bytes), Estimate::factor)
            << run.scene << ": " << found.bytes << " of " << run.bytes;
        EXPECT_LT(std::max(seconds, 1 / seconds), Estimate::factor)
            << run.scene << ": " << found.seconds << " of " << run.seconds;
        far += std::max(seconds, 1 / seconds) > 2;
    }
    EXPECT_LT(far, static_cast<int>(runs.size()) / 3) << "more than twice or less than half";
}

TEST(Estimate, GrowsWithStepsAndElements) {
    const std::string press = support::source_tree() + "/tests/scenes/press.yaml";
    Timings unused;
    const auto of = [&](const std::vector<scene::Override>& changes) {
        const LoadedScene loaded = load(press, changes, 1, unused);
        return estimate(loaded.scene, loaded.plan);
    };
    const Estimate as_it_is = of({}), long_run = of({{"stages.pull.steps", "3000"}}),
                   fine = of({{"bodies.base.mesh.block.divisions", "[40, 40, 20]"}});
    EXPECT_EQ(as_it_is.steps, 4);
    EXPECT_GT(long_run.seconds, 10 * as_it_is.seconds);
    EXPECT_EQ(long_run.bytes, as_it_is.bytes);
    EXPECT_GT(fine.seconds, 3 * as_it_is.seconds);
    EXPECT_GT(fine.bytes, 3 * as_it_is.bytes);
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
