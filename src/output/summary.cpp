#include "osculate/output/summary.hpp"

#include "output/json_file.hpp"

namespace osculate::output {

void write_summary(const std::filesystem::path& path, const Summary& summary) {
    using Json = nlohmann::ordered_json;
    Json bodies = Json::array(), pairs = Json::array();
    for (const Summary::Body& body : summary.bodies)
        bodies.push_back({{"name", body.name}, {"nodes", body.nodes}, {"elements", body.elements}});
    for (const Summary::Pair& pair : summary.pairs)
        pairs.push_back({{"name", pair.name},
                         {"slave_nodes", pair.slave_nodes},
                         {"master_facets", pair.master_facets},
                         {"surface", pair.surface}});

    Json processes = Json::array();
    for (const Summary::Process& process : summary.processes)
        processes.push_back({{"nodes", process.nodes},
                             {"elements", process.elements},
                             {"slave_nodes", process.slave_nodes},
                             {"peak_memory_bytes", process.peak_memory_bytes},
                             {"shared_memory_bytes", process.shared_memory_bytes}});

    Json json;
    json["version"] = summary.version;
    json["scene"] = summary.scene;
    json["status"] = summary.status;
    if (!summary.failure.empty()) json["failure"] = summary.failure;
    json["dofs"] = summary.dofs;
    json["bodies"] = bodies;
    json["pairs"] = pairs;
    if (!processes.empty()) json["processes"] = processes;
    json["steps"] = {{"accepted", summary.steps.accepted},
                     {"rejected", summary.steps.rejected},
                     {"stabilised", summary.steps.stabilised},
                     {"at_round_off", summary.steps.at_round_off},
                     {"held_geometry", summary.steps.held_geometry}};
    json["iterations"] = summary.iterations;
    json["factorisations"] = summary.factorisations;
    json["gmres_iterations"] = summary.gmres_iterations;
    const Timings& timings = summary.timings;
    json["seconds"] = {{"total", summary.total_seconds},    {"cpu", summary.cpu_seconds},
                       {"search", timings[Part::search]},   {"patches", timings[Part::patches]},
                       {"contact", timings[Part::contact]}, {"assembly", timings[Part::assembly]},
                       {"factor", timings[Part::factor]},   {"solve", timings[Part::solve]},
                       {"output", timings[Part::output]},   {"audit", timings[Part::audit]}};
    json["peak_memory_bytes"] = summary.peak_memory_bytes;
    json["threads"] = summary.threads;
    json["plan"] = summary.plan;
    if (summary.checks) {
        const Summary::Checks& checks = *summary.checks;
        Json& list = json["checks"];
        list["force_balance"] = checks.force_balance;
        if (checks.energy_balance) list["energy_balance"] = *checks.energy_balance;
        if (checks.energy_growth) list["energy_growth"] = *checks.energy_growth;
        if (checks.closing_loss) list["closing_loss"] = *checks.closing_loss;
        if (checks.settling_loss) list["settling_loss"] = *checks.settling_loss;
        if (checks.rotation_strain) list["rotation_strain"] = *checks.rotation_strain;
        list["penetration"] = checks.penetration;
        list["penetration_m"] = checks.penetration_m;
    }
    if (summary.audit) {
        const Summary::Audit& audit = *summary.audit;
        Json& found = json["audit"] = {{"on", audit.on}};
        if (!audit.body.empty())
            found.update({{"depth_m", audit.depth},
                          {"excess_m", audit.excess},
                          {"excess", audit.relative},
                          {"body", audit.body},
                          {"node", audit.node},
                          {"inside", audit.other},
                          {"time", audit.time},
                          {"place", audit.place}});
    }
    if (!summary.warnings.empty()) json["warnings"] = summary.warnings;
    if (summary.expectation)
        json["expectation"] = {{"met", summary.expectation->met()}, {"misses", summary.expectation->misses}};
    write_json_atomic(path, json);
}

} // namespace osculate::output
