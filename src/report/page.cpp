#include "osculate/report/page.hpp"

#include "osculate/core/escaped.hpp"
#include "osculate/core/without_traps.hpp"
#include "osculate/output/post_mortem_file.hpp"
#include "osculate/report/picture.hpp"
#include "osculate/scene/outline.hpp"
#include "report/assets.hpp"
#include "report/html.hpp"
#include "report/page_data.hpp"
#include "report/run_files.hpp"
#include "report/scene_section.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace osculate::report {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Replaces {{name}} by what is given for it, once: what is put in is not looked at again.
std::string filled(std::string_view form, const std::map<std::string, std::string, std::less<>>& parts) {
    std::string text;
    for (std::size_t at = 0; at < form.size();) {
        const std::size_t open = form.find("{{", at), close = form.find("}}", open);
        if (open == std::string_view::npos || close == std::string_view::npos) {
            text += form.substr(at);
            break;
        }
        text += form.substr(at, open - at);
        const auto part = parts.find(form.substr(open + 2, close - open - 2));
        if (part != parts.end()) text += part->second;
        at = close + 2;
    }
    return text;
}

double member(const json& object, const char* name) {
    const auto at = object.find(name);
    return at != object.end() && at->is_number() ? at->get<double>() : std::nan("");
}

json object(const json& parent, const char* name) {
    const auto at = parent.find(name);
    return at != parent.end() && at->is_object() ? *at : json::object();
}

json list(const json& parent, const char* name) {
    const auto at = parent.find(name);
    return at != parent.end() && at->is_array() ? *at : json::array();
}

std::string word(const json& object, const char* name) {
    const auto at = object.find(name);
    return at != object.end() && at->is_string() ? at->get<std::string>() : "";
}

struct Status {
    std::string badge, mood; ///< mood: a class of the style sheet
};

Status status_of(const RunFiles& files) {
    const std::string status = files.status();
    if (status == "done") {
        const json expectation = object(files.summary, "expectation");
        if (expectation.contains("met") && expectation["met"] == false) return {"Completed, not as expected", "warn"};
        return {"Completed", "good"};
    }
    if (status == "gave_up") return {"Gave up", "bad"};
    if (status == "interrupted") return {"Interrupted: osculate resume goes on", "warn"};
    if (status == "running") return {"Not finished: it still runs, or was ended from outside", "warn"};
    return {"Status unknown", "warn"};
}

std::string duration(double seconds) {
    if (!std::isfinite(seconds)) return "–";
    if (seconds < 100) return fmt::format("{:.3g} s", seconds);
    const long whole = std::lround(seconds);
    return whole < 3600 ? fmt::format("{} min {:02} s", whole / 60, whole % 60)
                        : fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

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
            (member(steps, "rejected") == 1 ? " attempt rejected" : " attempts rejected"));
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
        {"penetration", "Deepest slave node below its master, in facet sizes"},
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
    std::vector<std::vector<std::string>> rows{
        {"Wall time, CPU time", duration(total) + ", " + duration(member(seconds, "cpu"))},
        {"Threads", count(files.number("threads"))},
        {"Peak memory", figure(files.number("peak_memory_bytes") / 1e6) + " MB"},
        {"Factorisations", count(files.number("factorisations"))},
        {"GMRES iterations", count(files.number("gmres_iterations"))}};
    text += table({"Cost", ""}, rows, {1});
    return section("cost", "Time and memory", text);
}

/// Values of keys that name files.
void add_files(const scene::OutlineItem& item, std::vector<std::string>& files) {
    if (item.key == "path" || item.key == "file") files.push_back(item.text);
    for (const scene::OutlineItem& one : item.items) add_files(one, files);
}

