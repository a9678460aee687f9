/// Scenes say the same in other units, turned, mirrored, far away and numbered otherwise.
/// OSCULATE_FULL=1: all scenes, minutes. OSCULATE_INVARIANCE_PAGE=FILE: writes what was measured as a table.

#include "osculate/scene/reader.hpp"
#include "support/trace.hpp"

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace osculate {
namespace {

/// What is asked for, of forces and displacements.
constexpr double same = 1e-7;

bool full() {
    return std::getenv("OSCULATE_FULL") != nullptr;
}

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

struct Row {
    std::string scene, transformation;
    support::Difference d;
};
std::vector<Row>& rows() {
    static std::vector<Row> all;
    return all;
}

class InvarianceOfScenes : public testing::TestWithParam<std::string> {};

TEST_P(InvarianceOfScenes, InUnitsPlaceAndNumbering) {
    const std::string path = std::string(OSCULATE_SOURCE_DIR) + "/configs/" + GetParam() + ".yaml";
    std::vector<scene::Override> overrides;
    if (const char* tolerance = std::getenv("TOL")) overrides.push_back({"solver.tolerance", tolerance});
    const scene::Scene scene = scene::read_scene(path, overrides);
    const int most = std::getenv("MOST") ? std::atoi(std::getenv("MOST")) : 40;
    const auto meshes = app::build_meshes(scene);
    const auto clock0 = std::clock();
    support::Trace reference;
    support::run_trace(reference, scene, meshes, most);
    std::cout << GetParam() << " steps " << reference.steps.size() << " cpu "
              << static_cast<double>(std::clock() - clock0) / CLOCKS_PER_SEC << " " << reference.failure.substr(0, 100)
              << std::endl;
    if (reference.plan.model.sets.empty()) return;
    const support::NamedScene named = support::with_named_sets(scene, meshes, reference.plan);
    const char* only = std::getenv("ONLY");
    for (const auto& by : transformations()) {
        if (only && by.name.find(only) == std::string::npos) continue;
        std::vector<Index> number;
        support::Trace far_reference, other;
        const bool far = by.sizes_away > 0;
        const support::NamedScene base = far ? support::as_held_at(named, by.sizes_away) : named;
        if (far) support::run_trace(far_reference, base.scene, base.meshes, most);
        support::NamedScene there = support::transformed(base, by, number);
        support::run_trace(other, there.scene, there.meshes, most);
        const auto d = support::difference(far ? far_reference : reference, other, by, number);
        std::cout << std::left << "  " << std::setw(14) << by.name << std::right << std::setprecision(2)
                  << std::setw(10) << d.force << std::setw(10) << d.nodal_force << std::setw(10) << d.displacement
                  << (d.same_steps ? "  same " : "  OTHER STEPS ") << std::setw(4) << d.iterations << "  "
                  << d.failure.substr(0, 150) << std::endl;
        rows().push_back({GetParam(), by.name, d});
    }
}

std::vector<std::string> scenes() {
    std::vector<std::string> all;
    for (const char* folder : {"paper", "tutorials", "extreme"})
        for (const auto& entry : std::filesystem::directory_iterator(std::string(OSCULATE_SOURCE_DIR) + "/configs/" + folder))
            if (entry.path().extension() == ".yaml") all.push_back(folder + ("/" + entry.path().stem().string()));
    std::ranges::sort(all);
    return all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, InvarianceOfScenes, testing::ValuesIn(scenes()),
                         [](const auto& info) { return std::regex_replace(info.param, std::regex("[^a-z0-9]"), "_"); });

} // namespace
} // namespace osculate
