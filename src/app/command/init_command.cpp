#include "app/command/init_command.hpp"

#include "osculate/core/data_folder.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/scene/nearest.hpp"
#include "osculate/scene/reader.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <vector>

namespace osculate::app {

namespace {

namespace fs = std::filesystem;

fs::path folder() {
    const char* given = std::getenv("OSCULATE_TUTORIALS");
    return given != nullptr && *given != 0 ? given : data_folder("configs/tutorials");
}

std::vector<std::string> names() {
    std::vector<std::string> list;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder(), ignored))
        if (entry.path().extension() == ".yaml") list.push_back(entry.path().stem().string());
    std::ranges::sort(list);
    return list;
}

[[noreturn]] void refuse(const std::string& what, const std::string& expected, const std::string& found,
                         const std::string& nearest = {}) {
    Fault fault;
    fault.file = what;
    fault.expected = expected;
    fault.found = found;
    fault.nearest = nearest;
    throw SceneError({fault});
}

bool is_modeline(const std::string& line) {
    return line.starts_with("# yaml-language-server:");
}

/// First sentence of the comment that a tutorial begins with.
std::string subject(const fs::path& path) {
    std::istringstream text(file_content(path));
    std::string sentence;
    for (std::string line; std::getline(text, line) && line.starts_with("#");) {
        if (is_modeline(line)) continue;
        sentence += (sentence.empty() ? "" : " ") + line.substr(std::min<std::size_t>(2, line.size()));
        for (std::size_t i = 0; i + 1 < sentence.size(); ++i)
            if (sentence[i] == '.' && sentence[i + 1] == ' ') return sentence.substr(0, i + 1);
    }
    return sentence;
}

std::string with(std::string text, const std::string& shipped, const std::string& file) {
    for (std::size_t at = 0; (at = text.find(shipped, at)) != std::string::npos; at += file.size())
        text.replace(at, shipped.size(), file);
    return text;
}

/// A tutorial for a folder of its own: its schema is named by where that is, or not at all; it is run by its new name.
std::string adapted(std::string text, const std::string& name, const std::string& file) {
    if (is_modeline(text)) {
        const std::size_t end = text.find('\n');
        const fs::path schema = (folder() / text.substr(0, end).substr(text.find('=') + 1)).lexically_normal();
        text.erase(0, end + 1);
        if (fs::exists(schema)) text.insert(0, "# yaml-language-server: $schema=" + schema.string() + "\n");
    }
    return with(std::move(text), "configs/tutorials/" + name + ".yaml", file);
}

void copy(const std::string& text, const fs::path& to) {
    if (fs::exists(to)) refuse(to.string(), "a file that is not there yet: nothing is overwritten", "a file");
    std::error_code failed;
    if (to.has_parent_path()) fs::create_directories(to.parent_path(), failed);
    std::ofstream out(to, std::ios::binary);
    out << text << std::flush;
    if (!out) refuse(to.string(), "a file that can be written", "none");
}

} // namespace

std::string tutorial_list() {
    const std::vector<std::string> known = names();
    std::size_t width = 0;
    for (const std::string& name : known) width = std::max(width, name.size());
    std::string text;
    for (const std::string& name : known)
        text += fmt::format("{:{}}  {}\n", name, width, subject(folder() / (name + ".yaml")));
    return text;
}

std::string init_scene(const std::string& name, const std::string& file) {
    const std::vector<std::string> known = names();
    if (std::ranges::count(known, name) == 0)
        refuse("init", fmt::format("a tutorial: {}", fmt::join(known, ", ")), name.empty() ? "none" : "'" + name + "'",
               scene::nearest(name, known));
    const fs::path from = folder() / (name + ".yaml"), to = file.empty() ? name + ".yaml" : file;
    std::map<fs::path, fs::path> meshes; // copy -> source; bodies may share one
    for (const auto& [body, spec] : scene::read_scene(from.string()).bodies)
        std::visit(
            [&](const auto& source) {
                if constexpr (requires { source.path; })
                    meshes.emplace(to.parent_path() / fs::relative(source.path, folder()), source.path);
            },
            spec.mesh.source);
    for (const auto& [mesh, source] : meshes)
        if (fs::exists(mesh)) refuse(mesh.string(), "a mesh that is not there yet: nothing is overwritten", "a file");
    std::string adjusted = adapted(file_content(from), name, to.string());
    for (const auto& [mesh, source] : meshes)
        adjusted =
            with(std::move(adjusted), "configs/tutorials/" + fs::relative(source, folder()).string(), mesh.string());
    copy(adjusted, to);
    std::string text = fmt::format("{} written", to.string());
    for (const auto& [mesh, source] : meshes) {
        copy(file_content(source), mesh);
        text += fmt::format(", its mesh {}", mesh.string());
    }
    return text + fmt::format("; run it: osculate run {}\n", to.string());
}

} // namespace osculate::app