std::string reproduce_section(const RunFiles& files) {
    if (files.scene_text.empty()) return "";
    const std::string name = files.name();
    const double threads = files.number("threads");
    const std::string command = fmt::format("osculate run {0}.yaml -o out/{0} --threads {1}", name,
                                            std::isfinite(threads) ? std::lround(threads) : 1);
    std::string text = element("p", "Save the scene below as " + element("code", escaped(name + ".yaml")) +
                                        ". It is the scene as it was run: every default and every change given by " +
                                        element("code", "--set") + " is in it. Then");
    text += "<pre class=\"command\"><code id=\"command\">" + escaped(command) + "</code></pre>\n";
    const std::string version = files.text("version", "");
    std::string after = "gives the same numbers with any number of threads";
    if (!version.empty()) after += ", with osculate " + escaped(version);
    if (files.scene) {
        std::vector<std::string> meshes;
        add_files(scene::outline(*files.scene), meshes);
        if (!meshes.empty()) after += ". It reads meshes from files, which the report does not hold: ";
        for (std::size_t m = 0; m < meshes.size(); ++m)
            after += (m > 0 ? ", " : "") + element("code", escaped(meshes[m]));
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

std::string notes_section(const std::vector<std::string>& notes) {
    if (notes.empty()) return "";
    std::string items;
    for (const std::string& note : notes) items += element("li", escaped(note));
    return section("notes", "What this report leaves out", element("ul", items));
}

/// What to try first, then all that was found.
std::string failure_section(const RunFiles& files) {
    const std::string failure = files.text("failure", "");
    if (failure.empty() && !files.post_mortem) return "";
    std::string text = failure.empty() ? "" : element("p class=\"lead\"", escaped(failure));
    if (files.post_mortem) {
        std::string advice;
        for (const auto& [key, what] : files.post_mortem->advice)
            advice += element("li", element("code", escaped(key)) + " " + escaped(what));
        if (!advice.empty()) text += element("h3", "What to try") + element("ul", advice);
        text += element("details", element("summary", "Everything that was found") +
                                       element("pre", escaped(output::in_words(*files.post_mortem))));
    }
    if (files.failed_iterate)
        text += element("p class=\"fine\"", "The last iterate is in the folder " + element("code", "failed") +
                                                " of the run, for ParaView.");
    return section("post-mortem", files.status() == "interrupted" ? "Why the run ended" : "Why the run gave up", text);
}

/// Start, middle and end; nothing where the bodies cannot be drawn.
std::string pictures_section(const MovingSurfaces& surfaces, Page& page) {
    PictureOptions options;
    options.field = field_to_show(surfaces);
    std::string figures;
    const std::size_t last = surfaces.times.empty() ? 0 : surfaces.times.size() - 1;
    std::vector<std::pair<const char*, std::size_t>> moments{{"start", 0}, {"middle", last / 2}, {"end", last}};
    if (last < 2) moments.erase(moments.begin() + 1);
    if (last == 0) moments.resize(1);
    for (const auto& [name, frame] : moments) {
        const Bytes png = draw(surfaces, frame, options);
        if (png.empty()) {
            page.notes.emplace_back("There are no pictures: the frames hold no displacement of the bodies.");
            return "";
        }
        const std::string time = scene::engineering(std::stod(fmt::format("{:.4g}", surfaces.times[frame])), "s");
        page.pictures.emplace_back(std::string(name) + ".png", std::string(png.begin(), png.end()));
        page.pictures.emplace_back(std::string(name) + ".svg",
                                   with_legend(png, options, std::string(name) + ", " + time));
        figures += fmt::format("<figure><img alt=\"The bodies at {0}\" src=\"data:image/png;base64,{1}\">"
                               "<figcaption><b>{2}</b> {0}</figcaption></figure>\n",
                               escaped(time), base64(png), name);
    }
    std::string legend;
    if (!options.field.name.empty())
        legend =
            element("p class=\"legend\"",
                    "<span>" + measure(options.field.low, options.field.unit) + "</span><i class=\"map\"></i><span>" +
                        measure(options.field.high, options.field.unit) + "</span> " +
                        escaped(options.field.name == "von_mises" ? "von Mises stress" : options.field.name) +
                        "; displacements are drawn true to scale");
    return section("pictures", "Pictures", "<div class=\"pictures\">" + figures + "</div>" + legend);
}

std::string charts(const char* id, const char* title) {
    return section(id, title, fmt::format("<div class=\"charts\" data-charts=\"{}\"></div>\n", id));
}

std::string gradient() {
    std::string stops;
    for (const auto& c : colour_map())
        stops += fmt::format("{}rgb({},{},{})", stops.empty() ? "" : ",", c[0], c[1], c[2]);
    return ":root{--map:linear-gradient(to right," + stops + ")}";
}

json stage_ends(const RunFiles& files) {
    json stages = json::array();
    double end = 0;
    if (files.scene)
        for (const auto& [name, stage] : files.scene->stages) {
            end += stage.duration;
            stages.push_back({{"name", name}, {"end", end}});
        }
    return stages;
}

/// The scripts as one module each, found by name without any request.
std::string scripts(bool three) {
    std::string text;
    const auto library = [&](const char* name) { text += "<script>" + std::string(asset(name)) + "</script>\n"; };
    if (three) {
        library("three.min.js");
        library("OrbitControls.js");
    }
    if (!asset("d3.min.js").empty()) library("d3.min.js");
    std::string imports;
    for (const Asset& one : assets()) {
        if (!one.name.ends_with(".mjs")) continue;
        imports +=
            fmt::format("{}\"{}\":\"data:text/javascript;base64,{}\"", imports.empty() ? "" : ",\n",
                        one.name.substr(0, one.name.size() - 4), base64(Bytes(one.content.begin(), one.content.end())));
    }
    text += "<script type=\"importmap\">{\"imports\":{" + imports + "}}</script>\n";
    return text + "<script type=\"module\">import \"main\";</script>\n";
}

/// Contact surfaces move with their bodies, which the scene names.
void name_bodies(MovingSurfaces& surfaces, const RunFiles& files) {
    if (!files.scene) return;
    for (MovingPart& part : surfaces.parts) {
        const scene::Pair* pair = part.kind == PartKind::body ? nullptr : scene::find(files.scene->contact, part.name);
        if (pair == nullptr) continue;
        const scene::SetSpec* set =
            scene::find(files.scene->sets, part.kind == PartKind::slave ? pair->slave : pair->master.set);
        if (set != nullptr) part.body = set->body;
    }
}

double last_time(const RunFiles& files, const PageOptions& options) {
    for (auto a = options.attempts.rbegin(); a != options.attempts.rend(); ++a)
        if (a->verdict == time::Verdict::accept) return a->time;
    return files.history ? files.history->columns.front().back() : std::nan("");
}

bool has_columns(const RunFiles& files, const std::string& start) {
    return files.history &&
           std::ranges::any_of(files.history->names, [&](const std::string& name) { return name.starts_with(start); });
}

/// Places for the plots of what the run has; their data go to `data`.
std::string plots_of(const RunFiles& files, const PageOptions& options, PageData& data,
                     std::vector<std::string>& notes) {
    std::string plots;
    if (!files.plots.empty()) {
        data.add_plots(files.plots);
        plots += charts("plots", "Plots of the scene");
    }
    if (files.history) data.add_table("history", *files.history, notes);
    if (has_columns(files, "pair."))
        plots += charts("contact", "Contact");
    else if (files.history && !list(files.summary, "pairs").empty())
        notes.emplace_back("history.csv holds no columns of contact pairs (output.history).");
    if (has_columns(files, "set.")) plots += charts("reactions", "Reactions");
    if (has_columns(files, "energy.")) plots += charts("energies", "Energies and momenta");
    if (!options.attempts.empty()) {
        data.add_attempts(options.attempts, notes);
        plots += charts("steps", "Steps and iterations");
    }
    if (files.iterations) {
        data.add_table("iterations", *files.iterations, notes);
        plots += charts("residuals", "Residuals");
    }
    return plots;
}

} // namespace

Page make_page(const fs::path& run_folder, const PageOptions& options) {
    const WithoutTraps values_may_be_no_numbers;
    Page page;
    const RunFiles files = read_run_files(run_folder);
    page.notes = files.notes;
    page.notes.insert(page.notes.end(), options.notes.begin(), options.notes.end());
    if (files.status() == "running")
        page.notes.insert(page.notes.begin(),
                          "The run had not ended when this report was written: it shows what there was.");

    MovingSurfaces surfaces = read_moving_surfaces(run_folder, options.frames);
    name_bodies(surfaces, files);
    page.notes.insert(page.notes.end(), surfaces.notes.begin(), surfaces.notes.end());
    const bool frames = !surfaces.times.empty();
    const bool three = frames && !asset("three.min.js").empty() && !asset("OrbitControls.js").empty();
    if (frames && !three)
        page.notes.emplace_back("There is no three-dimensional view: this program was built without three.js "
                                "(Debian: libjs-three).");
    const bool drawing = !asset("d3.min.js").empty();
    if (!drawing)
        page.notes.emplace_back(
            "There are no plots in this page: this program was built without d3 (Debian: libjs-d3).");

    PageData data;
    data.json["name"] = files.name();
    data.json["stages"] = stage_ends(files);
    const std::string plots = drawing ? plots_of(files, options, data, page.notes) : "";

    const Status status = status_of(files);
    std::string body;
    body += failure_section(files);
    std::string pictures; // of all frames, before any are thinned out
    try {
        pictures = pictures_section(surfaces, page);
    } catch (const std::exception& error) {
        page.notes.push_back(std::string("There are no pictures: ") + error.what() + ".");
    }
    if (three) {
        data.add_view(surfaces, options.largest_view, page.notes);
        body += section("view", "In three dimensions",
                        "<div id=\"viewer\"><noscript>The view needs scripts.</noscript></div>\n");
    }
    body += pictures + scene_section(files) + mesh_section(files) + plots;
    if (!options.diary.empty()) body += section("diary", "Diary", element("pre", escaped(options.diary)));
    body += checks_section(files) + cost_section(files) + reproduce_section(files) + about_section(files, options) +
            notes_section(page.notes);

    const std::string description = files.scene ? files.scene->description : "";
    page.html = filled(asset("page.html"), {{"title", escaped(files.name())},
                                            {"description", escaped(description)},
                                            {"status", escaped(status.badge)},
                                            {"mood", status.mood},
                                            {"ended", escaped(files.ended)},
                                            {"figures", key_figures(files, last_time(files, options))},
                                            {"style", gradient() + std::string(asset("style.css"))},
                                            {"sections", body},
                                            {"licences", escaped(asset("licences.txt"))},
                                            {"data", data.html()},
                                            {"scripts", scripts(three)}});
    return page;
}

} // namespace osculate::report
