#pragma once
/// Builds from a scene the objects that run it, and nothing else.

#include "osculate/core/timing.hpp"
#include "osculate/model/general_contact.hpp"
#include "osculate/model/model.hpp"
#include "osculate/output/probe.hpp"
#include "osculate/scene/scene.hpp"
#include "osculate/time/stepper.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osculate::app {

/// Cost of a part, estimated from counts of the plan, correct to a factor of about two.
struct PlanCost {
    double bytes = 0;   ///< memory during the run
    double count = 0;   ///< of `unit`
    std::string unit{}; ///< for example "elements an iteration"
};

/// A part of the plan that is present or left out, and the reason.
struct PlanItem {
    std::string part;
    bool present = false;
    std::string reason;
    PlanCost cost{}; ///< zeros if the part is left out or its cost is negligible
};

/// A probe, and the number of accepted steps between its rows.
struct PlannedProbe {
    std::string name;
    int every = 1;
    std::unique_ptr<output::Probe> probe;
};

/// Why a choice was made that a pair leaves to the program; empty: the scene makes it.
struct PairChoice {
    std::string discretisation, roles;
};

struct Plan {
    model::Model model;
    scene::Named<scene::Pair> contact;            ///< the scene's pairs, in its order: with roles and discretisation
    std::vector<PairChoice> choices;              ///< of each of them
    std::optional<scene::GeneralContact> general; ///< the scene's, with its discretisation
    PairChoice general_choice;
    std::vector<model::ContactHistory> near_at_start;  ///< pairs that general contact finds there
    std::optional<model::ContactScope> scope_at_start; ///< of these; none: no general contact
    std::vector<time::Stage> stages;
    time::StepperOptions stepper;
    std::vector<Index> constrained_sets; ///< of model.sets, in the scene's order
    std::vector<PlannedProbe> probes;
    std::vector<PlanItem> items;
    std::vector<std::string> mesh_notes; ///< of build_meshes

    bool settles_by_rule = false; ///< a rule, not the scene, made impacts of some stage inelastic
    /// The scene's pairs, then those that general contact finds at the start.
    [[nodiscard]] model::ContactPairs pairs_at_start() const;
    /// Scope of the latter, null without general contact.
    [[nodiscard]] const model::ContactScope* scope() const;
};

/// Meshes of the scene's bodies, in its order. Throws SceneError for a mesh that cannot be generated or read.
/// @param notes  repairs of meshes from files, and what is suspicious but allowed
[[nodiscard]] std::vector<mesh::Mesh> build_meshes(const scene::Scene& scene,
                                                   std::vector<std::string>* notes = nullptr);

/// Builds all objects that the scene needs. Throws SceneError with every fault found: names without nodes or facets,
/// bodies without support, initial overlaps, elements turned inside out.
/// @param meshes  one per body; build_meshes(scene), or the same bodies with another numbering
/// @param ranks   processes that share the run, each of which compiles it; null: one
[[nodiscard]] Plan compile(const scene::Scene& scene, std::vector<mesh::Mesh> meshes, int threads, Timings& timings,
                           std::shared_ptr<Ranks> ranks = nullptr);

/// Builds the meshes, compiles, and writes into the scene what its pairs left to the program.
[[nodiscard]] Plan compile(scene::Scene& scene, int threads, Timings& timings, std::shared_ptr<Ranks> ranks = nullptr);

} // namespace osculate::app
