#include "app/report/gnuplot.hpp"
#include "app/study/study_curves.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace osculate::app {

namespace {

using scene::Study;
using scene::StudyCoordinate;

constexpr double some_air = 1.1, no_air = 1 + 1e-9; // a tic at the very end would be lost

struct Extent {
    double least = std::numeric_limits<double>::infinity(), largest = -least;
    void add(double value) {
        if (std::isnan(value)) return;
        least = std::min(least, value);
        largest = std::max(largest, value);
    }
    [[nodiscard]] bool flat() const { return !(largest > least); }
};

/// Scale, range and tics of one axis of a plot.
std::string scale(char axis, const Extent& extent, bool logarithmic, double air) {
    if (!logarithmic || extent.flat())
        return fmt::format("unset logscale {0}\nset autoscale {0}\nset {0}tics autofreq\n", axis);
    return fmt::format("set logscale {0}\nset {0}range [{1:.9g}:{2:.9g}]\nset {0}tics {3}\n", axis, extent.least / air,
                       extent.largest * air, gnuplot_log_tics(extent.least, extent.largest));
}

std::string scale(char axis, const Study& study, const StudyCoordinate& over, double air) {
    const auto& values = study.axes[over.axis].values;
    if (study.place_of(over, 0)) {
        Extent extent;
        for (std::size_t v = 0; v < values.size(); ++v) extent.add(place_of(study, over, v));
        return scale(axis, extent, over.logarithmic, air);
    }
    std::string list; // values with names only
    for (std::size_t v = 0; v < values.size(); ++v)
        list += fmt::format("{}{} {}", v == 0 ? "" : ", ", gnuplot_text(values[v].name), v);
    const double margin = air == some_air ? 0.5 : 0;
    return fmt::format("unset logscale {0}\nset {0}tics ({1})\nset {0}range [{2}:{3}]\n", axis, list, -margin,
                       static_cast<double>(values.size()) - 1 + margin);
}

/// Draws into both files.
std::string pictures(const std::string& name, int width, int height, const std::string& commands) {
    std::string text;
    for (const auto& [terminal, font, ending] :
         {std::tuple{"svg", "sans,14", "svg"}, std::tuple{"pngcairo", "sans,12", "png"}})
        text += fmt::format("set terminal {} size {},{} font '{}' background 'white'\nset output {}\n{}unset output\n",
                            terminal, width, height, font, gnuplot_text(name + "." + ending), commands);
    return text;
}

std::string curve_plot(const Study& study, const std::vector<StudyCase>& cases, const scene::StudyCurves& plot) {
    const scene::StudyQuantity& q = study.quantities[plot.quantity];
    std::string data, lines;
    Extent extent;
    int n = 0, titles = 0;
    for (const StudyCurve& curve : make_curves(study, cases, plot)) {
        const auto number = static_cast<std::size_t>(n++);
        std::string rows;
        std::size_t before = 0;
        for (const CurvePoint& p : curve.points) {
            if (plot.logarithmic && !(p.y > 0)) continue;
            // no line across a run without a value
            if (!rows.empty() && !plot.over.sampled && p.value > before + 1) rows += "\n";
            before = p.value;
            extent.add(p.y);
            rows += fmt::format("{:.9g} {:.9g}\n", p.x, p.y);
        }
        if (rows.empty()) continue;
        const std::string block = fmt::format("$curve_{}_{}", plot.name, n);
        data += block + " << END\n" + rows + "END\n";
        const char* colour = gnuplot_colours[number % gnuplot_colours.size()];
        titles += curve.name.empty() ? 0 : 1;
        lines += fmt::format("{}{} with {} dt {} lw 1.5 lc rgb '{}' pt 7 ps 0.8 {}", lines.empty() ? "" : ", \\\n     ",
                             block, plot.over.sampled ? "points" : "linespoints", number / gnuplot_colours.size() + 1,
                             colour, curve.name.empty() ? "notitle" : "title " + gnuplot_text(curve.name));
    }
    if (lines.empty()) return {};
    constexpr int least_height = 600, margins = 80, line = 28;
    return data + "set format x '%g'\nset format y '%g'\n" + scale('x', study, plot.over, some_air) +
           scale('y', extent, plot.logarithmic, some_air) +
           fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", gnuplot_text(study.title),
                       gnuplot_text(label_of(plot.over)), gnuplot_text(label_of(q))) +
           pictures(plot.name + "_curves", 1000, std::max(least_height, margins + line * titles),
                    "plot " + lines + "\n");
}

