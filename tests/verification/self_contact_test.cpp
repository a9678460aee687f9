/// A body that comes to lie on itself: general contact keeps it out of itself, and nothing else does.

#include "support/diary.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gmock/gmock.h>
#include <map>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::Diary;

/// A ring whose roof is pushed down onto its floor, and 30 mm farther.
const std::string ring = R"(
bodies:
  ring:
    mesh: {tube: {inner_radius: 0.9 m, thickness: 0.12 m, length: 0.2 m, divisions: [48, 1, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
sets:
  front: {body: ring, surface: z_max}
  back: {body: ring, surface: z_min}
  above: {body: ring, box: {min: [-0.1 m, 1 m, -1 m], max: [0.1 m, 2 m, 1 m]}}
  below: {body: ring, box: {min: [-0.1 m, -2 m, -1 m], max: [0.1 m, -1 m, 1 m]}}
supports:
  front: {fix: [z]}
  back: {fix: [z]}
  below: {fix: [x, y]}
  above: {fix: [x]}
stages:
  pinch: {steps: 20, displacement: {above: {y: -1.83 m}}}
)";
const std::string general = "contact: {general: {friction: 0.3}}\n";

struct Result {
    model::Model model;
    Diary diary;
};

Result run(const std::string& text, const std::vector<scene::Override>& changes = {}, int reject_every = 0,
           int threads = 1) {
    app::Plan plan = support::compiled(scene::read_scene(support::scene_file("self.yaml", text), changes), threads);
    Diary diary = support::diary_of(plan, reject_every);
    return {std::move(plan.model), std::move(diary)};
}

/// With general contact, by one thread and without rejections.
const Result& laid() {
    static const Result result = run(ring + general);
    return result;
}

/// The least height of nodes of the roof above the floor, by straight lines between its nodes, m.
double clearance(const Result& result) {
    const auto line = [&](double side) { // along the inside, in the plane z = 0
        std::map<double, double> points;
        for (std::size_t i = 0; i < result.model.X.size(); ++i) {
            const Vec3& X = result.model.X[i];
            if (std::abs(X.head<2>().norm() - 0.9) > 1e-9 || X.z() != 0 || side * X.y() < 0.4) continue;
            const Vec3 x = X + result.diary.states.back().u[i];
            points[x.x()] = x.y();
        }
        return points;
    };
    const std::map<double, double> roof = line(1), floor = line(-1);
    double least = 1;
    for (const auto& [x, y] : roof) {
        const auto next = floor.upper_bound(x);
        if (next == floor.begin() || next == floor.end()) continue;
        const auto last = std::prev(next);
        const double t = (x - last->first) / (next->first - last->first);
        least = std::min(least, y - (1 - t) * last->second - t * next->second);
    }
    return least;
}

TEST(SelfContact, LaysTheRoofOfARingOnItsFloor) {
    const Result& result = laid();
    constexpr double chord = 3e-3; // m: what averages over facets of 0.12 m leave between bulges
    EXPECT_NEAR(clearance(result), 0, chord);
    ASSERT_EQ(result.diary.states.back().contact.size(), 1u);
    const model::ContactHistory& own = result.diary.states.back().contact[0];
    EXPECT_EQ(own.pair->name(), "general: ring on itself");
    EXPECT_GE(std::ranges::count_if(own.status, contact::is_closed), 2);
}

TEST(SelfContact, IsWhatKeepsTheRoofAboveTheFloor) {
    const Result result = run(ring + "contact: {general: {pairs: {none: {between: [ring, ring], contact: false}}}}\n",
                              {{"solver.audit", "false"}});
    EXPECT_LT(clearance(result), -0.02);
}

TEST(SelfContact, RejectedAttemptsLeaveNoTraceAndThreadsNoDifference) {
    constexpr int every = 3, threads = 3;
    support::expect_same_bits(laid().diary, run(ring + general, {}, every, threads).diary);
}

/// A slice of two blocks, both as thick as the slice: their nodes lie on the other's edges.
const std::string slice = R"(
bodies:
  base:
    mesh: {block: {size: [4 m, 0.5 m, 0.3 m], divisions: [16, 2, 1]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
  cap:
    mesh: {block: {origin: [0.8 m, 0.5 m, 0 m], size: [1 m, 0.5 m, 0.3 m], divisions: [5, 2, 1]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: base, surface: y_min}
  ground: {body: base, surface: y_max}
  under: {body: cap, surface: y_min}
  top: {body: cap, surface: y_max}
  rear: {body: cap, surface: x_min}
  front: {body: cap, surface: z_max}
  back: {body: cap, surface: z_min}
supports:
  bed: {fix: [x, y, z]}
  front: {fix: [z]}
  back: {fix: [z]}
stages:
  press: {pressure: {top: 100 kPa}, displacement: {rear: {x: 0 m}}}
  pull: {steps: 3, displacement: {rear: {x: 0.3 m}}}
)";

TEST(GeneralContactOfSlices, IsThatOfPairsWrittenByHand) {
    const Result found = run(slice + general),
                 written = run(slice + "contact: {sliding: {slave: under, master: {set: ground}, friction: 0.3}}\n");
    ASSERT_EQ(found.diary.states.size(), written.diary.states.size());
    constexpr double same = 1e-3; // of the displacements: the filter counts areas beyond the edge of the ground
    for (std::size_t k = 0; k < found.diary.states.size(); ++k) {
        const Field &u = found.diary.states[k].u, &v = written.diary.states[k].u;
        EXPECT_LT(largest_distance(u, v).value, same * largest_component(v)) << k;
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
