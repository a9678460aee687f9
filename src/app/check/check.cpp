#include "app/check/check.hpp"

#include "app/check/facing.hpp"
#include "app/check/free_motions.hpp"
#include "app/check/pair_warnings.hpp"
#include "app/check/pairing_advice.hpp"
#include "app/check/support_warnings.hpp"
#include "app/check/thin_layers.hpp"
#include "app/check/twice_paired.hpp"
#include "app/check/unit_warnings.hpp"
#include "app/plan/body_materials.hpp"
#include "app/plan/gaps.hpp"
#include "app/plan/settle_pairs.hpp"
#include "osculate/app/estimate.hpp"
#include "osculate/app/processes.hpp"
#include "osculate/app/report.hpp"
#include "osculate/app/version.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

namespace osculate::app {

namespace {

using Json = nlohmann::ordered_json;

struct PairCheck {
    const model::ContactPair* pair = nullptr;
    PairGaps gaps{};
    std::vector<std::string> advice{};
    Facing facing{};
};

struct Check {
    Index dofs = 0;
    Estimate cost;
    std::vector<PairCheck> pairs;
    std::vector<FreeMotion> free;
    std::vector<Warning> warnings;
};

const model::Body& owner(const model::Model& model, Index node) {
    return *model::body_of(model, node);
}

double modulus(const LoadedScene& loaded, Index node) {
    const model::Body& body = owner(loaded.plan.model, node);
    const scene::Body& spec = *scene::find(loaded.scene.bodies, body.name);
    return spec.rigid ? std::numeric_limits<double>::infinity()
                      : modulus_at(spec, body, model::material_node(loaded.plan.model, node));
}

double stiffness_ratio(const LoadedScene& loaded, const model::ContactPair& pair) {
    return modulus(loaded, pair.slaves().node.front()) / modulus(loaded, pair.master_nodes().front());
}

/// Contact at the nodes lets a coarser side sink in between; the harder one does not give way to it. Where it is much harder,
/// pair_warnings() say so.
void advise_on_stiffness(double ratio, const Pairing& found, PairCheck& check) {
    constexpr double stiffer = 3;
    if (found.near == 0 || averages(found.discretisation)) return;
    if (ratio < stiffer || ratio >= much_stiffer) return;
    if (found.slave_spacing < 0.9 * found.master_spacing) return; // the finer side is the slave: that weighs more
    check.advice.push_back(fmt::format(
        "the slave is {:.2g} times as stiff as the master: the softer side is usually the better slave", ratio));
}

bool finite_strain(const LoadedScene& loaded, Index node) {
    return std::ranges::any_of(owner(loaded.plan.model, node).kernels,
                               [](const auto& kernel) { return kernel->finite_strain(); });
}

/// Bodies at small strain do not turn, and without inertia bodies turn as they are driven.
bool may_tumble(const LoadedScene& loaded, const model::ContactPair& pair) {
    return std::ranges::any_of(loaded.plan.stages, [](const time::Stage& s) { return s.dynamics.has_value(); }) &&
           (finite_strain(loaded, pair.slaves().node.front()) || finite_strain(loaded, pair.master_nodes().front()));
}

void append(std::vector<Warning>& warnings, std::vector<Warning> more) {
    std::ranges::move(more, std::back_inserter(warnings));
}

Check examine(const LoadedScene& loaded, int threads) {
    const Plan& plan = loaded.plan;
    Check check;
    check.dofs = degrees_of_freedom(plan);
    check.cost = estimate(loaded.scene, plan);
    check.warnings = unit_warnings(loaded.scene, plan);
    append(check.warnings, support_warnings(loaded.scene, plan));
    append(check.warnings, thin_layers(loaded.scene, plan));
    append(check.warnings, twice_paired(loaded.scene, plan));
    Timings unused;
    model::ContactEvaluations contact = model::contact_evaluations(plan.pairs_at_start());
    for (model::ContactEvaluation& evaluation : contact) {
        const model::ContactPair& pair = evaluation.pair();
        PairCheck& p = check.pairs.emplace_back(PairCheck{&pair});
        p.gaps = initial_gaps(evaluation, plan.model.X, unused, threads);
        const scene::Pair* const spec = scene::find(loaded.scene.contact, pair.name());
        if (spec == nullptr) continue; // the program's own choice
        const Pairing found = pairing(evaluation, plan.model);
        if (!evaluation.pair().master()->exact()) p.advice = advice(found);
        const double ratio = stiffness_ratio(loaded, pair);
        advise_on_stiffness(ratio, found, p);
        p.facing = facing(evaluation, plan.model.X);
        append(check.warnings,
               pair_warnings(plan.model, {evaluation, *spec, p.facing, found, ratio, may_tumble(loaded, pair)}));
        if (p.gaps.above == 0)
            check.warnings.push_back({"contact." + pair.name(), "no slave node is above or below the master"});
    }
    const bool lands = std::ranges::any_of(
        plan.stages, [](const time::Stage& stage) { return stage.dynamics && !stage.limits.inelastic_impacts; });
    for (const Index b : plan.model.kept_contact_mass)
        if (lands)
            check.warnings.push_back(
                {"bodies." + plan.model.bodies[static_cast<std::size_t>(b)].name,
                 "its slave nodes keep their mass although contact_mass is redistributed: no masses on its other nodes "
                 "give its centre and inertia, so impacts lose or gain energy and contact forces oscillate; use a "
                 "finer "
                 "mesh behind the contact or fewer slave nodes"});
    check.free = free_motions(plan, contact);
    return check;
}

Index slave_nodes(const Plan& plan) {
    Index sum = 0;
    for (const auto& pair : plan.pairs_at_start()) sum += pair->size();
    return sum;
}

Vec3 place(const model::Model& model, Index node) {
    return model.X[static_cast<std::size_t>(node)] + model.origin;
}

// ---- in words ------------------------------------------------------------------------------------------------------------

/// Two digits, without an exponent.
std::string two_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return fmt::format("{:.{}f}", std::round(value / unit) * unit, unit < 0.1 ? 2 : unit < 1 ? 1 : 0);
}

std::string seconds_in_words(double seconds) {
    constexpr double minute = 60, hour = 3600;
    if (seconds < 2 * minute) return two_digits(std::max(0.01, seconds)) + " s";
    return seconds < 2 * hour ? two_digits(seconds / minute) + " min" : two_digits(seconds / hour) + " h";
}

std::string bytes_in_words(double bytes) {
    return bytes < 1e9 ? two_digits(std::max(1.0, 1e-6 * bytes)) + " MB" : two_digits(1e-9 * bytes) + " GB";
}

void say_pair(const model::Model& model, const PairCheck& check, fmt::memory_buffer& text) {
    constexpr std::size_t most = 5; // nodes that are listed
    const auto out = std::back_inserter(text);
    const PairGaps& gaps = check.gaps;
    fmt::format_to(out, "pair {}: {} slave nodes, {} master facets\n", check.pair->name(), check.pair->size(),
                   check.pair->surface().facet_count());
    if (gaps.above > 0)
        fmt::format_to(out, "  {} slave nodes above the master, initial gap {:.4g} m to {:.4g} m\n", gaps.above,
                       gaps.least, gaps.largest);
    else
        fmt::format_to(out, "  no slave node above the master\n");
    if (gaps.least < 0)
        fmt::format_to(out, "  worst overlap {:.4g} m at {}, {:.3g} of the facet size\n", -gaps.least,
                       node_name(model, gaps.worst_node), gaps.largest_overlap);
    else
        fmt::format_to(out, "  no overlap\n");
    for (std::size_t i = 0; i < std::min(most, gaps.overlaps.size()); ++i) {
        const Overlap& overlap = gaps.overlaps[i];
        const Vec3 at = place(model, overlap.node);
        fmt::format_to(out, "    {} at ({:.4g}, {:.4g}, {:.4g}) m overlaps facet {} of the master by {:.4g} m\n",
                       node_name(model, overlap.node), at.x(), at.y(), at.z(), overlap.facet, overlap.depth);
    }
    if (gaps.overlaps.size() > most) fmt::format_to(out, "    and {} more\n", gaps.overlaps.size() - most);
    for (const std::string& sentence : check.advice) fmt::format_to(out, "  advice: {}\n", sentence);
    if (const Index fallbacks = check.pair->master()->fallbacks(); fallbacks > 0)
        fmt::format_to(out, "  {} patches had to be smaller or simpler than asked for\n", fallbacks);
}

std::string in_words(const LoadedScene& loaded, const Check& check) {
    const Plan& plan = loaded.plan;
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    for (const model::Body& body : plan.model.bodies)
        fmt::format_to(out, "body {}: {} nodes, {} elements\n", body.name, body.nodes(), body.mesh.element_count());
    for (const std::string& note : plan.mesh_notes) fmt::format_to(out, "{}\n", note);
    fmt::format_to(out, "degrees of freedom: {}\n", check.dofs);
    fmt::format_to(out, "unknowns: {}, including contact forces\n", check.dofs + 3 * slave_nodes(plan));
    fmt::format_to(
        out, "estimate, mostly within a factor of {:.0f} where no step is cut: {} of one processor, {} of memory\n",
        Estimate::factor, seconds_in_words(check.cost.seconds), bytes_in_words(check.cost.bytes));
    for (const PairCheck& pair : check.pairs) say_pair(plan.model, pair, text);
    for (const model::Tie& tie : plan.model.ties) {
        fmt::format_to(out, "tie {}: {} nodes follow, moved by up to {:.3g} m", tie.name, tie.nodes.size(),
                       tie.adjusted);
        if (tie.left_out > 0) fmt::format_to(out, "; {} nodes are too far from the master, or beside it", tie.left_out);
        fmt::format_to(out, "\n");
    }
    for (const time::Stage& stage : plan.stages) {
        fmt::format_to(out, "stage {}: {} step(s) in {:.6g} s\n", stage.name, stage.steps, stage.duration);
        if (stage.limits.inelastic_impacts)
            fmt::format_to(out,
                           "  impacts are inelastic{}, with a stiffness damping of {:.3g} s: small or no "
                           "rebounds, and vibrations die out; impacts: resolved follows rebounds\n",
                           plan.settles_by_rule ? ", the default with general contact" : "",
                           stage.dynamics->stiffness_damping);
    }
    for (std::size_t i = 0; i < check.free.size();) { // a line for what is said of the same bodies
        const FreeMotion& first = check.free[i];
        std::string motions;
        for (; i < check.free.size() && check.free[i].bodies == first.bodies; ++i)
            motions += (motions.empty() ? "" : ", ") + check.free[i].motion;
        fmt::format_to(out, "free: {} {}; {}\n", first.bodies, motions,
                       first.rubs    ? "friction alone can hold that"
                       : first.apart ? "nothing holds that until contact is made"
                                     : "neither supports nor contact hold that");
    }
    for (const Warning& warning : check.warnings) fmt::format_to(out, "warning: {}: {}\n", warning.key, warning.text);
    return fmt::to_string(text);
}

// ---- as JSON -------------------------------------------------------------------------------------------------------------

Json vector(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

Json as_json(const model::Model& model, const PairCheck& check) {
    const PairGaps& gaps = check.gaps;
    Json overlaps = Json::array(), away = Json::array();
    for (const Overlap& overlap : gaps.overlaps) {
        const model::Body& body = owner(model, overlap.node);
        overlaps.push_back({{"body", body.name},
                            {"node", model::material_node(model, overlap.node) - body.first_node},
                            {"position", vector(place(model, overlap.node))},
                            {"master_facet", overlap.facet},
                            {"master_point", vector(overlap.foot + model.origin)},
                            {"depth", overlap.depth},
                            {"of_facet_size", overlap.of_facet}});
    }
    for (const std::size_t f : check.facing.away)
        away.push_back(vector(mesh::facet_centroid(check.pair->slaves().facets[f], model.X) + model.origin));
    Json json{{"name", check.pair->name()},
              {"slave_nodes", check.pair->size()},
              {"master_facets", check.pair->surface().facet_count()},
              {"above", gaps.above}};
    json["least_gap"] = gaps.above > 0 ? Json(gaps.least) : Json(nullptr);
    json["largest_gap"] = gaps.above > 0 ? Json(gaps.largest) : Json(nullptr);
    json["overlaps"] = std::move(overlaps);
    json["facets_looking_away"] = std::move(away);
    json["patches_fallen_back"] = check.pair->master()->fallbacks();
    json["advice"] = check.advice;
    return json;
}

std::string as_json(const LoadedScene& loaded, const Check& check, int processes) {
    const Plan& plan = loaded.plan;
    Json json{{"version", version}, {"scene", loaded.scene.name}};
    json["bodies"] = json["pairs"] = json["stages"] = json["free_motions"] = json["warnings"] = Json::array();
    for (const model::Body& body : plan.model.bodies)
        json["bodies"].push_back(
            {{"name", body.name}, {"nodes", body.nodes()}, {"elements", body.mesh.element_count()}});
    json["dofs"] = check.dofs;
    json["unknowns"] = check.dofs + 3 * slave_nodes(plan);
    Json terms = Json::array();
    for (const CostTerm& term : cost_terms(loaded.scene, plan))
        terms.push_back({{"what", term.what}, {"count", term.count}, {"seconds_each", term.seconds}});
    json["estimate"] = {{"steps", check.cost.steps},
                        {"cpu_seconds", check.cost.seconds},
                        {"memory_bytes", check.cost.bytes},
                        {"factor", Estimate::factor},
                        {"terms", std::move(terms)}};
    if (processes > 0) {
        const ProcessMemory memory = process_memory(plan);
        json["processes"] = {{"count", processes},
                             {"memory_bytes_of_one", memory.of_one(processes)},
                             {"memory_bytes_of_first", memory.of_first(processes)},
                             {"memory_bytes_of_all", memory.of_all(processes)}};
    }
    for (const PairCheck& pair : check.pairs) json["pairs"].push_back(as_json(plan.model, pair));
    for (const time::Stage& stage : plan.stages)
        json["stages"].push_back({{"name", stage.name}, {"steps", stage.steps}, {"duration", stage.duration}});
    for (const FreeMotion& free : check.free)
        json["free_motions"].push_back({{"bodies", free.bodies},
                                        {"motion", free.motion},
                                        {"held_by", free.rubs    ? "friction"
                                                    : free.apart ? "nothing yet"
                                                                 : "nothing"}});
    for (const Warning& warning : check.warnings)
        json["warnings"].push_back({{"key", warning.key}, {"text", warning.text}});
    return json.dump(2) + "\n";
}

} // namespace

std::string check_scene(const LoadedScene& loaded, int threads, bool json, int processes) {
    const std::string shared = processes > 0 ? processes_in_words(loaded.plan, processes) : "";
    const Check check = examine(loaded, threads);
    return json ? as_json(loaded, check, processes) : in_words(loaded, check) + shared;
}

} // namespace osculate::app
