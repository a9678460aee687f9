#include "osculate/scene/study.hpp"

#include "scene/tree.hpp"

#include <algorithm>

namespace osculate::scene {

namespace {

bool left_out(const Study& study, const Combination& c) {
    return std::ranges::any_of(study.leave_out, [&](const auto& rule) {
        for (std::size_t a = 0; a < c.size(); ++a)
            if (!rule[a].empty() && std::ranges::count(rule[a], c[a]) == 0) return false;
        return true;
    });
}

bool reads(const Study& study, RowSource source) {
    return std::ranges::count(study.quantities, source, &StudyQuantity::source) > 0;
}

} // namespace

std::vector<Combination> Study::combinations() const {
    std::vector<Combination> all;
    Combination c(axes.size(), 0);
    while (true) {
        if (!left_out(*this, c)) all.push_back(c);
        std::size_t a = axes.size();
        while (a > 0 && ++c[a - 1] == axes[a - 1].values.size()) c[--a] = 0;
        if (a == 0) return all;
    }
}

std::string Study::id(const Combination& combination) const {
    std::string text;
    for (std::size_t a = 0; a < axes.size(); ++a)
        text += (a == 0 ? "" : ",") + axes[a].name + "=" + axes[a].values[combination[a]].name;
    return text;
}

std::string Study::scene_of(const Combination& combination) const {
    std::string last = scene;
    for (std::size_t a = 0; a < axes.size(); ++a)
        if (const std::string& own = axes[a].values[combination[a]].scene; !own.empty()) last = own;
    return last;
}

std::vector<StudySetting> Study::settings_of(const Combination& combination) const {
    std::vector<StudySetting> list = settings;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const auto& own = axes[a].values[combination[a]].settings;
        list.insert(list.end(), own.begin(), own.end());
    }
    return list;
}

std::vector<Override> Study::overrides_of(const Combination& combination,
                                          const std::vector<Override>& command_line) const {
    std::vector<Override> list;
    for (const StudySetting& setting : settings_of(combination)) list.push_back(setting.change);
    list.insert(list.end(), command_line.begin(), command_line.end());
    const bool nodes = reads(*this, RowSource::contact), bodies = reads(*this, RowSource::body);
    list.push_back({"output.template", "minimal"});
    list.push_back({"output.probes", "{}"});
    list.push_back({"output.plots", "{}"});
    list.push_back({"output.derivatives", "{}"});
    list.push_back({"output.gradients", "{}"});
    list.push_back({"output.body_fields", bodies ? "[displacement, stress, von_mises, reaction]" : "[]"});
    list.push_back(
        {"output.slave_fields", nodes ? "[gap, contact_force, normal_stress, slip, status, normal, area]" : "[]"});
    list.push_back({"output.master_fields", "[]"});
    list.push_back({"output.history", "[pairs, reactions]"});
    list.push_back({"output.iterations", "false"});
    list.push_back({"output.frame_every", nodes || bodies ? "1000000" : "0"}); // the first one and the last
    return list;
}

Combination Study::problem_of(const Combination& combination) const {
    Combination values;
    for (const std::size_t a : problems) values.push_back(combination[a]);
    return values;
}

Named<double> Study::parameters_of(const Combination& combination) const {
    Named<double> numbers;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        // sorted, as values may name theirs in any order
        Named<double> own = axes[a].values[combination[a]].parameters;
        std::ranges::sort(own);
        numbers.insert(numbers.end(), own.begin(), own.end());
        numbers.emplace_back(axes[a].name + "_index", static_cast<double>(combination[a]));
    }
    return numbers;
}

std::optional<double> Study::place_of(const StudyCoordinate& coordinate, std::size_t value) const {
    const AxisValue& at = axes[coordinate.axis].values[value];
    if (const double* parameter = find(at.parameters, coordinate.name)) return *parameter;
    return coordinate.name == axes[coordinate.axis].name ? at.number : std::nullopt;
}

