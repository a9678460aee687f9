#pragma once
/// Which scenes are held against their transformations, how far each is run, and what is known of those that differ.

#include "osculate/scene/reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace osculate::support {

/// How a scene is run here, where it is not run as it is.
struct InvarianceCase {
    std::vector<scene::Override> overrides{};
    int most_steps = 20; ///< accepted ones
};

inline InvarianceCase invariance_case(const std::string& scene) {
    const std::vector<scene::Override> coarse_tube{{"bodies.tube.mesh.half_tube.divisions", "[7, 6, 2]"},
                                                   {"bodies.contactor.mesh.contactor.divisions", "[5, 6, 2]"}};
    const std::vector<scene::Override> coarse_soil{{"bodies.foundation.mesh.block.divisions", "[12, 12, 2]"},
                                                   {"bodies.soil.mesh.block.divisions", "[10, 10, 4]"}};
    static const std::map<std::string, int> steps{{"tutorials/bouncing_ball", 230},
                                                  {"tutorials/block_on_incline", 30},
                                                  {"tutorials/two_bars", 40},
                                                  {"extreme/time_step_1000_too_long", 40}};
    InvarianceCase c;
    if (const auto found = steps.find(scene); found != steps.end()) c.most_steps = found->second;
    if (scene.find("half_tube") != std::string::npos && scene != "extreme/half_tube_folded") {
        c.overrides = coarse_tube;
        c.most_steps = 3;
    }
    if (scene == "paper/half_tube_line") c.overrides[0].value = "[6, 6, 2]"; // a line of nodes along the bottom
    if (scene.find("foundation") != std::string::npos) c.overrides = coarse_soil;
    return c;
}

/// A difference with a cause in the scene.
struct KnownDifference {
    const char* reason;
    bool displacement_only = true; ///< forces are the same
};

inline const std::map<std::string, KnownDifference>& known_differences() {
    static const std::map<std::string, KnownDifference> all{};
    return all;
}

/// Scenes that are left out, and why.
inline const std::map<std::string, const char*>& left_out() {
    constexpr const char* gives_up = "gives up, as expected: where is a matter of its last digits";
    constexpr const char* long_run = "too long to be run a dozen times";
    static const std::map<std::string, const char*> all{{"extreme/crushed_against_a_wall", gives_up},
                                                        {"extreme/driven_through_a_wall", gives_up},
                                                        {"extreme/held_by_friction_released", gives_up},
                                                        {"extreme/held_by_nothing", gives_up},
                                                        {"extreme/torn_off", gives_up},
                                                        {"extreme/many_contact_nodes", long_run},
                                                        {"extreme/half_tube_10_mpa", long_run},
                                                        {"extreme/half_tube_10_mpa_finite", long_run}};
    return all;
}

/// All scenes where OSCULATE_FULL is set, else some quick ones of every kind.
inline std::vector<std::string> invariance_scenes() {
    if (std::getenv("OSCULATE_FULL") == nullptr)
        return {"extreme/cliff_edge",  "extreme/dense_on_light", "extreme/edges_crossed", "extreme/flat_elements",
                "extreme/initial_gap", "extreme/nanometre",      "extreme/snap_through",  "extreme/sliver_tetrahedra"};
    std::vector<std::string> all;
    for (const std::string folder : {"paper", "tutorials", "extreme"}) {
        for (const auto& entry :
             std::filesystem::directory_iterator(std::string(OSCULATE_SOURCE_DIR) + "/configs/" + folder)) {
            const std::string name = folder + "/" + entry.path().stem().string();
            if (entry.path().extension() == ".yaml" && !left_out().contains(name)) all.push_back(name);
        }
    }
    std::ranges::sort(all);
    return all;
}

} // namespace osculate::support
