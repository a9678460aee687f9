#include "osculate/scene/nearest.hpp"
#include "osculate/scene/study.hpp"
#include "scene/describe_parts.hpp"
#include "scene/files_like.hpp"
#include "scene/flow_text.hpp"
#include "scene/study_checks.hpp"
#include "scene/tree_reader.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace osculate::scene {

namespace {

namespace fs = std::filesystem;

class StudyReader {
public:
    StudyReader(const Tree& tree, std::string path, const NamedFunctions& functions, std::vector<Fault>& faults)
        : tree_(tree), functions_(functions), faults_(faults), reader_(names_, faults) {
        study_.path = std::move(path);
        study_.name = study_.title = fs::path(study_.path).stem().string();
    }

    Study read() {
        reader_.read(tree_, [&] { document(); });
        return std::move(study_);
    }

private:
    void document();
    void axis(const std::string& name, StudyAxis& axis);
    void listed_values(const Tree& key, StudyAxis& axis);
    void named_value(const Tree& entry, StudyAxis& axis);
    void scene_files(const Tree& pattern, StudyAxis& axis);
    void compare_parameters(const Tree& at, const StudyAxis& axis);
    void leave_out(const Tree& list);
    void quantity(StudyQuantity& q);
    void axis_list(const char* name, std::vector<std::size_t>& axes);

    void text(const char* name, const char* what, StudyText& value);
    void settings(const Tree* map, std::vector<StudySetting>& list);
    [[nodiscard]] std::string scene_path(const Tree& tree);
    /// Index of the axis a tree names, or -1 with a fault.
    int axis_named(const Tree& at, const Key& key);
    void name_fault(const Tree& at, const std::string& key, const std::string& expected) {
        faults_.push_back(fault_at(at.key_place, key, expected, "'" + at.key + "'"));
    }

    const Tree& tree_;
    const NamedFunctions& functions_;
    std::vector<Fault>& faults_;
    const KnownNames names_{};
    TreeReader reader_;
    Study study_;
};

constexpr const char* variable_rule = "a name of letters, digits and _ that formulas do not know yet";

/// Whether the name of an axis' value is fit for a folder's name.
bool fits_value(const std::string& name) {
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; };
    return std::ranges::all_of(name, fits) && !name.starts_with('.');
}

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

void StudyReader::listed_values(const Tree& key, StudyAxis& axis) {
    const Key list{.name = "values", .required = true};
    const Tree* values = reader_.take(list, "a list of values");
    if (key.kind != Tree::Kind::scalar || key.scalar.empty())
        reader_.fault(key, {.name = "key"}, "a key path of the scene");
    if (!values) return;
    if (values->kind != Tree::Kind::list || values->children.empty())
        return reader_.fault(*values, list, "a list of values");
    bool numbers = true;
    for (const Tree& item : values->children) {
        const std::string value = flow_text(item);
        const ParsedFormula number = parse_formula(item.kind == Tree::Kind::scalar ? item.scalar : "", {});
        numbers = numbers && number.problem.empty();
        axis.values.push_back(
            {name_of_value(value), "", {{{key.scalar, value}, item.place.line, item.place.column}}, {}});
        if (numbers) axis.values.back().parameters.emplace_back(axis.name, number.function({}));
    }
    if (!numbers)
        for (AxisValue& value : axis.values) value.parameters.clear();
}

void StudyReader::named_value(const Tree& entry, StudyAxis& axis) {
    AxisValue value{entry.key, "", {}, {}};
    if (!fits_value(entry.key)) name_fault(entry, "axes." + axis.name, "a name of letters, digits, _, - and .");
    reader_.group({.name = entry.key}, [&] {
        settings(reader_.take({.name = "set"}, "a map"), value.settings);
        if (const Tree* scene = reader_.take({.name = "scene"}, "a scene file")) value.scene = scene_path(*scene);
        const Key key{.name = "parameters"};
        const Tree* parameters = reader_.take(key, "a map from names to numbers");
        if (!parameters) return;
        if (parameters->kind != Tree::Kind::map) return reader_.fault(*parameters, key, "a map from names to numbers");
        for (const Tree& child : parameters->children) {
            if (!is_variable_name(child.key, functions_)) name_fault(child, "parameters", variable_rule);
            const ParsedFormula number = parse_formula(child.scalar, {}, functions_);
            if (number.problem.empty())
                value.parameters.emplace_back(child.key, number.function({}));
            else
                reader_.fault(child, {.name = "parameters." + child.key}, "a number",
                              child.found() + " (" + number.problem + ")", number.nearest);
        }
    });
    axis.values.push_back(std::move(value));
}

void StudyReader::scene_files(const Tree& pattern, StudyAxis& axis) {
    const Key key{.name = "scenes"};
    const std::vector<fs::path> files =
        files_like((fs::absolute(study_.path).parent_path() / pattern.scalar).lexically_normal());
    for (const fs::path& file : files) {
        const std::string name = file.stem().string();
        if (!fits_value(name))
            reader_.fault(pattern, key, "files whose names are made of letters, digits, _, - and .",
                          "'" + file.filename().string() + "'");
        axis.values.push_back({name, file.string(), {}, {}});
    }
    if (files.empty()) reader_.fault(pattern, key, "scene files, * and ? in their name");
}