const std::vector<std::string>& contact_columns() {
    static const std::vector<std::string> names{
        "X",      "Y",      "Z",      "x",       "y",        "z",        "ux",
        "uy",     "uz",     "gap",    "force_x", "force_y",  "force_z",  "normal_stress",
        "slip_x", "slip_y", "slip_z", "status",  "normal_x", "normal_y", "normal_z",
        "area"};
    return names;
}

const std::vector<std::string>& body_columns() {
    static const std::vector<std::string> names{"X",         "Y",          "Z",          "x",         "y",
                                                "z",         "ux",         "uy",         "uz",        "stress_xx",
                                                "stress_yy", "stress_zz",  "stress_xy",  "stress_yz", "stress_zx",
                                                "von_mises", "reaction_x", "reaction_y", "reaction_z"};
    return names;
}

const std::vector<std::string>& run_numbers() {
    static const std::vector<std::string> names{
        "dofs",   "steps",         "rejected",       "iterations",    "cpu",          "wall",
        "memory", "force_balance", "energy_balance", "energy_growth", "closing_loss", "penetration"};
    return names;
}

std::vector<std::string> history_columns(const Scene& scene) {
    std::vector<std::string> names{"time", "dt", "iterations"};
    const auto vector = [&](const std::string& name) {
        for (const char* axis : {"_x", "_y", "_z"}) names.push_back(name + axis);
    };
    for (const auto& [name, pair] : scene.contact) {
        const std::string prefix = "pair." + name + ".";
        vector(prefix + "force");
        vector(prefix + "moment");
        for (const char* column : {"normal", "friction", "area", "open", "stick", "slip", "penetration"})
            names.push_back(prefix + column);
    }
    const auto constrained = [&](const std::string& set) {
        return find(scene.supports, set) != nullptr ||
               std::ranges::any_of(scene.stages, [&](const auto& s) { return find(s.second.displacement, set); });
    };
    for (const auto& [name, set] : scene.sets)
        if (constrained(name)) vector("set." + name + ".reaction");
    if (std::ranges::any_of(scene.stages, [](const auto& stage) {
            return std::holds_alternative<DynamicAnalysis>(stage.second.analysis);
        })) {
        for (const char* energy :
             {"kinetic", "strain", "external", "friction", "damping", "algorithmic", "contact", "balance"})
            names.push_back(std::string("energy.") + energy);
        vector("momentum.linear");
        vector("momentum.angular");
    }
    for (std::string& name : names) std::ranges::replace(name, '-', '_');
    return names;
}

Numbers numbers_of(const Study& study, const Combination& combination, const NamedFunctions& functions,
                   const std::vector<double>& run) {
    Numbers own;
    for (const auto& [name, value] : study.parameters_of(combination)) own.add(name, value);
    for (const auto& [name, text] : study.constants)
        own.add(name, parse_formula(text.text, own.names, functions).function(own.values));
    Numbers all;
    for (std::size_t i = 0; i < run.size(); ++i)
        if (std::ranges::count(own.names, run_numbers()[i]) == 0) all.add(run_numbers()[i], run[i]);
    for (std::size_t i = 0; i < own.names.size(); ++i) all.add(own.names[i], own.values[i]);
    return all;
}

std::vector<std::string> visible_columns(const StudyQuantity& quantity, const Scene& scene,
                                         const std::vector<std::string>& numbers) {
    std::vector<std::string> names;
    switch (quantity.source) {
    case RowSource::contact: names = contact_columns(); break;
    case RowSource::body: names = body_columns(); break;
    case RowSource::history: names = history_columns(scene); break;
    case RowSource::summary: break;
    }
    if (quantity.source == RowSource::contact || quantity.source == RowSource::body) names.emplace_back("time");
    std::erase_if(names, [&](const std::string& name) { return std::ranges::count(numbers, name) > 0; });
    return names;
}

bool is_run_study(const std::string& path) {
    std::vector<Fault> ignored;
    return read_yaml(path, ignored).find("surfaces") == nullptr;
}

} // namespace osculate::scene
