#include "osculate/scene/nearest.hpp"
#include "scene/describe_parts.hpp"
#include "scene/files_like.hpp"
#include "scene/flow_text.hpp"
#include "scene/study_reader.hpp"
#include "scene/study_samples.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

namespace osculate::scene {

namespace fs = std::filesystem;

namespace {

/// Whether the name of an axis' value is fit for a folder's name.
bool fits_value(const std::string& name) {
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; };
    return std::ranges::all_of(name, fits) && !name.starts_with('.');
}

/// "MPa" of "30 MPa"; empty without a unit.
std::string unit_in(const std::string& quantity) {
    const Quantity read = parse_quantity(quantity);
    if (!read.has_unit || !read.problem.empty()) return {};
    double number = 0;
    const char* begin = quantity.data() + quantity.find_first_not_of(" \t+");
    const char* end = std::from_chars(begin, quantity.data() + quantity.size(), number).ptr;
    std::string text(end, quantity.data() + quantity.size());
    text.erase(0, text.find_first_not_of(" \t"));
    text.erase(text.find_last_not_of(" \t") + 1);
    return text;
}

/// The number of "30 MPa" as written, 30; none where the text is no quantity.
std::optional<double> number_in(const std::string& quantity) {
    const Quantity read = parse_quantity(quantity);
    if (!read.problem.empty() || !std::isfinite(read.value)) return std::nullopt;
    double number = 0;
    const std::size_t begin = quantity.find_first_not_of(" \t+");
    std::from_chars(quantity.data() + begin, quantity.data() + quantity.size(), number);
    return number;
}

/// Numbers of the axis' values, if all have one and the same unit.
void number_values(StudyAxis& axis) {
    const auto text = [](const AxisValue& value) { return value.settings.front().change.value; };
    const std::string unit = unit_in(text(axis.values.front()));
    for (const AxisValue& value : axis.values)
        if (!number_in(text(value)) || unit_in(text(value)) != unit) return;
    axis.unit = unit;
    for (AxisValue& value : axis.values) value.number = number_in(text(value));
}

} // namespace

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
    number_values(axis);
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

void StudyReader::sampled_variable(const std::string& name, SampledRange& range) {
    if (!is_variable_name(name, functions_))
        reader_.fault(*tree_.find("axes"), {.name = name}, variable_rule, "'" + name + "'");
    const Key key{.name = "key", .required = true};
    const char* expected = "a key path of the scene, or a list of them";
    if (const Tree* keys = reader_.take(key, expected)) {
        range.place = keys->place;
        if (keys->kind == Tree::Kind::scalar) range.keys.push_back(keys->scalar);
        if (keys->kind == Tree::Kind::list)
            for (const Tree& item : keys->children) range.keys.push_back(item.scalar);
        if (range.keys.empty() || std::ranges::count(range.keys, std::string()) > 0)
            reader_.fault(*keys, key, expected);
    }
    static const Words spacings{"linear", "logarithmic"};
    std::size_t spacing = 0;
    reader_.word({.name = "spacing"}, spacings, spacing);
    range.logarithmic = spacing == 1;
    const Tree* bounds[2]{};
    for (int b = 0; b < 2; ++b) {
        const Key bound{.name = b == 0 ? "from" : "to", .required = true};
        const char* number = "a number, with the unit that the key takes";
        bounds[b] = reader_.take(bound, number);
        if (!bounds[b]) continue;
        const auto value = bounds[b]->kind == Tree::Kind::scalar ? number_in(bounds[b]->scalar) : std::nullopt;
        if (!value) return reader_.fault(*bounds[b], bound, number);
        (b == 0 ? range.from : range.to) = *value;
    }
    if (!bounds[0] || !bounds[1]) return;
    range.unit = unit_in(bounds[0]->scalar);
    const Key to{.name = "to"};
    if (unit_in(bounds[1]->scalar) != range.unit)
        reader_.fault(*bounds[1], to, "the unit of from, " + (range.unit.empty() ? "none" : range.unit));
    else if (!(range.to > range.from))
        reader_.fault(*bounds[1], to, "more than from, " + bounds[0]->scalar);
    else if (range.logarithmic && !(range.from > 0))
        reader_.fault(*bounds[0], {.name = "from"}, "more than 0, as the spacing is logarithmic");
}

void StudyReader::sampled_values(StudyAxis& axis) {
    static const Words rules{"latin_hypercube", "sobol"};
    std::size_t rule = 0;
    reader_.word({.name = "sample"}, rules, rule);
    constexpr int most_runs = 10000;
    int runs = 0, seed = 1;
    reader_.integer({.name = "runs", .range = {.low = 2, .high = most_runs}, .required = true}, runs);
    reader_.integer({.name = "seed", .range = {.low = 0, .high = std::numeric_limits<int>::max()}}, seed);
    Named<SampledRange> ranges;
    const std::size_t before = faults_.size();
    named(reader_, {.name = "variables", .required = true, .names = Names::identifier, .item = "variable"}, ranges,
          [&](const std::string& name, SampledRange& range) {
              reader_.group({.name = name}, [&] { sampled_variable(name, range); });
          });
    if (faults_.size() > before || ranges.empty() || runs < 2) return;
    const auto points = unit_samples(static_cast<SampleRule>(rule), runs, static_cast<int>(ranges.size()), seed);
    const std::size_t width = std::to_string(runs).size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::string name = std::to_string(i + 1);
        name.insert(0, width - name.size(), '0'); // in the order of their numbers wherever folders are listed
        AxisValue& value = axis.values.emplace_back(AxisValue{std::move(name), "", {}, {}});
        for (std::size_t v = 0; v < ranges.size(); ++v) {
            const auto& [variable, range] = ranges[v];
            const double at = points[i][v];
            const double number = range.logarithmic ? range.from * std::pow(range.to / range.from, at)
                                                    : range.from + (range.to - range.from) * at;
            value.parameters.emplace_back(variable, number);
            const std::string text = number_text(number) + (range.unit.empty() ? "" : " " + range.unit);
            for (const std::string& key : range.keys)
                value.settings.push_back({{key, text}, range.place.line, range.place.column});
        }
    }
    for (const auto& [variable, range] : ranges) axis.variables.push_back({variable, range.unit, range.logarithmic});
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
        if (const Tree* rule = here->find("sample"); rule && rule->kind == Tree::Kind::scalar)
            return sampled_values(axis);
        for (const Tree& entry : here->children) named_value(entry, axis);
    });
    if (axis.values.empty() && faults_.size() == before)
        reader_.fault(*here, {.name = name}, "key and values, scenes, sample, or a map of values", here->found());
    if (faults_.size() == before) compare_parameters(*here, axis);
}

} // namespace osculate::scene
