#include "app/report/gnuplot.hpp"
#include "app/study/study_curves.hpp"
#include "app/study/study_files.hpp"
#include "app/study/study_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace osculate::app {

namespace {

namespace fs = std::filesystem;

constexpr std::array points{7, 5, 9, 11, 13, 6, 4, 8, 10, 12};

std::string identifier(std::string name) {
    for (char& c : name)
        if (c == '-') c = '_';
    return name;
}

bool drawable(const study::CostPoint& p) {
    return std::isfinite(p.cost) && std::isfinite(p.error) && p.cost > 0 && p.error > 0;
}

/// One plot: data blocks and the plot command, for series of points.
class Plot {
public:
    explicit Plot(std::string name) : name_(std::move(name)) {}

    void add(const StudySeries& series, const std::vector<study::CostPoint>& data) {
        std::string rows = rows_of(data);
        if (rows.empty()) return;
        ++titles_;
        const auto law = study::fit_power_law(data);
        const char* colour = gnuplot_colours[static_cast<std::size_t>(series.colour) % gnuplot_colours.size()];
        const int point = points[static_cast<std::size_t>(series.style) % points.size()];
        const std::string title = law ? fmt::format("{} ({:.2f})", series.name, law->slope) : series.name;
        add_line(block(rows), fmt::format("with linespoints dt {} lw 1.5 lc rgb '{}' pt {} ps 0.8 title {}",
                                          series.style % 5 + 1, colour, point, gnuplot_text(title)));
        if (!law) return;
        rows = fmt::format("{:.6g} {:.6g}\n{:.6g} {:.6g}\n", law->least, (*law)(law->least), law->largest,
                           (*law)(law->largest));
        add_line(block(rows), fmt::format("with lines dt 3 lw 1 lc rgb '{}' notitle", colour));
    }

    void add_front(const std::vector<study::CostPoint>& front) {
        const std::string rows = rows_of(front);
        if (rows.empty()) return;
        ++titles_;
        add_line(block(rows), "with points pt 6 ps 2 lw 1.5 lc rgb '#e41a1c' title 'Pareto front'");
    }

    /// Draws both files; nothing where there is no point.
    [[nodiscard]] std::string script(const std::string& title, const std::string& x, const std::string& y) const {
        if (lines_.empty()) return {};
        // a key of too many titles would break into columns over the curves
        constexpr int least_height = 600, margins = 80, line = 28;
        const int height = std::max(least_height, margins + line * titles_);
        std::string text =
            data_ + fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset xrange {}\nset yrange {}\n"
                                "set xtics {}\nset ytics {}\n",
                                gnuplot_text(title), gnuplot_text(x), gnuplot_text(y), x_.range(), y_.range(),
                                x_.tics(), y_.tics());
        for (const auto& [terminal, font, ending] :
             {std::tuple{"svg", "sans,14", "svg"}, std::tuple{"pngcairo", "sans,12", "png"}})
            text += fmt::format("set terminal {} size 1000,{} font '{}' background 'white'\nset output {}\n"
                                "plot {}\nunset output\n",
                                terminal, height, font, gnuplot_text(name_ + "." + ending), lines_);
        return text;
    }

private:
    std::string rows_of(const std::vector<study::CostPoint>& data) {
        std::string rows;
        for (const study::CostPoint& p : data) {
            if (!drawable(p)) continue;
            rows += fmt::format("{:.6g} {:.6g}\n", p.cost, p.error);
            x_.add(p.cost);
            y_.add(p.error);
        }
        return rows;
    }
    std::string block(const std::string& rows) {
        const std::string name = fmt::format("${}_{}", identifier(name_), ++blocks_);
        data_ += name + " << END\n" + rows + "END\n";
        return name;
    }
    void add_line(const std::string& block, const std::string& style) {
        lines_ += (lines_.empty() ? "" : ", \\\n     ") + block + " " + style;
    }

    struct Extent {
        double least = std::numeric_limits<double>::infinity(), largest = 0;
        void add(double value) {
            least = std::min(least, value);
            largest = std::max(largest, value);
        }
        /// "[0.1:2]", with some air.
        [[nodiscard]] std::string range() const {
            constexpr double air = 1.25;
            return fmt::format("[{:.6g}:{:.6g}]", least / air, largest * air);
        }
        [[nodiscard]] std::string tics() const { return gnuplot_log_tics(least, largest); }
    };

    std::string name_, data_, lines_;
    Extent x_, y_;
    int blocks_ = 0, titles_ = 0;
};

std::string plots_of(const scene::Study& study, const std::vector<StudyCase>& cases,
                     const std::vector<StudySeries>& series, std::size_t k) {
    const scene::StudyQuantity& q = study.quantities[k];
    const bool relative = is_relative(q, cases, k);
    const std::string error = (relative ? "relative error of " : "error of ") + q.label +
                              (relative || q.unit.empty() || !q.scale.empty() ? "" : ", " + q.unit);
    Plot work(q.name + "_work");
    for (const StudySeries& s : series) work.add(s, work_points(s, k));
    std::vector<study::CostPoint> front;
    for (const StudyCase* c : pareto_cases(study, cases, k))
        front.push_back({c->record.median(&StudyRepeat::cpu), c->results[k].error});
    work.add_front(front);
    std::string text = work.script(study.title + ": slopes in brackets", "CPU seconds", error);
    if (study.refine < 0) return text;
    Plot convergence(q.name + "_convergence");
    for (const StudySeries& s : series) convergence.add(s, convergence_points(study, s, k));
    return text + convergence.script(study.title + ": slopes in brackets", abscissa_label(study), error);
}

} // namespace

std::string write_study_plots(const scene::Study& study, const std::vector<StudyCase>& cases, const fs::path& folder) {
    const std::vector<StudySeries> series = make_series(study, cases);
    std::string plots;
    for (std::size_t k = 0; k < study.quantities.size(); ++k)
        if (study.quantities[k].has_error() && study.quantities[k].plot) plots += plots_of(study, cases, series, k);
    plots += curve_plots(study, cases);
    if (plots.empty()) return "nothing to plot";
    {
        std::ofstream file(folder / "study.gp", std::ios::binary);
        file << "set encoding utf8\nset logscale xy\nset format x '10^{%L}'\nset format y '10^{%L}'\n"
                "set grid xtics ytics mxtics mytics lc rgb '#cccccc', lc rgb '#eeeeee'\n"
                "set key outside right top samplen 3 spacing 1.2 noenhanced\nset title noenhanced\n"
                "set xlabel noenhanced\nset ylabel noenhanced\n"
             << plots;
        if (!file.flush()) throw std::runtime_error("cannot write " + (folder / "study.gp").string());
    }
    switch (run_gnuplot(folder, "study.gp")) {
    case Gnuplot::drawn: return "plots *.svg and *.png";
    case Gnuplot::missing: return "no plots: gnuplot is not installed; study.gp draws them later";
    case Gnuplot::failed: break;
    }
    return "no plots: gnuplot failed on study.gp";
}

} // namespace osculate::app
