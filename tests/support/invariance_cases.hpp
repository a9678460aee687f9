#pragma once
/// Which scenes are held against their transformations, how far each is run, and what is known of those that differ.

#include "osculate/scene/reader.hpp"
#include "support/source_tree.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
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
    static const std::map<std::string, int> steps{
        {"tutorials/bouncing_ball", 230},    {"tutorials/block_on_incline", 30},     {"tutorials/two_bars", 40},
        {"extreme/rolling_quarter_turn", 6}, {"extreme/held_by_weak_friction", 2},   {"extreme/wheel_rolls_freely", 6},
        {"extreme/shallow_ironing", 4},      {"extreme/time_step_1000_too_long", 40}};
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
    bool displacement_only = false;             ///< forces are the same; of all transformations
    std::vector<std::string> transformations{}; ///< of which nothing is the same

    [[nodiscard]] bool concerns(const std::string& transformation) const {
        return std::ranges::find(transformations, transformation) != transformations.end();
    }
};

inline const std::map<std::string, KnownDifference>& known_differences() {
    constexpr const char* symmetric = "nodes stand on sharp edges or corners of a scene that is its own mirror image: "
                                      "either side is a solution, and what tells facets apart there, the sense of "
                                      "rotation or at last their numbers, changes in a mirror or with other numbers";
    constexpr const char* bent = "nodes slide along mesh lines of facets that are bent by the load, in a scene that is "
                                 "its own mirror image: the "
                                 "facets on both sides of a line are equally near but have different slopes";
    constexpr const char* far = "1e6 m away a double resolves 1e-10 m, and a rotation rounds it again; the load moves "
                                "nodes by 1e-3 m, so that is 1e-7 of it";
    constexpr const char* needle =
        "a needle of 4 m indents the slab by 1e-9 m: a rotation rounds the coordinates by 1e-16 of the needle's "
        "length, and coordinates 1e6 sizes away resolve no more than 1e-9 m, so that contact depends on chance";
    constexpr const char* wedged = "friction of 10 wedges the body in: more than one state balances all forces, Newton "
                                   "cycles before it finds one, and round-off decides how the step is cut on the way";
    constexpr const char* round = "a slave 1e6 times stiffer than its master: Newton cycles before it "
                                  "finds the equilibrium, and round-off decides how the step is cut on the way";
    constexpr const char* several =
        "bodies bend and buckle so far within a step that it has more than one solution: "
        "Newton cycles before it finds one, and round-off decides which one, or how the step is cut on the way";
    constexpr const char* between = "a corner stands on the concave edge of a master of facets: Newton goes round "
                                    "between the two normals there, and "
                                    "round-off decides whether it finds one of the two equilibria, which are mirror "
                                    "images, at once or in cut steps";
    constexpr const char* skin =
        "a skin 1e6 times softer than the core: its forces are near the tolerance, which is taken of all forces, so "
        "that its displacements have four digits";
    constexpr const char* sheet =
        "a sheet of elements a hundred times as wide as thick: what it takes to bend it is 1e-8 of the stiffness of "
        "its elements, whose round-off leaves five digits of the contact forces";
    constexpr const char* forged =
        "strains of hundreds of times that of yielding under friction of 0.5: Newton cycles before it finds the "
        "equilibrium, and round-off decides how the step is cut on the way";
    constexpr const char* cut = "steps are cut to the time at which gaps close: the solver's tolerance leaves an error "
                                "in the gaps, and so in the lengths of steps";
    constexpr const char* driven =
        "rigid bodies, couplings and exact surfaces are where and along what the scene says, which its "
        "turned image cannot say";
    constexpr const char* driven_alike = "couplings turn about axes of the scene, which its turned image cannot say; "
                                         "and general contact makes the first "
                                         "of two bodies that are alike the slave: in another order it is the other";
    constexpr const char* alike = "of two bodies that are alike general contact makes the first the slave: in another "
                                  "order it is the other";
    static const std::vector<std::string> sides{"mirror", "numbering"};
    static const std::vector<std::string> every{"length 1e9", "length 1e-9", "mass 1e9",   "mass 1e-9",
                                                "time 1e9",   "time 1e-9",   "rotation",   "mirror",
                                                "numbering",  "body order",  "translation"};
    constexpr const char* sliding = "frictionless: only round-off decides where the block is along the groove";
    static const std::map<std::string, KnownDifference> all{
        {"extreme/thin_wedges", {.reason = sheet, .transformations = every}},
        {"extreme/stiff_inclusion", {.reason = skin, .transformations = every}},
        {"extreme/tie_of_unlike_halves", {.reason = driven, .transformations = {"rotation"}}},
        {"extreme/forged_flat", {.reason = forged, .transformations = every}},
        {"extreme/block_in_groove", {.reason = sliding, .displacement_only = true}},
        {"extreme/edge_on_edge", {.reason = symmetric, .transformations = sides}},
        {"extreme/edges_crossed", {.reason = symmetric, .transformations = sides}},
        {"extreme/vertex_on_edge", {.reason = symmetric, .transformations = sides}},
        {"extreme/vertex_on_vertex", {.reason = symmetric, .transformations = sides}},
        {"extreme/vertex_on_vertex_facets", {.reason = symmetric, .transformations = sides}},
        {"extreme/nodes_on_edges", {.reason = bent, .transformations = sides}},
        {"extreme/spike_in_crack", {.reason = symmetric, .transformations = {"mirror"}}},
        {"extreme/spike_in_crack_facets", {.reason = between, .transformations = every}},
        {"extreme/stiff_slave_mortar", {.reason = round, .transformations = every}},
        {"extreme/stiff_slave", {.reason = round, .transformations = {"time 1e-9"}}},
        {"extreme/overlap_dynamic", {.reason = cut, .transformations = every}},
        {"tutorials/balls_in_box", {.reason = alike, .transformations = {"body order"}}},
        {"tutorials/clip", {.reason = driven, .transformations = {"rotation", "mirror"}}},
        {"tutorials/tool_into_rubber", {.reason = driven, .transformations = {"rotation", "mirror"}}},
        {"tutorials/bracket", {.reason = driven, .transformations = {"rotation"}}},
        {"tutorials/bolted_joint", {.reason = driven, .transformations = {"rotation"}}},
        {"tutorials/spur_gears", {.reason = driven_alike, .transformations = {"rotation", "mirror", "body order"}}},
        {"extreme/wedge_in_crack", {.reason = symmetric, .transformations = sides}},
        {"extreme/time_step_1000_too_long", {.reason = cut, .transformations = every}},
        {"extreme/half_tube_mu_10", {.reason = wedged, .transformations = every}},
        {"extreme/ring_through_itself", {.reason = several, .transformations = every}},
        {"extreme/snap_fit", {.reason = several, .transformations = every}},
        {"extreme/far_from_origin", {.reason = far, .transformations = {"rotation"}}},
        {"extreme/needle_elements", {.reason = needle, .transformations = {"rotation", "translation"}}}};
    return all;
}

/// Scenes that are left out, and why.
inline const std::map<std::string, const char*>& left_out() {
    constexpr const char* gives_up = "gives up, as expected: the place depends on the last digits";
    constexpr const char* long_run = "takes too long to be run a dozen times";
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
                "extreme/initial_gap", "extreme/nanometre",      "extreme/rubber_mu_10",  "extreme/sliver_tetrahedra"};
    std::vector<std::string> all;
    for (const std::string folder : {"paper", "tutorials", "extreme"}) {
        for (const auto& entry : std::filesystem::directory_iterator(support::source_tree() + "/configs/" + folder)) {
            const std::string name = folder + "/" + entry.path().stem().string();
            if (entry.path().extension() == ".yaml" && !left_out().contains(name)) all.push_back(name);
        }
    }
    std::ranges::sort(all);
    return all;
}

} // namespace osculate::support
