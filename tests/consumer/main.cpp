/// Osculate from another program: a scene is read, compiled and run, and the force on a contact pair's slave is printed.

#include <cstdio>
#include <osculate/app/load.hpp>
#include <osculate/core/error.hpp>
#include <osculate/time/stepper.hpp>

namespace {

class Forces final : public osculate::time::StepObserver {
public:
    void attempted(const osculate::time::Attempt&,
                   const std::vector<osculate::equilibrium::IterationRecord>&) override {}
    void accepted(const osculate::time::AcceptedStep& step) override {
        osculate::Vec3 force = osculate::Vec3::Zero();
        for (const osculate::Vec3& lambda : step.state.contact.front().lambda) force += lambda;
        std::printf("time %g s: force %.6e %.6e %.6e N\n", step.state.time, force.x(), force.y(), force.z());
    }
};

} // namespace

int main(int, char** argv) {
    try {
        osculate::Timings timings;
        osculate::app::LoadedScene loaded = osculate::app::load(argv[1], {}, 1, timings);
        osculate::time::Stepper stepper(loaded.plan.model, loaded.plan.stages, loaded.plan.stepper, timings);
        Forces forces;
        stepper.run(forces);
    } catch (const osculate::SceneError& error) { // every fault with its place
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    } catch (const osculate::RunFailure& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
}
