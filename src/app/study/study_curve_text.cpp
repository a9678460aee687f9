#include "app/study/study_curves.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace osculate::app {

namespace {

/// A cell of a table: Markdown takes '|' for its end.
std::string plain(std::string text) {
    std::ranges::replace(text, '|', '/');
    return text;
}

std::string six_digits(double value) {
    return std::isnan(value) ? "-" : fmt::format("{:.6g}", value);
}

std::string place(const scene::Study& study, const scene::StudyCoordinate& over, std::size_t value) {
    const auto at = study.place_of(over, value);
    return at ? fmt::format("{:.6g}", *at) : study.axes[over.axis].values[value].name;
}

std::string rule(std::size_t columns) {
    std::string text = "|";
    for (std::size_t i = 0; i < columns; ++i) text += "---|";
    return text + "\n";
}

std::string curve_section(const scene::Study& study, const std::vector<StudyCase>& cases,
                          const scene::StudyCurves& plot) {
    const scene::StudyQuantity& q = study.quantities[plot.quantity];
    std::string text = fmt::format("## {} over {}\n\n", q.label, plot.over.name);
    const std::vector<StudyCurve> curves = make_curves(study, cases, plot);
    if (!plot.over.sampled) { // of samples it would be no more than the list of runs
        text += "| " + plain(label_of(plot.over)) + " |";
        for (const StudyCurve& curve : curves)
            text += " " + plain(curve.name.empty() ? label_of(q) : curve.name) + " |";
        text += "\n" + rule(curves.size() + 1);
        std::vector<std::size_t> values(study.axes[plot.over.axis].values.size());
        for (std::size_t v = 0; v < values.size(); ++v) values[v] = v;
        std::ranges::stable_sort(values, {}, [&](std::size_t v) { return place_of(study, plot.over, v); });
        for (const std::size_t value : values) {
            text += "| " + place(study, plot.over, value) + " |";
            for (const StudyCurve& curve : curves) {
                const auto at = std::ranges::find(curve.points, value, &CurvePoint::value);
                text += at == curve.points.end() ? " - |" : " " + six_digits(at->y) + " |";
            }
            text += "\n";
        }
        text += "\n";
    }
    const bool any = std::ranges::any_of(curves, [](const StudyCurve& curve) { return !curve.points.empty(); });
    return any ? text + fmt::format("![{} over {}]({}_curves.png)\n\n", q.label, plot.over.name, plot.name) : text;
}

std::string contour_section(const scene::Study& study, const std::vector<StudyCase>& cases,
                            const scene::StudyContours& plot) {
    const scene::StudyQuantity& q = study.quantities[plot.quantity];
    const auto& [x, y] = plot.over;
    std::string text = fmt::format("## {} over {} and {}\n\n", q.label, x.name, y.name);
    bool any = false;
    for (const StudyMap& map : make_maps(study, cases, plot)) {
        for (const auto& row : map.values)
            any = any || std::ranges::any_of(row, [](double value) { return !std::isnan(value); });
        if (!map.name.empty()) text += map.name + ":\n\n";
        text += fmt::format("| {} \\\\ {} |", plain(label_of(y)), plain(label_of(x)));
        for (const std::size_t c : map.columns) text += " " + place(study, x, c) + " |";
        text += "\n" + rule(map.columns.size() + 1);
        for (std::size_t r = 0; r < map.rows.size(); ++r) {
            text += "| " + place(study, y, map.rows[r]) + " |";
            for (const double value : map.values[r]) text += " " + six_digits(value) + " |";
            text += "\n";
        }
        text += "\n";
    }
    return any ? text + fmt::format("![{} over {} and {}]({}_contours.png)\n\n", q.label, x.name, y.name, plot.name)
               : text;
}

std::string sensitivity_section(const scene::Study& study, const std::vector<StudyCase>& cases, std::size_t axis) {
    std::string text = fmt::format(
        "## Sensitivities to {}\n\n"
        "Standardised regression coefficient (change of the quantity in its standard deviations for one of the "
        "variable's) and, in brackets, Spearman's rank correlation. R^2 is the share of the variance that the linear "
        "regression explains: where it is small, coefficients say little.\n\n| quantity |",
        study.axes[axis].name);
    const auto& variables = study.axes[axis].variables;
    for (const scene::SampledVariable& v : variables) text += " " + v.name + " |";
    text += " R^2 | runs |\n" + rule(variables.size() + 3);
    for (std::size_t k = 0; k < study.quantities.size(); ++k) {
        if (!study.quantities[k].plot) continue;
        for (const StudySensitivity& s : make_sensitivities(study, cases, k, axis)) {
            text += "| " + plain(study.quantities[k].label + (s.name.empty() ? "" : ", " + s.name)) + " |";
            for (std::size_t v = 0; v < variables.size(); ++v) {
                const auto at = static_cast<Eigen::Index>(v);
                text += s.values ? fmt::format(" {:.3f} ({:.3f}) |", s.values->coefficients[at],
                                               s.values->rank_correlations[at])
                                 : std::string(" - |");
            }
            text += s.values ? fmt::format(" {:.3f} |", s.values->determination) : std::string(" - |");
            text += fmt::format(" {} |\n", s.runs);
        }
    }
    return text + "\n";
}

} // namespace

std::string curve_sections(const scene::Study& study, const std::vector<StudyCase>& cases) {
    std::string text;
    for (const scene::StudyCurves& plot : study.curves) text += curve_section(study, cases, plot);
    for (const scene::StudyContours& plot : study.contours) text += contour_section(study, cases, plot);
    for (std::size_t a = 0; a < study.axes.size(); ++a)
        if (!study.axes[a].variables.empty()) text += sensitivity_section(study, cases, a);
    return text;
}

} // namespace osculate::app
