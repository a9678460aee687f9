#include "osculate/scene/reader.hpp"

#include "scene/checks.hpp"
#include "scene/describe.hpp"
#include "scene/overrides.hpp"
#include "scene/template_reader.hpp"
#include "scene/tree_reader.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <tuple>
#include <utility>

namespace osculate::scene {

namespace fs = std::filesystem;

namespace {

/// What people read of a scene, and no table or script holds.
const std::vector<std::string> texts_with_lines{"description"};

Words keys_under(const Tree& tree, const char* name) {
    Words keys;
    if (const Tree* map = tree.find(name))
        for (const Tree& child : map->children)
            if (!child.implied) keys.push_back(child.key);
    return keys;
}

/// A file's stem as a name: what does not fit into one becomes '_'.
std::string name_from(const std::string& path) {
    std::string name = fs::path(path).stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    if (name.empty() || name.front() == '-') name.insert(name.begin(), '_');
    return name;
}

void make_absolute(Scene& scene) {
    const auto from_folder = [&](std::string& path) {
        if (!path.empty()) path = (fs::path(scene.directory) / path).lexically_normal().string();
    };
    for (auto& [name, body] : scene.bodies) {
        if (auto* file = std::get_if<FileMesh>(&body.mesh.source)) from_folder(file->path);
        if (auto* cad = std::get_if<CadMesh>(&body.mesh.source)) from_folder(cad->path);
    }
}

/// By place: the scene's own file first, then templates, overrides last.
void sort_by_place(std::vector<Fault>& faults, const std::string& file) {
    const auto rank = [&](const Fault& f) { return f.file == file ? 0 : f.file == override_file ? 2 : 1; };
    std::ranges::stable_sort(faults, [&](const Fault& a, const Fault& b) {
        return std::tuple(rank(a), a.line, a.column) < std::tuple(rank(b), b.line, b.column);
    });
}

/// Pairs that general contact finds have no frames of their own: what is asked of slaves is asked of bodies, too.
void ask_bodies_what_slaves_are_asked(Output& output) {
    constexpr std::pair<const char*, const char*> same[] = {{"gap", "contact_gap"},
                                                            {"contact_force", "contact_force"},
                                                            {"normal_stress", "contact_pressure"},
                                                            {"slip", "contact_slip"},
                                                            {"status", "contact_status"}};
    for (const auto& [of_slaves, of_bodies] : same)
        if (std::ranges::count(output.slave_fields, of_slaves) > 0 &&
            std::ranges::count(output.body_fields, of_bodies) == 0)
            output.body_fields.emplace_back(of_bodies);
}

Scene build(Tree tree, const std::string& file, const fs::path& directory, const std::vector<Override>& overrides,
            std::vector<Fault> faults) {
    expand_short_forms(tree, faults);
    for (const Override& change : overrides) apply(change, tree, faults);
    expand_short_forms(tree, faults); // those of overrides

    Scene scene;
    scene.name = name_from(file);
    scene.directory = directory.string();
    KnownNames names{keys_under(tree, "bodies"), keys_under(tree, "sets"), keys_under(tree, "contact"),
                     keys_under(tree, "couplings")};
    std::erase(names.pairs, "general"); // no pair
    const std::string template_name = read_template(tree, directory, names, scene.output, faults);
    TreeReader reader(names, faults);
    reader.read(tree, [&] { describe(reader, scene); });
    scene.output.template_name = template_name;
    make_absolute(scene);
    check_rules(scene, tree, faults);
    if (!faults.empty()) {
        sort_by_place(faults, file);
        throw SceneError(std::move(faults));
    }
    if (scene.general) ask_bodies_what_slaves_are_asked(scene.output);
    return scene;
}

/// What cannot be parsed cannot be judged: a fault of the syntax stands alone.
void throw_unreadable(const Tree& tree, std::vector<Fault>& faults) {
    if (tree.kind == Tree::Kind::null && !faults.empty()) throw SceneError(std::move(faults));
}

} // namespace

Scene read_scene(const std::string& path, const std::vector<Override>& overrides) {
    std::vector<Fault> faults;
    Tree tree = read_yaml(path, faults, texts_with_lines);
    throw_unreadable(tree, faults);
    const fs::path directory = fs::absolute(path).lexically_normal().parent_path();
    return build(std::move(tree), path, directory, overrides, std::move(faults));
}

Scene parse_scene(const std::string& yaml_text, const std::string& name, const std::vector<Override>& overrides) {
    std::vector<Fault> faults;
    Tree tree = parse_yaml(yaml_text, name, faults, texts_with_lines);
    throw_unreadable(tree, faults);
    return build(std::move(tree), name, fs::current_path(), overrides, std::move(faults));
}

} // namespace osculate::scene
