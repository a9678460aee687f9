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
#include "report/summary_json.hpp"
#include "report/summary_sections.hpp"

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

struct Status {
    std::string badge, mood; ///< mood: a class of the style sheet
};

Status status_of(const RunFiles& files, bool live) {
    const std::string status = files.status();
    if (live && status == "running") return {"Runs", "warn"};
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
        if (const std::string& why = files.post_mortem->no_remedy; !why.empty())
            advice += element("li", "No remedy is known: " + escaped(why));
        for (const time::Advice& one : files.post_mortem->advice) {
            std::string item = element("code", escaped(one.key)) + " " + escaped(one.text);
            for (const std::string& change : one.set) item += " " + element("code", escaped("--set '" + change + "'"));
            advice += element("li", item);
        }
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
std::string scripts(bool three, bool live) {
    std::string text;
    const auto library = [&](const char* name) { text += "<script>" + std::string(asset(name)) + "</script>\n"; };
    if (three) {
        library("three.min.js");
        library("OrbitControls.js");
    }
    if (!asset("d3.min.js").empty()) library("d3.min.js");
    std::string imports;
    for (const Asset& one : assets()) {
        if (!one.name.ends_with(".mjs") || (one.name == "live.mjs" && !live)) continue;
        imports +=
            fmt::format("{}\"{}\":\"data:text/javascript;base64,{}\"", imports.empty() ? "" : ",\n",
                        one.name.substr(0, one.name.size() - 4), base64(Bytes(one.content.begin(), one.content.end())));
    }
    text += "<script type=\"importmap\">{\"imports\":{" + imports + "}}</script>\n";
    return text + "<script type=\"module\">import \"main\";</script>\n";
}

std::string live_tag(const PageOptions& options) {
    if (!options.live) return "";
    return fmt::format("<meta name=\"osculate-live\" content=\"{}\" data-stamp=\"{}\">\n", options.live->token,
                       options.live->stamp);
}

/// Contact surfaces move with their bodies, which the scene names.
void name_bodies(MovingSurfaces& surfaces, const RunFiles& files) {
    if (!files.scene) return;
    for (MovingPart& part : surfaces.parts) {
        const scene::Pair* pair = part.kind == PartKind::body ? nullptr : scene::find(files.scene->contact, part.name);
        if (pair == nullptr) continue;
        if (part.kind == PartKind::master && !pair->master.rigid_surface.empty())
            part.body = pair->master.rigid_surface;
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
    if (!files.paths.empty()) {
        data.add_paths(files.paths, notes);
        plots += charts("paths", "Along paths");
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
    if (files.status() == "running" && !options.live)
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

    const Status status = status_of(files, options.live.has_value());
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
                                            {"live", live_tag(options)},
                                            {"scripts", scripts(three, options.live.has_value())}});
    return page;
}

} // namespace osculate::report
