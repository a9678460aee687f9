#include "app/report/gnuplot.hpp"
#include "osculate/app/surface_study.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/output/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace osculate::app {

namespace {

double mean_of(const StudyRow& row, const ErrorKind& kind) {
    return (row.errors.*kind.measure).mean;
}

bool refined(const scene::SurfaceStudy& study) {
    return std::holds_alternative<scene::RefinedMeshes>(study.meshes);
}

void write_csv(const StudyResult& result, const std::filesystem::path& path) {
    std::vector<std::string> columns{"surface", "mesh", "facets", "vertices", "size", "method"};
    for (const ErrorKind& kind : error_kinds())
        for (const char* measure : {".mean", ".worst"}) columns.push_back(kind.name + std::string(measure));
    for (const char* count : {"points", "missing", "fallbacks", "cpu_seconds"}) columns.emplace_back(count);
    output::CsvTable table(path, columns);
    for (const StudyRow& r : result.rows) {
        std::vector<output::Cell> cells{r.surface, long{r.mesh}, long{r.facets}, long{r.vertices}, r.size, r.method};
        for (const ErrorKind& kind : error_kinds()) {
            cells.emplace_back((r.errors.*kind.measure).mean);
            cells.emplace_back((r.errors.*kind.measure).worst);
        }
        for (const Index count : {r.errors.points, r.errors.missing, r.fallbacks}) cells.emplace_back(long{count});
        cells.emplace_back(r.cpu_seconds);
        table.row(cells);
    }
}

std::string header(const scene::SurfaceStudy& study, const std::string& first) {
    std::string line = "| " + first + " |", rule = "|---|";
    for (const std::string& method : study.methods) {
        line += " " + method + " |";
        rule += "---|";
    }
    return line + "\n" + rule + "\n";
}

/// Rows are meshes; behind each error the order since the mesh before, or the ratio to the facets' error.
std::string table(const scene::SurfaceStudy& study, const StudyResult& result, const std::string& surface,
                  const ErrorKind& kind) {
    const bool orders = refined(study);
    std::string text = header(study, orders ? "facets, size" : "mesh");
    auto out = std::back_inserter(text);
    const int meshes = result.meshes();
    for (int m = 1; m <= meshes; ++m) {
        const StudyRow& first = result.row(surface, m, study.methods.front());
        if (orders)
            fmt::format_to(out, "| {}, {:.3g} m |", first.facets, first.size);
        else
            fmt::format_to(out, "| {} ({} facets) |", m, first.facets);
        for (const std::string& method : study.methods) {
            const StudyRow& row = result.row(surface, m, method);
            fmt::format_to(out, " {:.3g}", mean_of(row, kind));
            if (!orders)
                fmt::format_to(out, " ({:.3f})", mean_of(row, kind) / mean_of(first, kind));
            else if (m > 1)
                fmt::format_to(out, " ({:.2f})", fitted_order({&result.row(surface, m - 1, method), &row}, kind));
            text += " |";
        }
        text += "\n";
    }
    text += orders ? "| fitted order |" : "| geometric mean of ratios |";
    for (const std::string& method : study.methods) {
        std::vector<const StudyRow*> rows;
        double log_ratio = 0;
        for (int m = 1; m <= meshes; ++m) {
            rows.push_back(&result.row(surface, m, method));
            log_ratio +=
                std::log(mean_of(*rows.back(), kind) / mean_of(result.row(surface, m, study.methods.front()), kind)) /
                meshes;
        }
        text +=
            orders ? fmt::format(" {:.2f} |", fitted_order(rows, kind)) : fmt::format(" {:.3f} |", std::exp(log_ratio));
    }
    return text + "\n";
}

std::string published_ratio(const scene::PublishedRatios& published, const std::string& kind) {
    const auto value = kind == "position" ? published.position : kind == "normal" ? published.normal : std::nullopt;
    return value ? fmt::format("; published ratio of height_1 to facets: {:.3f}", *value) : "";
}

std::string markdown(const scene::SurfaceStudy& study, const StudyResult& result) {
    std::string text = "# " + study.title + "\n";
    auto out = std::back_inserter(text);
    text += "\nMean errors over the area; in brackets ";
    text += refined(study) ? "the order since the mesh before.\n"
                           : fmt::format("the ratio to `{}`.\n", study.methods.front());
    for (const auto& [name, surface] : study.surfaces) {
        for (const ErrorKind& kind : error_kinds())
            fmt::format_to(out, "\n## {}: {}, {}{}\n\n{}", name, kind.name, kind.unit,
                           refined(study) ? "" : published_ratio(surface.published, kind.name),
                           table(study, result, name, kind));
        for (const StudyRow& r : result.rows)
            if (r.surface == name && r.errors.missing > 0)
                fmt::format_to(out, "\n{} has no point at {} of {} samples of mesh {}; its means leave them out.\n",
                               r.method, r.errors.missing, r.errors.points, r.mesh);
    }
    return text;
}

/// Name of a block of data, where gnuplot wants no '-'.
std::string block_of(std::string surface, const ErrorKind& kind) {
    std::ranges::replace(surface, '-', '_');
    return fmt::format("${}_{}", surface, kind.name);
}

/// Means of one surface, a line a mesh: number or size, then the methods' errors, per kind.
std::string data_block(const scene::SurfaceStudy& study, const StudyResult& result, const std::string& surface,
                       const ErrorKind& kind) {
    std::string text = block_of(surface, kind) + " << END\n";
    for (int m = 1; m <= result.meshes(); ++m) {
        const StudyRow& first = result.row(surface, m, study.methods.front());
        text += refined(study) ? fmt::format("{:.8g}", first.size) : fmt::format("{}", m);
        for (const std::string& method : study.methods) {
            const double mean = mean_of(result.row(surface, m, method), kind);
            text += fmt::format(" {:.8g}", refined(study) ? mean : mean / mean_of(first, kind));
        }
        text += "\n";
    }
    return text + "END\n";
}

/// Place of a method among all: each has its own colour in every plot.
int number_of(const std::string& method) {
    const auto& names = study::method_names();
    return 1 + static_cast<int>(std::ranges::find(names, method) - names.begin());
}

std::string plot(const scene::SurfaceStudy& study, const std::string& surface, const scene::PublishedRatios& published,
                 const ErrorKind& kind) {
    const std::string data = block_of(surface, kind);
    std::string text = refined(study)
                           ? fmt::format("set ylabel {}\n", gnuplot_text("mean error, " + std::string(kind.unit)))
                           : std::string("set ylabel 'mean error / that of the facets'\n");
    text += fmt::format("set title {} noenhanced\nplot ", gnuplot_text(surface + ": " + kind.name));
    for (std::size_t i = 0; i < study.methods.size(); ++i)
        text += fmt::format("{} using 1:{} with linespoints linetype {} title {}, ", data, i + 2,
                            number_of(study.methods[i]), gnuplot_text(study.methods[i]));
    if (refined(study)) {
        for (const int order : {1, 2, 3, 4}) // through the facets' coarsest error
            text += fmt::format("e0*(x/h0)**{} with lines dashtype 3 linecolor 'grey' title '{}', ", order,
                                order == 1 ? "orders 1 to 4" : "");
        const std::string set = fmt::format("h0 = real(word({0}[1], 1)); e0 = real(word({0}[1], 2))\n", data);
        return set + text.substr(0, text.size() - 2) + "\n";
    }
    const auto value = std::string(kind.name) == "position" ? published.position
                       : std::string(kind.name) == "normal" ? published.normal
                                                            : std::nullopt;
    if (value) text += fmt::format("{} with lines dashtype 2 linecolor 'black' title 'published', ", *value);
    return text.substr(0, text.size() - 2) + "\n";
}

std::string gnuplot_script(const scene::SurfaceStudy& study, const StudyResult& result) {
    std::string text = "set key at graph 0.5, screen 0.02 center bottom maxrows 3 samplen 2 noenhanced\nset bmargin 9\n"
                       "set logscale y\nset format y '10^{%L}'\nset grid\n";
    int line = 0; // one colour a method, in the order of their names
    for (const char* colour : {"#808080", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#0072b2", "#332288",
                               "#44aa99", "#ddcc77", "#882255", "#117733"})
        text += fmt::format("set linetype {} linewidth 1.5 linecolor rgb '{}'\n", ++line, colour);
    text += refined(study) ? "set logscale x\nset xlabel 'mean facet size, m' noenhanced\n"
                           : fmt::format("set xlabel 'mesh'\nset xrange [0.5:{}.5]\nset xtics 1\n", result.meshes());
    for (const auto& [name, surface] : study.surfaces) {
        for (const ErrorKind& kind : error_kinds()) text += data_block(study, result, name, kind);
        for (const auto& [terminal, ending] :
             {std::pair{"svg size 1500,600 background 'white'", "svg"}, std::pair{"pngcairo size 1500,600", "png"}}) {
            text += fmt::format("set terminal {}\nset output {}\nset multiplot layout 1,3\n", terminal,
                                gnuplot_text("study_" + name + "." + ending));
            for (const ErrorKind& kind : error_kinds()) text += plot(study, name, surface.published, kind);
            text += "unset multiplot\nunset output\n";
        }
    }
    return text;
}

} // namespace

std::vector<std::string> surface_study_files(const scene::SurfaceStudy& study) {
    std::vector<std::string> files{"study.csv", "study.md", "study.gp"};
    for (const auto& [name, surface] : study.surfaces)
        for (const char* ending : {".svg", ".png"}) files.push_back("study_" + name + ending);
    return files;
}

std::string write_surface_study(const scene::SurfaceStudy& study, const StudyResult& result,
                                output::OutputFolder& files) {
    const std::filesystem::path& folder = files.path();
    files.claim(surface_study_files(study));
    write_csv(result, folder / "study.csv");
    write_text(folder / "study.md", markdown(study, result));
    write_text(folder / "study.gp", gnuplot_script(study, result));
    switch (run_gnuplot(folder, "study.gp")) {
    case Gnuplot::drawn: return "plots " + (folder / "study_*.svg").string() + " and .png";
    case Gnuplot::missing: return "no plots: gnuplot is not installed; study.gp draws them later";
    case Gnuplot::failed: break;
    }
    return "no plots: gnuplot failed on study.gp";
}

} // namespace osculate::app
