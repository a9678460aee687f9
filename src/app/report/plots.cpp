#include "app/report/plots.hpp"

#include "app/fault.hpp"
#include "app/report/curve_rows.hpp"
#include "app/report/gnuplot.hpp"
#include "osculate/output/csv_reader.hpp"
#include "osculate/output/csv_table.hpp"
#include "osculate/output/history.hpp"
#include "osculate/output/probe_file.hpp"
#include "osculate/scene/nearest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string_view>

namespace osculate::app {

namespace {

namespace fs = std::filesystem;

constexpr const char* plot_folder = "plots";
constexpr const char* history_rows = "history";

/// Columns by the table's name. @param all  with those that dynamic scenes alone have
std::vector<std::string> columns_of(const scene::Scene& scene, const Plan& plan, const std::string& rows, bool all) {
    if (rows == history_rows) {
        const bool dynamic =
            std::ranges::any_of(plan.stages, [](const auto& stage) { return stage.dynamics.has_value(); });
        return output::History::columns(plan.model, scene.output.history_pairs,
                                        scene.output.history_reactions ? plan.constrained_sets : std::vector<Index>{},
                                        dynamic || all);
    }
    std::vector<std::string> names{"time"};
    for (const PlannedProbe& probe : plan.probes)
        if (probe.name == rows)
            for (const output::ProbeColumn& column : probe.probe->columns()) names.push_back(column.name);
    return names;
}

void check_curve(const scene::Scene& scene, const Plan& plan, const std::string& key, const scene::Curve& curve,
                 std::vector<Fault>& faults) {
    std::vector<std::string> tables{history_rows};
    for (const PlannedProbe& probe : plan.probes) tables.push_back(probe.name);
    if (std::ranges::count(tables, curve.rows) == 0) {
        faults.push_back(
            fault(key + ".rows", fmt::format("a table: {}", fmt::join(tables, ", ")), "'" + curve.rows + "'"));
        faults.back().nearest = scene::nearest(curve.rows, tables);
        return;
    }
    const std::vector<std::string> columns = columns_of(scene, plan, curve.rows, true);
    for (const auto& [name, formula] : {std::pair{"x", &curve.x}, {"y", &curve.y}, {"where", &curve.where}}) {
        if (formula->empty()) continue;
        const bool several = name == std::string_view("y");
        for (const ExpandedFormula& one :
             several ? expanded(*formula, columns) : std::vector{ExpandedFormula{*formula, {}, false}}) {
            const scene::ParsedFormula parsed = scene::parse_formula(one.text, formula_names(columns));
            if (parsed.problem.empty()) continue;
            faults.push_back(fault(key + "." + name,
                                   fmt::format("a formula over the columns of {}: {}", curve.rows,
                                               fmt::join(formula_names(columns), ", ")),
                                   fmt::format("'{}' ({})", *formula, parsed.problem)));
            faults.back().nearest = parsed.nearest;
            break;
        }
    }
}

/// Points of one curve of a picture.
struct DrawnCurve {
    std::string title;
    std::vector<double> x, y;
};

/// A table of the run, names without units.
scene::Rows read_table(const fs::path& folder, const std::string& rows) {
    const fs::path path = rows == history_rows ? folder / "history.csv" : output::ProbeFile::path(folder, rows);
    output::NumberTable table = output::read_numbers(path);
    for (std::string& name : table.names) name = output::name_of_column(name);
    return {formula_names(table.names), std::move(table.columns)};
}

std::string spaced(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::vector<DrawnCurve> curves_of(const scene::Plot& plot, const std::map<std::string, scene::Rows>& tables) {
    std::vector<DrawnCurve> curves;
    for (const auto& [name, curve] : plot.curves) {
        const scene::Rows& table = tables.at(curve.rows);
        for (const ExpandedFormula& one : expanded(curve.y, table.names)) {
            const auto points = curve_points(curve, one, table);
            if (!points) continue; // a column that this scene's table lacks
            if (std::ranges::none_of(points->second, [](double y) { return std::isfinite(y); })) continue;
            std::string title = spaced(name);
            if (!one.match.empty() && one.of_several) title += " " + one.match;
            curves.push_back({title, points->first, points->second});
        }
    }
    return curves;
}

void write_csv(const fs::path& path, const std::vector<DrawnCurve>& curves) {
    output::CsvTable table(path, {"curve", "x", "y"});
    for (const DrawnCurve& curve : curves)
        for (std::size_t i = 0; i < curve.x.size(); ++i) table.row({curve.title, curve.x[i], curve.y[i]});
}

/// A script that draws NAME.svg and NAME.png, its data inside.
std::string script_of(const std::string& name, const scene::Plot& plot, const std::vector<DrawnCurve>& curves) {
    std::string text =
        "set encoding utf8\nset grid lc rgb '#dddddd'\nset key outside right top noenhanced\n"
        "set title noenhanced\nset xlabel noenhanced\nset ylabel noenhanced\nset datafile missing 'NaN'\n";
    std::string lines;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        text += fmt::format("$curve_{} << END\n", i + 1);
        for (std::size_t k = 0; k < curves[i].x.size(); ++k)
            text += std::isnan(curves[i].y[k]) ? std::string("\n") // a gap
                                               : fmt::format("{:.9g} {:.9g}\n", curves[i].x[k], curves[i].y[k]);
        text += "END\n";
        const bool few = curves[i].x.size() <= 60;
        lines += fmt::format("{}$curve_{} with {} lw 1.5 lc rgb '{}' {}title {}", lines.empty() ? "" : ", \\\n     ",
                             i + 1, few ? "linespoints" : "lines", gnuplot_colours[i % gnuplot_colours.size()],
                             few ? "pt 7 ps 0.4 " : "", gnuplot_text(curves[i].title));
    }
    text += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n",
                        gnuplot_text(plot.title.empty() ? spaced(name) : plot.title),
                        gnuplot_text(plot.x_label.empty() ? plot.curves.front().second.x : plot.x_label),
                        gnuplot_text(plot.y_label.empty() ? plot.curves.front().second.y : plot.y_label));
    for (const auto& [terminal, ending] : {std::pair{"svg", "svg"}, {"pngcairo", "png"}})
        text += fmt::format("set terminal {} size 900,600 background 'white'\nset output {}\nplot {}\nunset output\n",
                            terminal, gnuplot_text(name + "." + ending), lines);
    return text;
}

/// @returns  what kept gnuplot from drawing; empty: nothing
std::string draw(const fs::path& folder, const std::string& name) {
    switch (run_gnuplot(folder / plot_folder, name + ".gp", true)) {
    case Gnuplot::drawn: return {};
    case Gnuplot::missing: return "gnuplot is not installed; run plots/*.gp to draw them later";
    case Gnuplot::failed: break;
    }
    return "gnuplot failed on plots/" + name + ".gp";
}

} // namespace

