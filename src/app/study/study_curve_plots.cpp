#include "app/report/gnuplot.hpp"
#include "app/study/study_curves.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <tuple>
#include <vector>

namespace osculate::app {

namespace {

using scene::Study;
using scene::StudyCoordinate;

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
std::string scale(char axis, const Extent& extent, bool logarithmic) {
    if (extent.flat()) { // gnuplot warns of a range that is none
        const double half = extent.least == 0 ? 1 : 0.1 * std::abs(extent.least);
        return fmt::format("unset logscale {0}\nset {0}range [{1:.9g}:{2:.9g}]\nset {0}tics autofreq\n", axis,
                           extent.least - half, extent.least + half);
    }
    if (!logarithmic) return fmt::format("unset logscale {0}\nset autoscale {0}\nset {0}tics autofreq\n", axis);
    constexpr double air = 1.1;
    return fmt::format("set logscale {0}\nset {0}range [{1:.9g}:{2:.9g}]\nset {0}tics {3}\n", axis, extent.least / air,
                       extent.largest * air, gnuplot_log_tics(extent.least, extent.largest));
}

std::string names_as_tics(char axis, const Study& study, const StudyCoordinate& over) {
    std::string list;
    const auto& values = study.axes[over.axis].values;
    for (std::size_t v = 0; v < values.size(); ++v)
        list += fmt::format("{}{} {}", v == 0 ? "" : ", ", gnuplot_text(values[v].name), v);
    return fmt::format("unset logscale {0}\nset {0}tics ({1})\n", axis, list);
}

std::string scale(char axis, const Study& study, const StudyCoordinate& over) {
    const auto& values = study.axes[over.axis].values;
    if (!study.place_of(over, 0))
        return names_as_tics(axis, study, over) + fmt::format("set {}range [-0.5:{}.5]\n", axis, values.size() - 1);
    Extent extent;
    for (std::size_t v = 0; v < values.size(); ++v) extent.add(place_of(study, over, v));
    return scale(axis, extent, over.logarithmic);
}

/// Of a map that reaches from `least` to `largest`.
std::string map_scale(char axis, const Study& study, const StudyCoordinate& over, double least, double largest) {
    const std::string range = fmt::format("set {}range [{:.12g}:{:.12g}]\n", axis, least, largest);
    if (!study.place_of(over, 0)) return names_as_tics(axis, study, over) + range;
    if (!over.logarithmic) return fmt::format("unset logscale {0}\nset {0}tics autofreq\n", axis) + range;
    return fmt::format("set logscale {0}\nset {0}tics {1}\n", axis, gnuplot_log_tics(least, largest)) + range;
}

/// Borders of cells around the places of an axis, halfway between them; one more than there are places.
std::vector<double> borders(const std::vector<double>& places, bool logarithmic) {
    const auto along = [&](double x) { return logarithmic ? std::log(x) : x; };
    const auto back = [&](double x) { return logarithmic ? std::exp(x) : x; };
    std::vector<double> result;
    const std::size_t n = places.size();
    for (std::size_t i = 0; i <= n; ++i) {
        const std::size_t right = std::clamp<std::size_t>(i, 1, n - 1), left = right - 1;
        const double middle = 0.5 * (along(places[left]) + along(places[right]));
        const double half = 0.5 * (along(places[right]) - along(places[left]));
        result.push_back(back(i == 0 ? middle - 2 * half : i == n ? middle + 2 * half : middle));
    }
    return result;
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
    return data + "set format x '%g'\nset format y '%g'\n" + scale('x', study, plot.over) +
           scale('y', extent, plot.logarithmic) +
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

bool whole(const StudyMap& map) {
    return std::ranges::none_of(map.values, [](const auto& row) {
        return std::ranges::any_of(row, [](double value) { return std::isnan(value); });
    });
}

/// One map: data, and the commands that draw it. Colours run from run to run, with lines of equal value, where every run has a
/// value; else each run has a cell, and those without stay empty.
struct DrawnMap {
    std::string data, commands;
};

DrawnMap drawn(const Study& study, const scene::StudyContours& plot, const StudyMap& map, const std::string& block) {
    const auto& [x, y] = plot.over;
    std::vector<double> across, up;
    for (const std::size_t v : map.columns) across.push_back(place_of(study, x, v));
    for (const std::size_t v : map.rows) up.push_back(place_of(study, y, v));
    const std::vector<double> left = borders(across, x.logarithmic), below = borders(up, y.logarithmic);
    const bool cells = !whole(map);
    DrawnMap drawn;
    drawn.data = block + " << END\n";
    for (std::size_t r = 0; r < up.size(); ++r) {
        for (std::size_t c = 0; c < across.size(); ++c) {
            if (std::isnan(map.values[r][c])) continue;
            drawn.data += fmt::format("{:.12g} {:.12g}", across[c], up[r]);
            if (cells)
                drawn.data +=
                    fmt::format(" {:.12g} {:.12g} {:.12g} {:.12g}", left[c], left[c + 1], below[r], below[r + 1]);
            drawn.data += fmt::format(" {:.9g}\n", map.values[r][c]);
        }
        drawn.data += "\n";
    }
    drawn.data += "END\n";
    drawn.commands = fmt::format("set ylabel offset {},0\nset title {}\n", cells ? 0 : -2,
                                 gnuplot_text(map.name.empty() ? study.title : map.name));
    if (cells)
        return {drawn.data,
                drawn.commands + map_scale('x', study, x, left.front(), left.back()) +
                    map_scale('y', study, y, below.front(), below.back()) +
                    fmt::format("plot {0} using 1:2:3:4:5:6:7 with boxxyerror fill solid lc palette notitle, {0} "
                                "using 1:2 with points pt 7 ps 0.4 lc rgb '#111111' notitle\n",
                                block)};
    // a tic at the very end would be lost
    const double over =
        x.logarithmic ? across.back() * (1 + 1e-9) : across.back() + 1e-9 * (across.back() - across.front());
    const double above = y.logarithmic ? up.back() * (1 + 1e-9) : up.back() + 1e-9 * (up.back() - up.front());
    return {drawn.data,
            drawn.commands + map_scale('x', study, x, across.front(), over) +
                map_scale('y', study, y, up.front(), above) +
                fmt::format("splot {0} with pm3d notitle, {0} with lines nosurface lc rgb '#111111' notitle, {0} "
                            "with points nocontour pt 7 ps 0.4 lc rgb '#111111' notitle\n",
                            block)};
}

std::string contour_plot(const Study& study, const std::vector<StudyCase>& cases, const scene::StudyContours& plot) {
    const scene::StudyQuantity& q = study.quantities[plot.quantity];
    std::vector<StudyMap> maps = make_maps(study, cases, plot);
    std::erase_if(maps, [](const StudyMap& map) { return !drawable(map); });
    if (maps.empty()) return {};
    std::string data, commands;
    Extent extent;
    for (std::size_t m = 0; m < maps.size(); ++m) {
        for (const auto& row : maps[m].values)
            for (const double value : row) extent.add(value);
        const DrawnMap one = drawn(study, plot, maps[m], fmt::format("$map_{}_{}", plot.name, m + 1));
        data += one.data;
        commands += one.commands;
    }
    const int count = static_cast<int>(maps.size()), across = std::min(count, 3), down = (count + across - 1) / across;
    if (count > 1)
        commands = fmt::format("set multiplot layout {},{} title {} noenhanced\n{}unset multiplot\n", down, across,
                               gnuplot_text(study.title), commands);
    const double half = extent.flat() ? (extent.least == 0 ? 1 : 0.1 * std::abs(extent.least)) : 0;
    // lines of contours take the linetypes one after another: all dark
    return data + "set format x '%g'\nset format y '%g'\n" +
           fmt::format(
               "set cbrange [{:.9g}:{:.9g}]\ndo for [i=1:40] {{ set linetype i lc rgb '#111111' }}\n"
               "set pm3d interpolate 12,12\nset xlabel {}\nset ylabel {}\nset cblabel {} noenhanced\n"
               "set view map\nset contour base\nset cntrparam levels auto 8\nset palette defined (0 '#440154', 1 "
               "'#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n",
               extent.least - half, extent.largest + half, gnuplot_text(label_of(plot.over[0])),
               gnuplot_text(label_of(plot.over[1])), gnuplot_text(label_of(q))) +
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
