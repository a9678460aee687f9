#pragma once
/// Runs a scene in memory and keeps what the claims of the verification tests need.

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/time/stepper.hpp"

#include <functional>
#include <string>
#include <vector>

namespace osculate::support {

/// Forces of one pair at one accepted step.
struct PairForces {
    Vec3 on_slave = Vec3::Zero(), on_master = Vec3::Zero();
    Vec3 moment_on_slave = Vec3::Zero(), moment_on_master = Vec3::Zero(); ///< about the origin
    double normal = 0, friction = 0;
    double penetration = 0; ///< worst, >= 0
};

struct RunStep {
    double time = 0;
    int iterations = 0;
    std::vector<equilibrium::IterationRecord> records;
    std::vector<PairForces> pairs;
    std::vector<Vec3> reactions;               ///< per constrained set
    std::vector<Vec3> held_force, held_moment; ///< what fix and motion exert, per rigid body and coupling
    Vec3 load = Vec3::Zero();                  ///< sum of external forces
    model::State state;
    time::Ledger ledger; ///< of a dynamic step
};

struct SceneRun {
    app::Plan plan;
    Timings timings;
    std::vector<RunStep> steps;
    model::ContactEvaluations contact; ///< at the end of the last step
    int attempts = 0;
};

/// Meshes may be changed between generation and compilation.
using EditMeshes = std::function<void(std::vector<mesh::Mesh>&)>;

void run_scene(SceneRun& run, const std::string& path, const std::vector<scene::Override>& overrides,
               const EditMeshes& edit, int threads = 1);
void run_scene(SceneRun& run, const std::string& path, const std::vector<scene::Override>& overrides = {},
               int threads = 1);

/// Path of a shipped scene.
std::string shipped(const std::string& name);

} // namespace osculate::support
