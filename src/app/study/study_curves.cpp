#include "app/study/study_curves.hpp"

#include "app/study/study_series.hpp"
#include "osculate/output/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace osculate::app {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

double value_of(const StudyCase& c, std::size_t quantity) {
    const double value = c.completed() ? c.results[quantity].value : no_value;
    return std::isfinite(value) ? value : no_value;
}

/// The cases of every combination of the axes that are not `within`, in the order of the runs.
std::vector<std::vector<const StudyCase*>> groups(const std::vector<StudyCase>& cases,
                                                  const std::vector<std::size_t>& within) {
    std::vector<std::vector<const StudyCase*>> all;
    std::map<scene::Combination, std::size_t> known;
    for (const StudyCase& c : cases) {
        scene::Combination key = c.combination;
        for (const std::size_t axis : within) key[axis] = 0;
        const auto [at, fresh] = known.emplace(std::move(key), all.size());
        if (fresh) all.emplace_back();
        all[at->second].push_back(&c);
    }
    return all;
}

std::vector<std::size_t> by_place(const scene::Study& study, const scene::StudyCoordinate& over) {
    std::vector<std::size_t> order(study.axes[over.axis].values.size());
    for (std::size_t v = 0; v < order.size(); ++v) order[v] = v;
    std::ranges::stable_sort(order, {}, [&](std::size_t v) { return place_of(study, over, v); });
    return order;
}

/// The place of a value, or its name where it has none.
output::Cell place_cell(const scene::Study& study, const scene::StudyCoordinate& over, std::size_t value) {
    if (const auto place = study.place_of(over, value)) return *place;
    return study.axes[over.axis].values[value].name;
}

} // namespace

double place_of(const scene::Study& study, const scene::StudyCoordinate& over, std::size_t value) {
    return study.place_of(over, value).value_or(static_cast<double>(value));
}

std::string label_of(const scene::StudyCoordinate& over) {
    return over.unit.empty() ? over.name : over.name + ", " + over.unit;
}

std::string label_of(const scene::StudyQuantity& quantity) {
    return quantity.unit.empty() ? quantity.label : quantity.label + ", " + quantity.unit;
}

std::vector<StudyCurve> make_curves(const scene::Study& study, const std::vector<StudyCase>& cases,
                                    const scene::StudyCurves& plot) {
    std::vector<StudyCurve> curves;
    for (const auto& group : groups(cases, {plot.over.axis})) {
        StudyCurve& curve = curves.emplace_back();
        curve.name = name_of_others(study, group.front()->combination, {plot.over.axis});
        for (const StudyCase* c : group) {
            const std::size_t value = c->combination[plot.over.axis];
            const double y = value_of(*c, plot.quantity);
            if (!std::isnan(y)) curve.points.push_back({value, place_of(study, plot.over, value), y});
        }
        std::ranges::stable_sort(curve.points, {}, &CurvePoint::x);
    }
    return curves;
}

std::vector<StudyMap> make_maps(const scene::Study& study, const std::vector<StudyCase>& cases,
                                const scene::StudyContours& plot) {
    const auto& [x, y] = plot.over;
    std::vector<StudyMap> maps;
    for (const auto& group : groups(cases, {x.axis, y.axis})) {
        StudyMap map{name_of_others(study, group.front()->combination, {x.axis, y.axis}),
                     by_place(study, x),
                     by_place(study, y),
                     {}};
        map.values.assign(map.rows.size(), std::vector<double>(map.columns.size(), no_value));
        for (const StudyCase* c : group) {
            const auto column = std::ranges::find(map.columns, c->combination[x.axis]) - map.columns.begin();
            const auto row = std::ranges::find(map.rows, c->combination[y.axis]) - map.rows.begin();
            map.values[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = value_of(*c, plot.quantity);
        }
        maps.push_back(std::move(map));
    }
    return maps;
}

std::vector<StudySensitivity> make_sensitivities(const scene::Study& study, const std::vector<StudyCase>& cases,
                                                 std::size_t quantity, std::size_t axis) {
    const auto& variables = study.axes[axis].variables;
    std::vector<StudySensitivity> all;
    for (const auto& group : groups(cases, {axis})) {
        std::vector<const StudyCase*> known;
        for (const StudyCase* c : group)
            if (!std::isnan(value_of(*c, quantity))) known.push_back(c);
        const auto runs = static_cast<Eigen::Index>(known.size());
        Eigen::MatrixXd inputs(runs, std::ssize(variables));
        Eigen::VectorXd outputs(runs);
        for (Eigen::Index i = 0; i < runs; ++i) {
            const StudyCase& c = *known[static_cast<std::size_t>(i)];
            outputs[i] = value_of(c, quantity);
            for (std::size_t v = 0; v < variables.size(); ++v) {
                const scene::StudyCoordinate over{axis, variables[v].name};
                const double at = place_of(study, over, c.combination[axis]);
                inputs(i, static_cast<Eigen::Index>(v)) = variables[v].logarithmic ? std::log(at) : at;
            }
        }
        all.push_back({name_of_others(study, group.front()->combination, {axis}), known.size(),
                       study::sensitivity(inputs, outputs)});
    }
    return all;
}

std::vector<std::string> curve_files(const scene::Study& study) {
    std::vector<std::string> files;
    for (const char* ending : {".svg", ".png", ".csv"}) {
        for (const scene::StudyCurves& plot : study.curves) files.push_back(plot.name + "_curves" + ending);
        for (const scene::StudyContours& plot : study.contours) files.push_back(plot.name + "_contours" + ending);
    }
    return files;
}

void write_curve_tables(const scene::Study& study, const std::vector<StudyCase>& cases,
                        const std::filesystem::path& folder) {
    for (const scene::StudyCurves& plot : study.curves) {
        const std::vector<StudyCurve> curves = make_curves(study, cases, plot);
        std::vector<std::string> columns{plot.over.name};
        for (const StudyCurve& curve : curves)
            columns.push_back(curve.name.empty() ? study.quantities[plot.quantity].name : curve.name);
        output::CsvTable table(folder / (plot.name + "_curves.csv"), columns);
        for (const std::size_t value : by_place(study, plot.over)) {
            std::vector<output::Cell> cells{place_cell(study, plot.over, value)};
            for (const StudyCurve& curve : curves) {
                const auto at = std::ranges::find(curve.points, value, &CurvePoint::value);
                cells.push_back(output::cell(at == curve.points.end() ? no_value : at->y));
            }
            table.row(cells);
        }
    }
    for (const scene::StudyContours& plot : study.contours) {
        const auto& [x, y] = plot.over;
        output::CsvTable table(folder / (plot.name + "_contours.csv"),
                               {"others", x.name, y.name, study.quantities[plot.quantity].name});
        for (const StudyMap& map : make_maps(study, cases, plot))
            for (std::size_t r = 0; r < map.rows.size(); ++r)
                for (std::size_t c = 0; c < map.columns.size(); ++c)
                    table.row({map.name, place_cell(study, x, map.columns[c]), place_cell(study, y, map.rows[r]),
                               output::cell(map.values[r][c])});
    }
}

} // namespace osculate::app
