#include "scene/study_checks.hpp"

#include "osculate/scene/nearest.hpp"
#include "scene/overrides.hpp"
#include "scene/tree.hpp"

#include <algorithm>
#include <set>

namespace osculate::scene {

namespace {

class StudyChecker {
public:
    StudyChecker(const Study& study, const NamedFunctions& functions, std::vector<Fault>& faults)
        : study_(study), functions_(functions), faults_(faults) {}

    /// Names that are defined twice or that no formula can have; formulas of constants. Whether all were well.
    bool constants();
    void scene_of(const Combination& combination, const std::vector<Override>& command_line);
    void quantities(const Scene& scene, const Combination& combination);

private:
    void add(Fault fault) {
        const std::string message = fault.message(); // combinations share most of their faults
        if (std::ranges::none_of(faults_, [&](const Fault& f) { return f.message() == message; }))
            faults_.push_back(std::move(fault));
    }
    void formula_fault(const std::string& key, const StudyText& text, const std::string& problem,
                       const std::string& near) {
        add(fault_at({study_.path, text.line, text.column}, key, "a formula", "'" + text.text + "' (" + problem + ")",
                     near));
    }
    bool formula(const std::string& key, const StudyText& text, const std::vector<std::string>& names) {
        if (text.empty()) return true;
        const ParsedFormula parsed = parse_formula(text.text, names, functions_);
        if (!parsed.problem.empty()) formula_fault(key, text, parsed.problem, parsed.nearest);
        return parsed.problem.empty();
    }
    const Study& study_;
    const NamedFunctions& functions_;
    std::vector<Fault>& faults_;
};

bool StudyChecker::constants() {
    const std::size_t before = faults_.size();
    std::vector<std::string> names;
    for (const auto& [name, value] : study_.parameters_of(Combination(study_.axes.size(), 0))) {
        if (std::ranges::count(names, name) > 0)
            add(fault_at({study_.path, 0, 0}, "axes", "parameters and axes with names of their own",
                         "'" + name + "' twice"));
        names.push_back(name);
    }
    for (const auto& [name, text] : study_.constants) {
        const std::string key = "constants." + name;
        if (!is_variable_name(name, functions_) || std::ranges::count(names, name) > 0)
            add(fault_at({study_.path, text.line, text.column}, key,
                         "a name of letters, digits and _ that formulas do not know yet", "'" + name + "'"));
        else if (formula(key, text, names))
            names.push_back(name);
        else
            return false; // those behind it may use it
    }
    return faults_.size() == before;
}

void StudyChecker::quantities(const Scene& scene, const Combination& combination) {
    const Numbers numbers = numbers_of(study_, combination, functions_, std::vector<double>(run_numbers().size(), 1));
    const auto joined = [&](const std::vector<std::string>& columns) {
        std::vector<std::string> names = columns;
        names.insert(names.end(), numbers.names.begin(), numbers.names.end());
        return names;
    };
    formula("abscissa", study_.abscissa, numbers.names);
    for (const StudyQuantity& q : study_.quantities) {
        const std::string key = "quantities." + q.name;
        std::vector<std::string> known;
        if (q.source == RowSource::contact)
            for (const auto& [name, pair] : scene.contact) known.push_back(name);
        if (q.source == RowSource::body)
            for (const auto& [name, body] : scene.bodies) known.push_back(name);
        if (!q.part.empty() && std::ranges::count(known, q.part) == 0)
            add(fault_at({study_.path, q.value.line + q.of.line, 0}, key,
                         q.source == RowSource::contact ? "the name of a contact pair: " + join(known)
                                                        : "the name of a body: " + join(known),
                         "'" + q.part + "'", nearest(q.part, known)));
        const std::vector<std::string> columns = visible_columns(q, scene, numbers.names);
        if (!q.value.empty()) {
            const Aggregate aggregate(q.value.text, columns, numbers.names, functions_);
            if (!aggregate.problem().empty())
                formula_fault(key + ".value", q.value, aggregate.problem(), aggregate.nearest());
        }
        formula(key + (q.source == RowSource::history ? ".history" : ".of"), q.of, joined(columns));
        formula(key + ".exact", q.exact, joined(columns));
        formula(key + ".where", q.where, joined(columns));
        formula(key + ".order_by", q.order_by, joined(columns));
        formula(key + ".scale", q.scale, numbers.names);
        if (!q.finest()) formula(key + ".reference", q.reference, numbers.names);
    }
}

void StudyChecker::scene_of(const Combination& combination, const std::vector<Override>& command_line) {
    const std::string path = study_.scene_of(combination);
    if (path.empty())
        return add(fault_at({study_.path, 0, 0}, "scene", "a scene, here or in every value of an axis",
                            "none for " + study_.id(combination)));
    try {
        quantities(read_scene(path, study_.overrides_of(combination, command_line)), combination);
    } catch (const SceneError& error) {
        for (const Fault& fault : error.faults()) add(placed(fault, study_, combination));
    }
}

} // namespace

Fault placed(Fault fault, const Study& study, const Combination& combination) {
    if (fault.file != override_file) return fault;
    const std::vector<std::string> path = split_path(fault.key);
    std::size_t longest = 0;
    for (const StudySetting& setting : study.settings_of(combination)) {
        const std::vector<std::string> own = split_path(setting.change.key);
        const auto [a, b] = std::ranges::mismatch(own, path);
        if (a != own.end() && b != path.end()) continue; // neither lies within the other
        const auto shared = static_cast<std::size_t>(a - own.begin());
        if (shared < longest) continue;
        longest = shared;
        fault.file = study.path;
        fault.line = setting.line;
        fault.column = setting.column;
    }
    return fault;
}

void check_study(const Study& study, const NamedFunctions& functions, const std::vector<Override>& command_line,
                 std::vector<Fault>& faults) {
    if (study.axes.empty() || std::ranges::any_of(study.axes, [](const StudyAxis& a) { return a.values.empty(); }))
        return; // a fault already
    const auto names = [](const AxisValue& value) {
        std::set<std::string> set;
        for (const auto& [name, number] : value.parameters) set.insert(name);
        return set;
    };
    for (const StudyAxis& axis : study.axes)
        for (const AxisValue& value : axis.values)
            if (names(value) != names(axis.values.front())) return; // another
    double runs = 1; // counted, not made: there may be more than fit into memory
    std::string product;
    for (const StudyAxis& axis : study.axes) {
        runs *= static_cast<double>(axis.values.size());
        product += (product.empty() ? "" : " x ") + std::to_string(axis.values.size());
    }
    constexpr double most_runs = 100000;
    if (runs > most_runs)
        return faults.push_back(fault_at({study.path, 0, 0}, "axes", "at most 100000 combinations of their values",
                                         product + (study.axes.size() > 1 ? " of them" : "")));
    StudyChecker checker(study, functions, faults);
    if (!checker.constants()) return;
    const std::vector<Combination> combinations = study.combinations();
    if (combinations.empty())
        faults.push_back(fault_at({study.path, 0, 0}, "leave_out", "something left to run", "nothing"));
    for (const Combination& c : combinations) checker.scene_of(c, command_line);
}

} // namespace osculate::scene
