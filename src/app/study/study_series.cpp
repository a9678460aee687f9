#include "app/study/study_series.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace osculate::app {

namespace {

/// "blend", "steps 30" for a value that is a number alone, "E 30 MPa" for one with a unit.
std::string value_text(const scene::StudyAxis& axis, std::size_t value) {
    const std::string& name = axis.values[value].name;
    if (axis.values[value].number && !axis.unit.empty())
        return fmt::format("{} {} {}", axis.name, *axis.values[value].number, axis.unit);
    const bool number = name.find_first_not_of("0123456789.eE+-") == std::string::npos;
    return number ? axis.name + " " + name : name;
}

/// The formula that stands for the abscissa where none is given.
std::string default_abscissa(const scene::Study& study) {
    for (const auto& [name, value] : study.parameters_of(scene::Combination(study.axes.size(), 0)))
        if (name == "h") return "h";
    return scene::find(study.constants, "h") != nullptr ? "h" : "dofs";
}

} // namespace

std::string name_of_others(const scene::Study& study, const scene::Combination& combination,
                           const std::vector<std::size_t>& without) {
    std::string name;
    for (std::size_t a = 0; a < study.axes.size(); ++a)
        if (std::ranges::count(without, a) == 0)
            name += (name.empty() ? "" : ", ") + value_text(study.axes[a], combination[a]);
    return name;
}

std::vector<StudySeries> make_series(const scene::Study& study, const std::vector<StudyCase>& cases) {
    std::vector<StudySeries> all;
    std::map<scene::Combination, std::size_t> known;
    std::map<scene::Combination, int> colours, styles;
    for (const StudyCase& c : cases) {
        scene::Combination key, colour, style;
        for (std::size_t a = 0; a < study.axes.size(); ++a) {
            if (static_cast<int>(a) == study.refine) continue;
            key.push_back(c.combination[a]);
            (std::ranges::count(study.colour_by, a) > 0 ? colour : style).push_back(c.combination[a]);
        }
        const auto [at, fresh] = known.emplace(key, all.size());
        if (fresh) {
            const int next_colour = static_cast<int>(colours.size()), next_style = static_cast<int>(styles.size());
            const std::vector<std::size_t> refined(study.refine >= 0 ? 1 : 0, static_cast<std::size_t>(study.refine));
            const std::string name = name_of_others(study, c.combination, refined);
            all.push_back({name.empty() ? study.name : name,
                           {},
                           colours.emplace(colour, next_colour).first->second,
                           styles.emplace(style, next_style).first->second});
            all.back().problem = study.problem_of(c.combination);
        }
        if (c.completed()) all[at->second].cases.push_back(&c);
    }
    return all;
}

std::vector<study::CostPoint> work_points(const StudySeries& series, std::size_t quantity) {
    std::vector<study::CostPoint> points;
    for (const StudyCase* c : series.cases)
        points.push_back({c->record.median(&StudyRepeat::cpu), c->results[quantity].error});
    return points;
}

double abscissa(const scene::Study& study, const StudyCase& c) {
    const scene::StudyText text = study.abscissa.empty() ? scene::StudyText{default_abscissa(study)} : study.abscissa;
    return study::evaluate(text, c.numbers, study_functions());
}

std::string abscissa_label(const scene::Study& study) {
    if (!study.abscissa_label.empty()) return study.abscissa_label;
    return study.abscissa.empty() ? default_abscissa(study) : study.abscissa.text;
}

std::vector<study::CostPoint> convergence_points(const scene::Study& study, const StudySeries& series,
                                                 std::size_t quantity) {
    std::vector<study::CostPoint> points;
    for (const StudyCase* c : series.cases) points.push_back({abscissa(study, *c), c->results[quantity].error});
    return points;
}

bool is_relative(const scene::StudyQuantity& quantity, const std::vector<StudyCase>& cases, std::size_t index) {
    return quantity.relative && quantity.exact.empty() && std::ranges::any_of(cases, [&](const StudyCase& c) {
               return c.completed() && std::abs(c.results[index].reference) > 0;
           });
}

std::vector<const StudyCase*> pareto_cases(const scene::Study& study, const std::vector<StudyCase>& cases,
                                           std::size_t quantity) {
    struct Problem {
        std::vector<const StudyCase*> cases;
        std::vector<study::CostPoint> points;
    };
    std::map<scene::Combination, Problem> problems;
    for (const StudyCase& c : cases) {
        if (!c.completed()) continue;
        Problem& problem = problems[study.problem_of(c.combination)];
        problem.cases.push_back(&c);
        problem.points.push_back({c.record.median(&StudyRepeat::cpu), c.results[quantity].error});
    }
    std::vector<const StudyCase*> front;
    for (const auto& [key, problem] : problems)
        for (const std::size_t i : study::pareto_front(problem.points)) front.push_back(problem.cases[i]);
    return front;
}

} // namespace osculate::app
