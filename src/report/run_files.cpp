#include "report/run_files.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/output/post_mortem_file.hpp"
#include "osculate/scene/reader.hpp"

#include <chrono>
#include <ctime>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <sys/stat.h>

namespace osculate::report {

namespace fs = std::filesystem;

namespace {

std::string time_of(const fs::path& path) {
    struct stat found {};
    if (stat(path.c_str(), &found) != 0) return "";
    std::tm parts{};
    gmtime_r(&found.st_mtime, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
    return text;
}

std::optional<output::NumberTable> read_table(const fs::path& path, const std::string& missing, RunFiles& files) {
    if (!fs::exists(path)) {
        if (!missing.empty()) files.notes.push_back(missing);
        return std::nullopt;
    }
    try {
        output::NumberTable table = output::read_numbers(path);
        if (!table.names.empty() && !table.columns.front().empty()) return table;
        files.notes.push_back(path.filename().string() + " holds no row yet.");
    } catch (const std::runtime_error& error) {
        files.notes.push_back(path.filename().string() + " cannot be read: " + error.what() + ".");
    }
    return std::nullopt;
}

/// Shows files by their names: a report is mailed, and where they lie on the machine of the run is nobody's business.
void leave_out_folders(scene::Scene& scene, std::string& text) {
    const auto shorten = [&](std::string& path) {
        if (!fs::path(path).is_absolute()) return;
        const std::string name = fs::path(path).filename().string();
        for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at + name.size()))
            text.replace(at, path.size(), name);
        path = name;
    };
    shorten(scene.output.template_name);
    for (auto& [name, body] : scene.bodies)
        std::visit(
            [&](auto& source) {
                if constexpr (requires { source.path; }) shorten(source.path);
            },
            body.mesh.source);
}

void read_scene(const fs::path& folder, RunFiles& files) {
    const fs::path path = folder / "scene.yaml";
    if (!fs::exists(path)) {
        files.notes.emplace_back(
            "scene.yaml is missing: the scene is neither described nor can it be run again from here.");
        return;
    }
    files.scene_text = file_content(path);
    try {
        files.scene = scene::read_scene(path.string());
        leave_out_folders(*files.scene, files.scene_text);
    } catch (const SceneError& error) {
        files.notes.push_back(fmt::format("scene.yaml cannot be read by this version, so that it is shown as it is: {}",
                                          error.faults().empty() ? error.what() : error.faults().front().message()));
    }
}

} // namespace

std::string RunFiles::name() const {
    return text("scene", scene ? scene->name : "run");
}

std::string RunFiles::text(const char* member, const std::string& otherwise) const {
    const auto at = summary.find(member);
    return at != summary.end() && at->is_string() ? at->get<std::string>() : otherwise;
}

double RunFiles::number(const char* member) const {
    const auto at = summary.find(member);
    return at != summary.end() && at->is_number() ? at->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

RunFiles read_run_files(const fs::path& folder) {
    RunFiles files;
    const fs::path summary = folder / "summary.json";
    if (fs::exists(summary)) {
        files.ended = time_of(summary);
        try {
            files.summary = nlohmann::json::parse(file_content(summary));
            if (!files.summary.is_object()) throw std::runtime_error("it is no object");
        } catch (const std::exception& error) {
            throw std::runtime_error("cannot read " + summary.string() + ": " + error.what());
        }
    } else {
        files.notes.emplace_back("summary.json is missing: sizes, checks and costs are not known.");
    }
    read_scene(folder, files);
    files.history =
        read_table(folder / "history.csv", "history.csv is missing: there are no forces and energies to plot.", files);
    files.iterations = read_table(folder / "iterations.csv", "", files);
    if (files.scene) {
        files.plots = read_plot_files(folder, *files.scene, files.notes);
        files.paths = read_path_files(folder, *files.scene, files.notes);
    }
    if (const fs::path path = folder / output::post_mortem_file; fs::exists(path)) {
        try {
            files.post_mortem = output::read_post_mortem(path);
            files.failed_iterate = fs::exists(folder / "failed" / "series.pvd");
        } catch (const std::runtime_error& error) {
            files.notes.push_back(std::string("post_mortem.json cannot be read: ") + error.what() + ".");
        }
    }
    return files;
}

} // namespace osculate::report
