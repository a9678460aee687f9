#pragma once
/// What a run has done, step by step, to be compared with another to the last bit; and scenes worth comparing.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <span>

namespace osculate::support {

struct Diary final : time::StepObserver {
    std::vector<time::Attempt> attempts;
    std::vector<model::State> states;
    std::vector<time::Ledger> ledgers; ///< of dynamic steps
    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>&) override {
        attempts.push_back(attempt);
    }
    void accepted(const time::AcceptedStep& step) override {
        states.push_back(step.state);
        if (step.ledger != nullptr) ledgers.push_back(*step.ledger);
    }
    [[nodiscard]] int count(time::Reason reason) const {
        return static_cast<int>(std::count_if(attempts.begin(), attempts.end(), [&](const time::Attempt& a) {
            return a.verdict == time::Verdict::retry && a.reason == reason;
        }));
    }
};

/// Runs a plan to its end.
/// @param reject_every  the step controller rejects every so many attempts; 0: none
inline Diary diary_of(app::Plan& plan, int reject_every = 0) {
    Timings timings;
    plan.stepper.reject_every = reject_every;
    Diary diary;
    time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    stepper.run(diary);
    return diary;
}

inline app::Plan compiled(const scene::Scene& scene, int threads = 1) {
    Timings timings;
    return app::compile(scene, app::build_meshes(scene), threads, timings);
}

/// @param b  begins later: every step of it is compared with the last ones of a
inline void expect_same_end(const Diary& a, const Diary& b) {
    ASSERT_GT(b.states.size(), 0U);
    ASSERT_GE(a.states.size(), b.states.size());
    const std::size_t before = a.states.size() - b.states.size();
    for (std::size_t k = 0; k < b.states.size(); ++k) {
        const model::State &x = a.states[before + k], &y = b.states[k];
        ASSERT_EQ(x.time, y.time);
        ASSERT_EQ(x.u, y.u) << "step " << k;
        ASSERT_EQ(x.v, y.v) << "step " << k;
        ASSERT_EQ(x.a, y.a) << "step " << k;
        ASSERT_EQ(x.contact.size(), y.contact.size()) << "step " << k;
        for (std::size_t p = 0; p < x.contact.size(); ++p) {
            ASSERT_EQ(x.contact[p].pair->slaves().node, y.contact[p].pair->slaves().node) << "step " << k;
            ASSERT_EQ(x.contact[p].lambda, y.contact[p].lambda) << "step " << k;
            ASSERT_EQ(x.contact[p].status, y.contact[p].status) << "step " << k;
            ASSERT_EQ(x.contact[p].facet, y.contact[p].facet) << "step " << k;
        }
    }
    ASSERT_GE(a.ledgers.size(), b.ledgers.size());
    const std::size_t earlier = a.ledgers.size() - b.ledgers.size();
    for (std::size_t k = 0; k < b.ledgers.size(); ++k) {
        const time::Ledger &x = a.ledgers[earlier + k], &y = b.ledgers[k];
        ASSERT_EQ(x.kinetic + x.strain, y.kinetic + y.strain) << "step " << k;
        ASSERT_EQ(x.friction, y.friction) << "step " << k;
        ASSERT_EQ(x.contact, y.contact) << "step " << k;
        ASSERT_EQ(x.angular, y.angular) << "step " << k;
    }
}

inline void expect_same_bits(const Diary& a, const Diary& b) {
    ASSERT_EQ(a.states.size(), b.states.size());
    ASSERT_EQ(a.ledgers.size(), b.ledgers.size());
    expect_same_end(a, b);
}

inline const std::vector<scene::Override> impact{{"stages.bounce.duration", "1.1"},
                                                 {"stages.bounce.steps", "215"},
                                                 {"stages.bounce.control.step_size", "fixed"},
                                                 {"stages.bounce.control.allowed_interpenetration", "1e-4"}};
/// Stick and slip on a smooth master, facets left and entered: half a metre along the half-tube.
inline const std::vector<scene::Override> slide{{"bodies.tube.mesh.half_tube.divisions", "[7, 6, 1]"},
                                                {"bodies.contactor.mesh.contactor.divisions", "[5, 6, 1]"},
                                                {"stages.slide.steps", "7"},
                                                {"stages.slide.duration", "7"},
                                                {"stages.slide.displacement.rear.y", "0.5"}};

/// Dynamics with all of it: a tilted block thrown on a smooth master sticks and slips, corner after corner.
inline const std::vector<scene::Override> thrown{{"bodies.block.mesh.rotate", "{axis: [1, 2, 0], angle: 0.02}"},
                                                 {"bodies.block.mesh.translate", "[0, 0, -0.45]"},
                                                 {"bodies.block.initial_velocity", "[0.05, 0.02, 0]"},
                                                 {"contact.floor.surface", "blend"},
                                                 {"contact.floor.friction", "0.8"},
                                                 {"stages.fall.analysis.dynamic.contact_mass", "redistributed"},
                                                 {"stages.fall.duration", "0.13"},
                                                 {"stages.fall.steps", "65"}};

} // namespace osculate::support