void check_plots(const scene::Scene& scene, const Plan& plan, std::vector<Fault>& faults) {
    for (const auto& [plot_name, plot] : scene.output.plots)
        for (const auto& [name, curve] : plot.curves)
            check_curve(scene, plan, "output.plots." + plot_name + ".curves." + name, curve, faults);
}

std::vector<std::string> plot_files(const scene::Scene& scene) {
    std::vector<std::string> files;
    for (const auto& [name, plot] : scene.output.plots)
        for (const char* ending : {".csv", ".gp", ".svg", ".png"})
            files.push_back(std::string(plot_folder) + "/" + name + ending);
    return files;
}

std::string write_plots(const scene::Scene& scene, output::OutputFolder& files) noexcept {
    try {
        const fs::path& folder = files.path();
        files.claim(plot_files(scene));
        std::map<std::string, scene::Rows> tables;
        for (const auto& [name, plot] : scene.output.plots)
            for (const auto& [curve_name, curve] : plot.curves)
                if (!tables.contains(curve.rows)) tables.emplace(curve.rows, read_table(folder, curve.rows));
        std::string note;
        for (const auto& [name, plot] : scene.output.plots) {
            const std::vector<DrawnCurve> curves = curves_of(plot, tables);
            if (curves.empty()) continue;
            write_csv(folder / plot_folder / (name + ".csv"), curves);
            std::ofstream file(folder / plot_folder / (name + ".gp"), std::ios::binary);
            file << script_of(name, plot, curves);
            file.close();
            if (!file) return "no plots: cannot write " + (folder / plot_folder / (name + ".gp")).string();
            if (const std::string problem = draw(folder, name); !problem.empty()) note = "no plots: " + problem;
        }
        return note;
    } catch (const std::exception& error) {
        return std::string("no plots: ") + error.what();
    }
}

} // namespace osculate::app
