#include "report/summary_sections.hpp"

#include "osculate/core/escaped.hpp"
#include "osculate/scene/outline.hpp"
#include "report/html.hpp"
#include "report/summary_json.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <vector>

namespace osculate::report {

using nlohmann::json;

namespace {

std::string duration(double seconds) {
    if (!std::isfinite(seconds)) return "–";
    if (seconds < 100) return fmt::format("{:.3g} s", seconds);
    const long whole = std::lround(seconds);
    return whole < 3600 ? fmt::format("{} min {:02} s", whole / 60, whole % 60)
                        : fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string megabytes(double bytes) {
    return figure(bytes / 1e6) + " MB";
}

/// Values of keys that name files.
void add_files(const scene::OutlineItem& item, std::vector<std::string>& files) {
    if (item.key == "path" || item.key == "file") files.push_back(item.text);
    for (const scene::OutlineItem& one : item.items) add_files(one, files);
}

} // namespace

std::string key_figures(const RunFiles& files, double last_time) {
    const json steps = object(files.summary, "steps"), seconds = object(files.summary, "seconds"),
               checks = object(files.summary, "checks");
    std::string text;
    const auto add = [&](const std::string& name, const std::string& value, const std::string& more) {
        text += "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) +
                (more.empty() ? "" : "<small>" + escaped(more) + "</small>") + "</dd></div>\n";
    };
    double elements = 0;
    for (const json& body : list(files.summary, "bodies")) elements += member(body, "elements");
    add("Degrees of freedom", count(files.number("dofs")), count(elements) + " elements");
    add("Reached", std::isfinite(last_time) ? scene::engineering(last_time, "s") : "–", "of the scene's time");
    add("Steps", count(member(steps, "accepted")),
        count(member(steps, "rejected")) +
            (member(steps, "rejected") == 1 ? " attempt rejected" : " attempts rejected") +
            (member(steps, "at_round_off") > 0 ? ", " + count(member(steps, "at_round_off")) + " ended at round-off"
                                               : ""));
    add("Newton iterations", count(files.number("iterations")),
        figure(files.number("iterations") / (member(steps, "accepted") + member(steps, "rejected"))) + " per attempt");
    add("Wall time", duration(member(seconds, "total")), duration(member(seconds, "cpu")) + " CPU");
    if (std::isfinite(member(checks, "penetration_m")))
        add("Worst penetration", measure(member(checks, "penetration_m"), "m"),
            figure(member(checks, "penetration")) + " of the facet size");
    return text;
}

std::string mesh_section(const RunFiles& files) {
    std::vector<std::vector<std::string>> bodies, pairs;
    for (const json& body : list(files.summary, "bodies"))
        bodies.push_back({word(body, "name"), count(member(body, "nodes")), count(member(body, "elements"))});
    for (const json& pair : list(files.summary, "pairs"))
        pairs.push_back({word(pair, "name"), word(pair, "surface"), count(member(pair, "slave_nodes")),
                         count(member(pair, "master_facets"))});
    std::string text;
    if (!bodies.empty()) text += table({"Body", "Nodes", "Elements"}, bodies, {1, 2});
    text += pairs.empty() ? element("p", "There is no contact in this scene.")
                          : table({"Pair", "Surface of the master", "Slave nodes", "Master facets"}, pairs, {2, 3});
    return files.summary.empty() ? "" : section("mesh", "Mesh and pairs", "<div class=\"columns\">" + text + "</div>");
}

std::string checks_section(const RunFiles& files) {
    struct Check {
        const char *name, *what;
    };
    static constexpr Check known[] = {
        {"force_balance", "Force left over in the worst step, of the forces that act"},
        {"energy_balance", "What the energies do not add up to, of the largest energy"},
        {"energy_growth", "Kinetic plus strain energy beyond external work, of the largest energy"},
        {"closing_loss", "Energy that gaps took when they closed, of the largest energy"},
        {"settling_loss", "Energy that impacts and stiffness damping took by default, of the largest energy"},
        {"rotation_strain", "Strain that rotations add to bodies at small strain"},
        {"penetration", "Deepest place of a body inside another, in facet sizes"},
        {"penetration_m", "The same as a length"}};
    const json checks = object(files.summary, "checks"), expectation = object(files.summary, "expectation");
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, what] : known) {
        const double value = member(checks, name);
        if (std::isfinite(value))
            rows.push_back({what, std::string(name) == "penetration_m" ? measure(value, "m") : figure(value)});
    }
    std::string text = rows.empty() ? element("p", "The run has been checked for nothing yet.")
                                    : table({"Worst over all accepted steps", "Value"}, rows, {1});
    const json audit = object(files.summary, "audit");
    if (audit.contains("on") && audit["on"] == false)
        text += element("p", "The audit of geometry was off: nobody looked for bodies inside one another.");
    else if (audit.contains("depth_m"))
        text += element(
            "p", escaped("Deepest: node " + count(member(audit, "node")) + " of body '" + word(audit, "body") + "', " +
                         measure(member(audit, "depth_m"), "m") + " inside the facets of '" + word(audit, "inside") +
                         "' at " + scene::engineering(member(audit, "time"), "s") + "; " +
                         measure(member(audit, "excess_m"), "m") + " more than facets of smooth surfaces bulge by."));
    for (const json& warning : list(files.summary, "warnings"))
        if (warning.is_string()) text += element("p", "Warning: " + escaped(warning.get<std::string>()));
    if (!expectation.empty()) {
        std::string misses;
        for (const json& miss : list(expectation, "misses"))
            if (miss.is_string()) misses += element("li", escaped(miss.get<std::string>()));
        text += misses.empty() ? element("p", "The run came to what its scene expects.")
                               : element("p", "Not as the scene expects:") + element("ul", misses);
    }
    return files.summary.empty() ? "" : section("checks", "Checks", text);
}

