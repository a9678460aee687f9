#include "scene/study_reader.hpp"

#include "osculate/scene/nearest.hpp"
#include "osculate/scene/study.hpp"
#include "scene/describe_parts.hpp"
#include "scene/files_like.hpp"
#include "scene/flow_text.hpp"
#include "scene/study_checks.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace osculate::scene {

namespace fs = std::filesystem;

void StudyReader::text(const char* name, const char* what, StudyText& value) {
    const Key key{.name = name};
    const Tree* tree = reader_.take(key, what);
    if (!tree) return;
    if (tree->kind != Tree::Kind::scalar) return reader_.fault(*tree, key, what);
    value = {tree->scalar, tree->place.line, tree->place.column};
}

void StudyReader::settings(const Tree* map, std::vector<StudySetting>& list) {
    if (!map || map->kind == Tree::Kind::null) return;
    if (map->kind != Tree::Kind::map) return reader_.fault(*map, {.name = "set"}, "a map from key paths to values");
    for (const Tree& child : map->children)
        list.push_back({{child.key, flow_text(child)}, child.key_place.line, child.key_place.column});
}

std::string StudyReader::scene_path(const Tree& tree) {
    const Key key{.name = "scene"};
    if (tree.kind != Tree::Kind::scalar || tree.scalar.empty()) {
        reader_.fault(tree, key, "a scene file");
        return {};
    }
    const fs::path path = (fs::absolute(study_.path).parent_path() / tree.scalar).lexically_normal();
    std::error_code none;
    if (!fs::is_regular_file(path, none)) reader_.fault(tree, key, "a scene file that exists");
    return path.string();
}

int StudyReader::axis_named(const Tree& at, const Key& key) {
    Words names;
    for (const StudyAxis& axis : study_.axes) names.push_back(axis.name);
    const auto found = std::ranges::find(names, at.scalar);
    if (at.kind == Tree::Kind::scalar && found != names.end()) return static_cast<int>(found - names.begin());
    reader_.fault(at, key, "one of the axes " + join(names), {}, nearest(at.scalar, names));
    return -1;
}

void StudyReader::leave_out(const Tree& list) {
    const Key key{.name = "leave_out"};
    const char* expected = "a list of maps from axes to values";
    if (list.kind != Tree::Kind::list) return reader_.fault(list, key, expected);
    for (const Tree& item : list.children) {
        if (item.kind != Tree::Kind::map) {
            reader_.fault(item, key, expected);
            continue;
        }
        std::vector<std::vector<std::size_t>> rule(study_.axes.size());
        bool complete = true;
        for (const Tree& child : item.children) {
            const int a = axis_named({.kind = Tree::Kind::scalar, .scalar = child.key, .place = child.key_place}, key);
            complete = complete && a >= 0;
            if (a < 0) continue;
            const StudyAxis& axis = study_.axes[static_cast<std::size_t>(a)];
            Words names;
            for (const AxisValue& value : axis.values) names.push_back(value.name);
            const auto add = [&](const Tree& value) {
                const std::string name = value.kind == Tree::Kind::scalar && std::ranges::count(names, value.scalar) > 0
                                             ? value.scalar
                                             : name_of_value(flow_text(value));
                const auto at = std::ranges::find(names, name);
                if (at == names.end()) {
                    complete = false;
                    return reader_.fault(value, {.name = "leave_out." + axis.name}, "one of " + join(names), {},
                                         nearest(name, names));
                }
                rule[static_cast<std::size_t>(a)].push_back(static_cast<std::size_t>(at - names.begin()));
            };
            if (child.kind == Tree::Kind::list)
                std::ranges::for_each(child.children, add);
            else
                add(child);
        }
        if (complete) study_.leave_out.push_back(std::move(rule));
    }
}

void StudyReader::axis_list(const char* name, std::vector<std::size_t>& axes) {
    const Key key{.name = name};
    const Tree* list = reader_.take(key, "a list of axes");
    if (!list) return;
    if (list->kind != Tree::Kind::list) return reader_.fault(*list, key, "a list of axes");
    axes.clear();
    for (const Tree& item : list->children)
        if (const int a = axis_named(item, key); a >= 0) axes.push_back(static_cast<std::size_t>(a));
}

void StudyReader::document() {
    for (const auto& [name, value] : {std::pair{"title", &study_.title}, std::pair{"problem", &study_.problem},
                                      std::pair{"source", &study_.source}, std::pair{"defects", &study_.defects}})
        reader_.text({.name = name}, *value);
    if (const Tree* scene = reader_.take({.name = "scene"}, "a scene file")) study_.scene = scene_path(*scene);
    settings(reader_.take({.name = "set"}, "a map"), study_.settings);
    named(reader_, {.name = "constants", .names = Names::identifier, .item = "constant"}, study_.constants,
          [&](const std::string& name, StudyText& value) { text(name.c_str(), "a number or a formula", value); });
    const Key axes{.name = "axes", .required = true, .names = Names::identifier, .item = "axis"};
    Named<StudyAxis> read_axes;
    named(reader_, axes, read_axes, [&](const std::string& name, StudyAxis& value) { axis(name, value); });
    for (auto& [name, value] : read_axes) study_.axes.push_back(std::move(value));
    if (const Tree* list = reader_.take({.name = "leave_out"}, "a list")) leave_out(*list);
    Named<StudyQuantity> quantities;
    named(reader_, {.name = "quantities", .required = true, .names = Names::identifier, .item = "quantity"}, quantities,
          [&](const std::string& name, StudyQuantity& value) {
              value.name = name;
              reader_.group({.name = name}, [&] { quantity(value); });
          });
    for (auto& [name, value] : quantities) study_.quantities.push_back(std::move(value));
    const Key refine{.name = "refine"};
    if (const Tree* name = reader_.take(refine, "an axis")) study_.refine = axis_named(*name, refine);
    text("abscissa", "a formula of constants, parameters and dofs", study_.abscissa);
    reader_.text({.name = "abscissa_label"}, study_.abscissa_label);
    for (std::size_t a = 0; a < study_.axes.size() && study_.colour_by.empty(); ++a)
        if (static_cast<int>(a) != study_.refine) study_.colour_by.push_back(a);
    axis_list("problems", study_.problems);
    if (const auto both = std::ranges::find(study_.problems, static_cast<std::size_t>(study_.refine));
        study_.refine >= 0 && both != study_.problems.end())
        reader_.fault(*tree_.find("problems"), {.name = "problems"}, "axes other than that of refine",
                      "'" + study_.axes[*both].name + "'");
    plots();
    reader_.integer({.name = "repeats", .range = {.low = 1, .high = 100}}, study_.repeats);
}

Study read_study(const std::string& path, const NamedFunctions& functions, const std::vector<Override>& command_line) {
    std::vector<Fault> faults;
    const Tree tree = read_yaml(path, faults, {"problem", "defects"}); // Markdown, which study.md alone holds
    if (!faults.empty()) throw SceneError(std::move(faults));
    Study study = StudyReader(tree, path, functions, faults).read();
    check_study(study, functions, command_line, faults);
    if (!faults.empty()) throw SceneError(std::move(faults));
    return study;
}

} // namespace osculate::scene