bool drawable(const StudyMap& map) {
    return std::ranges::any_of(map.values, [](const auto& row) {
        return std::ranges::any_of(row, [](double value) { return !std::isnan(value); });
    });
}

std::string contour_plot(const Study& study, const std::vector<StudyCase>& cases, const scene::StudyContours& plot) {
    const scene::StudyQuantity& q = study.quantities[plot.quantity];
    const auto& [x, y] = plot.over;
    std::vector<StudyMap> maps = make_maps(study, cases, plot);
    std::erase_if(maps, [](const StudyMap& map) { return !drawable(map); });
    if (maps.empty()) return {};
    std::string data, commands;
    Extent extent;
    for (std::size_t m = 0; m < maps.size(); ++m) {
        const std::string block = fmt::format("$map_{}_{}", plot.name, m + 1);
        data += block + " << END\n";
        for (std::size_t r = 0; r < maps[m].rows.size(); ++r) {
            for (std::size_t c = 0; c < maps[m].columns.size(); ++c) {
                extent.add(maps[m].values[r][c]);
                data += fmt::format("{:.9g} {:.9g} {:.9g}\n", place_of(study, x, maps[m].columns[c]),
                                    place_of(study, y, maps[m].rows[r]), maps[m].values[r][c]);
            }
            data += "\n";
        }
        data += "END\n";
        commands += fmt::format("set title {}\nsplot {} with pm3d notitle, {} with lines nosurface lc rgb '#111111' "
                                "notitle, {} with points nocontour pt 7 ps 0.4 lc rgb '#111111' notitle\n",
                                gnuplot_text(maps[m].name.empty() ? study.title : maps[m].name), block, block, block);
    }
    const int count = static_cast<int>(maps.size()), across = std::min(count, 3), down = (count + across - 1) / across;
    if (count > 1)
        commands = fmt::format("set multiplot layout {},{} title {} noenhanced\n{}unset multiplot\n", down, across,
                               gnuplot_text(study.title), commands);
    return data + "set format x '%g'\nset format y '%g'\n" + scale('x', study, x, no_air) +
           scale('y', study, y, no_air) +
           // lines of contours take the linetypes one after another: all dark; the same colours in all maps
           (extent.flat() ? "set cbrange [*:*]\n"
                          : fmt::format("set cbrange [{:.9g}:{:.9g}]\n", extent.least, extent.largest)) +
           fmt::format("do for [i=1:40] {{ set linetype i lc rgb '#111111' }}\nset pm3d interpolate 12,12\nset xlabel "
                       "{}\nset ylabel {} offset -2,0\nset cblabel {} noenhanced\nset view map\nset contour base\n"
                       "set cntrparam levels auto 8\nset palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', "
                       "3 '#5ec962', 4 '#fde725')\n",
                       gnuplot_text(label_of(x)), gnuplot_text(label_of(y)), gnuplot_text(label_of(q))) +
           pictures(plot.name + "_contours", count == 1 ? 900 : 700 * across, count == 1 ? 700 : 600 * down, commands) +
           "unset contour\n";
}

} // namespace

std::string curve_plots(const Study& study, const std::vector<StudyCase>& cases) {
    std::string text;
    for (const scene::StudyCurves& plot : study.curves) text += curve_plot(study, cases, plot);
    for (const scene::StudyContours& plot : study.contours) text += contour_plot(study, cases, plot);
    return text;
}

} // namespace osculate::app