std::string cost_section(const RunFiles& files) {
    const json seconds = object(files.summary, "seconds");
    const double total = member(seconds, "total");
    if (!(total > 0)) return "";
    std::vector<std::pair<std::string, double>> parts;
    double named = 0;
    for (const auto& [name, value] : seconds.items())
        if (value.is_number() && name != "total" && name != "cpu") {
            parts.emplace_back(name, value.get<double>());
            named += parts.back().second;
        }
    std::ranges::sort(parts, std::greater{}, &std::pair<std::string, double>::second);
    if (total > named) parts.emplace_back("everything else", total - named);
    double largest = 0;
    for (const auto& [name, value] : parts) largest = std::max(largest, value);
    std::string bars;
    for (const auto& [name, value] : parts)
        bars +=
            fmt::format("<li><span>{}</span><span class=\"bar\"><i style=\"width:{:.2f}%\"></i></span>"
                        "<span class=\"number\">{}</span><span class=\"number\">{:.1f} %</span></li>\n",
                        escaped(name), largest > 0 ? 100 * value / largest : 0, duration(value), 100 * value / total);
    std::string text = element("ul class=\"bars\"", bars);
    const json processes = list(files.summary, "processes");
    std::vector<std::vector<std::string>> rows{
        {"Wall time, CPU time", duration(total) + ", " + duration(member(seconds, "cpu"))},
        {"Threads", count(files.number("threads"))},
        {processes.empty() ? "Peak memory" : "Peak memory of the first process",
         megabytes(files.number("peak_memory_bytes"))},
        {"Factorisations", count(files.number("factorisations"))},
        {"GMRES iterations", count(files.number("gmres_iterations"))}};
    text += table({"Cost", ""}, rows, {1});
    rows.clear();
    for (const json& process : processes)
        rows.push_back({count(static_cast<double>(rows.size())), count(member(process, "nodes")),
                        count(member(process, "elements")), count(member(process, "slave_nodes")),
                        megabytes(member(process, "peak_memory_bytes")),
                        megabytes(member(process, "shared_memory_bytes"))});
    if (!rows.empty())
        text += table({"Process", "Nodes", "Elements", "Slave nodes", "Peak memory", "Kept once a machine"}, rows,
                      {0, 1, 2, 3, 4, 5});
    return section("cost", "Time and memory", text);
}

std::string reproduce_section(const RunFiles& files) {
    if (files.scene_text.empty()) return "";
    const std::string name = files.name();
    const double threads = files.number("threads");
    const std::size_t processes = list(files.summary, "processes").size();
    const std::string command = fmt::format(
        "{2}osculate run {0}.yaml -o out/{0} --threads {1}{3}", name, std::isfinite(threads) ? std::lround(threads) : 1,
        processes > 0 ? fmt::format("mpirun -n {} ", processes) : "", processes > 0 ? " --distributed" : "");
    std::string text = element("p", "Save the scene below as " + element("code", escaped(name + ".yaml")) +
                                        ". It is the scene as it was run: every default and every change given by " +
                                        element("code", "--set") + " is in it. Then");
    text += "<pre class=\"command\"><code id=\"command\">" + escaped(command) + "</code></pre>\n";
    const std::string version = files.text("version", "");
    std::string after =
        processes > 0 ? "gives the same numbers on processors of the same kind; another number of processes "
                        "changes them within the solver's tolerance, and by more where there are several ways to go"
                      : "gives the same numbers with any number of threads";
    if (!version.empty()) after += ", with osculate " + escaped(version);
    if (files.scene) {
        std::vector<std::string> names;
        add_files(scene::outline(*files.scene), names);
        if (const std::string& own = files.scene->output.template_name; own.ends_with(".yaml")) names.push_back(own);
        if (!names.empty()) after += ". It looks beside it for files that the report does not hold: ";
        for (std::size_t k = 0; k < names.size(); ++k)
            after += (k > 0 ? ", " : "") + element("code", escaped(names[k]));
    }
    text += element("p", after + ".");
    text += "<div class=\"tools\"><button type=\"button\" data-copy=\"command\">Copy command</button>"
            "<button type=\"button\" data-copy=\"scene-yaml\">Copy scene</button>"
            "<button type=\"button\" data-save=\"scene-yaml\" data-name=\"" +
            escaped(name) + ".yaml\">Save scene</button></div>\n";
    text += element("details", element("summary", escaped(name + ".yaml")) + "<pre id=\"scene-yaml\">" +
                                   escaped(files.scene_text) + "</pre>");
    return section("reproduce", "Run it again", text);
}

std::string about_section(const RunFiles& files, const PageOptions& options) {
    std::vector<std::vector<std::string>> rows;
    if (const std::string version = files.text("version", ""); !version.empty())
        rows.push_back({"Run by", "osculate " + version});
    rows.push_back({"Report by", "osculate " + options.version});
    for (const auto& [name, version] : options.libraries) rows.push_back({name, version});
    if (!files.ended.empty()) rows.push_back({"Last written by the run", files.ended});
    std::string plan;
    for (const json& part : list(files.summary, "plan"))
        if (part.is_string()) plan += (plan.empty() ? "" : ", ") + part.get<std::string>();
    std::string text = table({"Part", "Version"}, rows);
    if (!plan.empty()) text += element("p class=\"fine\"", "Parts of the run's plan: " + escaped(plan) + ".");
    return section("about", "Versions", text);
}

} // namespace osculate::report