void StudyReader::compare_parameters(const Tree& at, const StudyAxis& axis) {
    const auto names = [](const AxisValue& value) {
        Words list;
        for (const auto& [name, number] : value.parameters) list.push_back(name);
        std::ranges::sort(list);
        return list;
    };
    for (const AxisValue& value : axis.values) {
        if (names(value) != names(axis.values.front()))
            reader_.fault(at, {.name = axis.name},
                          "the same parameters for all values: " + join(names(axis.values.front())),
                          value.name + " with " + (value.parameters.empty() ? "none" : join(names(value))));
        if (value.name.empty() || std::ranges::count(axis.values, value.name, &AxisValue::name) > 1)
            reader_.fault(at, {.name = axis.name}, "values that make names of their own", "'" + value.name + "'");
    }
}

void StudyReader::axis(const std::string& name, StudyAxis& axis) {
    axis.name = name;
    const Tree* axes = tree_.find("axes");
    const Tree* here = axes->find(name);
    if (!is_variable_name(name, functions_)) name_fault(*here, "axes", variable_rule);
    const std::size_t before = faults_.size();
    reader_.group({.name = name}, [&] {
        if (const Tree* key = here->find("key"); key && key->kind != Tree::Kind::map) {
            reader_.take({.name = "key"}, "");
            listed_values(*key, axis);
            return;
        }
        if (const Tree* pattern = here->find("scenes"); pattern && pattern->kind == Tree::Kind::scalar) {
            reader_.take({.name = "scenes"}, "");
            scene_files(*pattern, axis);
            return;
        }
        for (const Tree& entry : here->children) named_value(entry, axis);
    });
    if (axis.values.empty() && faults_.size() == before)
        reader_.fault(*here, {.name = name}, "key and values, scenes, or a map of values", here->found());
    if (faults_.size() == before) compare_parameters(*here, axis);
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

void StudyReader::quantity(StudyQuantity& q) {
    reader_.text({.name = "unit", .meaning = ""}, q.unit);
    q.label = q.name;
    reader_.text({.name = "label", .meaning = ""}, q.label);
    const Tree& here = *tree_.find("quantities")->find(q.name);
    Words sources;
    for (const char* source : {"contact", "body", "history"})
        if (here.find(source)) sources.emplace_back(source);
    if (sources.size() > 1)
        reader_.fault(here, {.name = q.name}, "only one of contact, body, history", join(sources, " and "));
    std::string pair, body;
    reader_.text({.name = "contact"}, pair);
    reader_.text({.name = "body"}, body);
    StudyText row;
    text("history", "a formula of the columns of history.csv", row);
    q.source = !pair.empty()   ? RowSource::contact
               : !body.empty() ? RowSource::body
               : !row.empty()  ? RowSource::history
                               : RowSource::summary;
    q.part = pair + body;
    text("value", "a formula", q.value);
    text("of", "a formula of a row", q.of);
    text("exact", "a formula of a row", q.exact);
    text("where", "a formula of a row", q.where);
    text("order_by", "a formula of a row", q.order_by);
    text("scale", "a formula of numbers", q.scale);
    text("reference", "a formula of numbers, or finest", q.reference);
    static const Words reductions{"last", "first", "min",       "max",    "mean",
                                  "rms",  "sum",   "amplitude", "ripple", "roughness"};
    std::size_t reduction = 0;
    reader_.word({.name = "reduce"}, reductions, reduction);
    q.reduce = reductions[reduction];
    static const Words norms{"rms", "max", "mean"};
    word(reader_, {.name = "norm"}, norms, q.norm);
    reader_.flag({.name = "area"}, q.area);
    static const Words errors{"relative", "absolute"};
    std::size_t error = 0;
    reader_.word({.name = "error"}, errors, error);
    q.relative = error == 0;
    reader_.flag({.name = "plot"}, q.plot);

    const Key key{.name = q.name};
    if (q.source == RowSource::history && q.value.empty()) {
        if (!q.of.empty()) reader_.fault(here, key, "history without of: it is the formula of a row", "both");
        q.of = row;
    } else if (q.source == RowSource::history && row.text != "all") {
        reader_.fault(here, key, "history: all where value says what to do with the rows", "'" + row.text + "'");
    }
    if (q.value.empty() == q.of.empty())
        reader_.fault(here, key, q.source == RowSource::summary ? "contact, body or history, or value" : "value or of",
                      q.value.empty() ? "neither" : "both");
    if (q.source == RowSource::summary && !q.of.empty())
        reader_.fault(here, key, "contact or body, where of is", "neither");
    if (!q.value.empty() && !q.exact.empty()) reader_.fault(here, key, "exact beside of or history", "beside value");
    if (!q.exact.empty() && !q.reference.empty()) reader_.fault(here, key, "reference or exact", "both");
    if (q.area && (q.source != RowSource::contact || q.exact.empty()))
        reader_.fault(here, key, "area with the exact values of contact", "area");
    const bool ordered = q.reduce == "first" || q.reduce == "last" || q.reduce == "roughness";
    if (!q.of.empty() && q.exact.empty() && ordered && q.source != RowSource::history && q.order_by.empty())
        reader_.fault(here, key, "order_by for " + q.reduce + " of nodes, or another reduce", "none");
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
    reader_.group({.name = "plots"}, [&] { axis_list("colour_by", study_.colour_by); });
    reader_.integer({.name = "repeats", .range = {.low = 1, .high = 100}}, study_.repeats);
}

} // namespace

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
