/// Scenes say the same in other units, turned, mirrored, far away and numbered otherwise.
/// OSCULATE_FULL=1: all scenes, minutes. OSCULATE_INVARIANCE_PAGE=FILE: writes what was measured, see scripts/pages/invariance.

#include "support/invariance_cases.hpp"
#include "support/invariance_page.hpp"
#include "support/source_tree.hpp"
#include "support/trace.hpp"

#include <cstdlib>
#include <ctime>
#include <gtest/gtest.h>
#include <iostream>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// Of forces and displacements. The scenes' own tolerance is 1e-9 of a reference force, and Newton's last step goes far below.
constexpr double same = 1e-7;

std::vector<support::Transformation> transformations() {
    // no multiples of right angles, along no edge of any mesh
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Mat3 mirror = Vec3(-1, 1, 1).asDiagonal();
    return {{.name = "length 1e9", .length = 1e9},
            {.name = "length 1e-9", .length = 1e-9},
            {.name = "mass 1e9", .mass = 1e9},
            {.name = "mass 1e-9", .mass = 1e-9},
            {.name = "time 1e9", .time = 1e9},
            {.name = "time 1e-9", .time = 1e-9},
            {.name = "rotation", .turn = turn},
            {.name = "mirror", .turn = mirror},
            {.name = "translation", .sizes_away = 1e6},
            {.name = "numbering", .renumber = true},
            {.name = "body order", .reverse_bodies = true},
            {.name = "sides swapped", .swap_sides = true}};
}

class InvarianceOfScenes : public testing::TestWithParam<std::string> {
protected:
    static std::vector<support::InvarianceRow>& rows() {
        static std::vector<support::InvarianceRow> all;
        return all;
    }
};

TEST_P(InvarianceOfScenes, InUnitsPlaceAndNumbering) {
    const std::string& name = GetParam();
    const support::InvarianceCase how = support::invariance_case(name);
    scene::Scene scene = scene::read_scene(support::source_tree() + "/configs/" + name + ".yaml", how.overrides);
    scene.output.probes.clear(); // they stay where the scene puts them
    scene.output.plots.clear();
    const auto meshes = app::build_meshes(scene);
    const auto begin = std::clock();
    support::Trace reference;
    support::run_trace(reference, scene, meshes, how.most_steps);
    ASSERT_EQ(reference.failure, "");
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    std::cout << name << ": " << reference.steps.size() << " steps, " << seconds << " s\n";

    const support::NamedScene named = support::with_named_sets(scene, meshes, reference.plan);
    const auto known = support::known_differences().find(name);
    const bool excused = known != support::known_differences().end();
    support::InvarianceRow row{name, reference.steps.size(), {}};
    const char* only = std::getenv("OSCULATE_INVARIANCE_ONLY");
    for (const support::Transformation& by : transformations()) {
        if (only != nullptr && by.name.find(only) == std::string::npos) continue;
        SCOPED_TRACE(name + ", " + by.name);
        const bool moved = by.sizes_away > 0;
        const support::NamedScene here = moved ? support::as_held_at(named, by.sizes_away) : named;
        support::Trace rounded, other;
        if (moved) support::run_trace(rounded, here.scene, here.meshes, how.most_steps);
        std::vector<Index> number;
        const support::NamedScene there = support::transformed(here, by, number);
        support::run_trace(other, there.scene, there.meshes, how.most_steps);
        const support::Difference d = support::difference(moved ? rounded : reference, other, by, number);
        row.differences.emplace_back(by.name, d);
        std::cout << "  " << support::describe_difference(by.name, d) << std::endl;
        if (by.swap_sides) continue; // measured only
        if (excused && known->second.concerns(by.name)) continue;
        EXPECT_EQ(d.failure, "");
        EXPECT_TRUE(d.same_steps);
        EXPECT_LT(d.force, same);
        EXPECT_LT(d.nodal_force, same);
        if (!excused || !known->second.displacement_only) {
            EXPECT_LT(d.displacement, same);
        }
    }
    rows().push_back(row);
    if (const char* file = std::getenv("OSCULATE_INVARIANCE_PAGE")) support::write_invariance_page(file, rows(), same);
}

INSTANTIATE_TEST_SUITE_P(Scenes, InvarianceOfScenes, testing::ValuesIn(support::invariance_scenes()),
                         [](const testing::TestParamInfo<std::string>& scene) {
                             return std::regex_replace(scene.param, std::regex("[^a-z0-9]"), "_");
                         });

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
