#pragma once
/// From a scene to the objects that run it, and to nothing else.

#include "osculate/core/timing.hpp"
#include "osculate/model/model.hpp"
#include "osculate/output/probe.hpp"
#include "osculate/scene/scene.hpp"
#include "osculate/time/stepper.hpp"

#include <memory>
#include <string>
#include <vector>

namespace osculate::app {

/// What a part takes, estimated from counts of the plan: good to a factor of two or so.
struct PlanCost {
    double bytes = 0;   ///< held while the run goes
    double count = 0;   ///< of `unit`
    std::string unit{}; ///< such as "elements an iteration"
};

/// A part of the plan that is there or left out, and why.
struct PlanItem {
    std::string part;
    bool present = false;
    std::string reason;
    PlanCost cost{}; ///< zeros where the part is left out, or where there is nothing worth counting
};

/// A probe, and how many accepted steps lie between its rows.
struct PlannedProbe {
    std::string name;
    int every = 1;
    std::unique_ptr<output::Probe> probe;
};

struct Plan {
    model::Model model;
    std::vector<time::Stage> stages;
    time::StepperOptions stepper;
    std::vector<Index> constrained_sets; ///< of model.sets, in the scene's order
    std::vector<PlannedProbe> probes;
    std::vector<PlanItem> items;
    std::vector<std::string> mesh_notes; ///< of build_meshes
};

/// Meshes of the scene's bodies, in its order. Throws SceneError for what cannot be generated or read.
/// @param notes  what was mended in meshes of files, and what is suspicious but allowed
[[nodiscard]] std::vector<mesh::Mesh> build_meshes(const scene::Scene& scene,
                                                   std::vector<std::string>* notes = nullptr);

/// Builds what the scene needs. Throws SceneError with every fault found: names without nodes or facets, bodies without
/// support, initial overlaps, elements turned inside out.
/// @param meshes  one per body; build_meshes(scene), or the same bodies numbered otherwise
[[nodiscard]] Plan compile(const scene::Scene& scene, std::vector<mesh::Mesh> meshes, int threads, Timings& timings);

} // namespace osculate::app
