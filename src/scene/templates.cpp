#include "scene/templates.hpp"

#include "osculate/core/data_folder.hpp"

#include <cstdlib>
#include <set>

namespace osculate::scene {

namespace fs = std::filesystem;

namespace {

struct Folder {
    fs::path path;
    bool shipped;
};

std::vector<Folder> template_folders(const fs::path& directory) {
    std::vector<Folder> folders;
    for (fs::path folder = directory;; folder = folder.parent_path()) {
        folders.push_back({folder / "output_templates", false});
        if (folder == folder.parent_path()) break;
    }
    if (const char* given = std::getenv("OSCULATE_TEMPLATES"); given && *given) folders.push_back({given, true});
    folders.push_back({data_folder("output_templates"), true});
    return folders;
}

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// A scene may bear a template's name and lie in the same folder as the scene that asks for it.
bool is_scene(const fs::path& path) {
    std::vector<Fault> ignored;
    return read_yaml(path.string(), ignored).find("bodies") != nullptr;
}

} // namespace

std::optional<TemplateFile> find_template(const std::string& name, const fs::path& directory) {
    if (name.ends_with(".yaml")) {
        const fs::path path = fs::path(name).is_absolute() ? fs::path(name) : directory / name;
        if (is_file(path)) return TemplateFile{path.lexically_normal(), false};
        return std::nullopt;
    }
    if (name.empty() || fs::path(name).has_parent_path()) return std::nullopt;
    const std::string file = name + ".yaml";
    if (const fs::path beside = directory / file; is_file(beside) && !is_scene(beside))
        return TemplateFile{beside.lexically_normal(), false};
    const std::vector<Folder> folders = template_folders(directory);
    for (const Folder& folder : folders) {
        const fs::path path = folder.path / file;
        if (!is_file(path)) continue;
        std::error_code ignored;
        bool shipped = folder.shipped;
        for (const Folder& other : folders)
            shipped = shipped || (other.shipped && fs::equivalent(other.path, folder.path, ignored));
        return TemplateFile{path.lexically_normal(), shipped};
    }
    return std::nullopt;
}

std::vector<std::string> known_templates(const fs::path& directory) {
    std::set<std::string> names;
    for (const Folder& folder : template_folders(directory)) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder.path, ignored))
            if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
    }
    return {names.begin(), names.end()};
}

} // namespace osculate::scene
