#include "app/report/run_report_plots.hpp"

#include "app/report/gnuplot.hpp"
#include "osculate/output/csv_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

constexpr std::array plot_names{"contact", "reactions", "energies", "steps"};

struct Curve {
    std::size_t column; ///< of history.csv, from 1
    std::string title;
};

double largest(const std::vector<double>& column) {
    double found = 0;
    for (const double value : column)
        if (std::isfinite(value)) found = std::max(found, std::abs(value));
    return found;
}

/// "[0:2]" around the finite ones among the values, with some air: gnuplot warns of ranges that are empty.
std::string range_of(const output::NumberTable& history, const std::vector<Curve>& curves, double unit) {
    double low = 0, high = 0;
    for (const Curve& curve : curves)
        for (const double value : history.columns[curve.column - 1])
            if (std::isfinite(value)) {
                low = std::min(low, value);
                high = std::max(high, value);
            }
    constexpr double air = 0.05;
    const double extent = high > low ? high - low : 1;
    return fmt::format("[{:.6g}:{:.6g}]", (low < 0 ? low - air * extent : 0) / unit, (high + air * extent) / unit);
}

/// Both files of one plot of history.csv; nothing without curves that are more than round-off.
std::string plot(const output::NumberTable& history, const std::string& name, const std::string& title,
                 const std::string& unit, std::vector<Curve> curves, const std::string& style = "lines lw 1.5") {
    static constexpr std::array colours{"#0b6aa8", "#d55e00", "#0a8f6a", "#a8488c", "#b98a00", "#4a5560", "#2aa1c9"};
    constexpr double round_off = 1e-9;
    double most = 0;
    for (const Curve& curve : curves) most = std::max(most, largest(history.columns[curve.column - 1]));
    std::erase_if(curves,
                  [&](const Curve& curve) { return largest(history.columns[curve.column - 1]) <= round_off * most; });
    if (curves.empty()) return "";
    // the prefix of the largest value is that of the axis
    const double thousands = std::clamp(std::floor(std::log10(most) / 3), -4., 3.), scale = std::pow(1000., thousands);
    static const std::array<std::string, 8> prefixes{"p", "n", "µ", "m", "", "k", "M", "G"};
    std::string lines;
    for (std::size_t c = 0; c < curves.size(); ++c)
        lines += fmt::format("{} '../history.csv' using 1:(column({})/{:g}) with {} lc rgb '{}' title {}",
                             c == 0 ? "" : ", \\\n    ", curves[c].column, scale, style, colours[c % colours.size()],
                             gnuplot_text(curves[c].title));
    std::string text = fmt::format("set title {}\nset ylabel {}\nset xrange {}\nset yrange {}\n", gnuplot_text(title),
                                   gnuplot_text(prefixes[static_cast<std::size_t>(thousands + 4)] + unit),
                                   range_of(history, {{1, ""}}, 1), range_of(history, curves, scale));
    for (const auto& [terminal, ending] : {std::pair{"svg", "svg"}, std::pair{"pngcairo", "png"}})
        text += fmt::format("set terminal {} size 1000,560 font 'sans,13' background 'white'\nset output {}\nplot{}\n"
                            "unset output\n",
                            terminal, gnuplot_text(name + "." + ending), lines);
    return text;
}

/// "set.rear.reaction_y" -> "rear, reaction y"
std::string in_words(std::string column) {
    for (const char* group : {"pair.", "set.", "energy."})
        if (column.starts_with(group)) column.erase(0, std::string(group).size());
    const std::size_t point = column.rfind('.');
    if (point == std::string::npos) return column;
    std::string what = column.substr(point + 1);
    std::ranges::replace(what, '_', ' ');
    return column.substr(0, point) + ", " + what;
}

std::string script(const output::NumberTable& history) {
    std::vector<Curve> contact, reactions, energies, steps;
    for (std::size_t c = 0; c < history.names.size(); ++c) {
        const std::string& name = history.names[c];
        const Curve curve{c + 1, in_words(name)};
        if (name.starts_with("pair.") && (name.ends_with(".normal") || name.ends_with(".friction")))
            contact.push_back(curve);
        if (name.starts_with("set.")) reactions.push_back(curve);
        if (name.starts_with("energy.")) energies.push_back(curve);
        if (name == "dt") steps.push_back(curve);
    }
    return "set encoding utf8\nset datafile separator ','\nset datafile columnheaders\nset grid xtics ytics lt 1 lc "
           "rgb '#dddddd'\n"
           "set key tmargin center horizontal samplen 2 noenhanced\nset title noenhanced\nset ylabel noenhanced\nset "
           "xlabel 'time, s'\n" +
           plot(history, plot_names[0], "Contact forces: sums of the nodes'", "N", contact) +
           plot(history, plot_names[1], "Reactions", "N", reactions) +
           plot(history, plot_names[2], "Energies", "J", energies) +
           plot(history, plot_names[3], "dt of the accepted steps", "s", steps, "steps lw 1.5");
}

} // namespace

std::string write_report_plots(output::OutputFolder& run) {
    const fs::path& run_folder = run.path();
    output::NumberTable history;
    try {
        history = output::read_numbers(run_folder / "history.csv");
    } catch (const std::runtime_error&) { // the page has said so
        return "";
    }
    if (history.names.empty() || history.columns.front().empty()) return "";
    const fs::path folder = run_folder / "report";
    std::vector<std::string> files{"report/plots.gp"};
    for (const char* name : plot_names)
        for (const char* ending : {".svg", ".png"}) files.push_back(std::string("report/") + name + ending);
    run.claim(files);
    {
        std::ofstream file(folder / "plots.gp", std::ios::binary);
        file << script(history);
        if (!file.flush()) throw std::runtime_error("cannot write " + (folder / "plots.gp").string());
    }
    switch (run_gnuplot(folder, "plots.gp")) {
    case Gnuplot::drawn: return "";
    case Gnuplot::missing:
        return "There are no plots as files: gnuplot is not installed; report/plots.gp draws them later.";
    case Gnuplot::failed: break;
    }
    return "There are no plots as files: gnuplot failed on report/plots.gp.";
}

} // namespace osculate::app
