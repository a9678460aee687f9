#include "app/run_report_plots.hpp"

#include "app/gnuplot.hpp"
#include "osculate/output/csv_reader.hpp"

#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

struct Curve {
    std::size_t column; ///< of history.csv, from 1
    std::string title;
};

/// Text within single quotes of gnuplot.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

/// Both files of one plot of history.csv; nothing without curves.
std::string plot(const std::string& name, const std::string& title, const std::string& y,
                 const std::vector<Curve>& curves, const std::string& style = "lines lw 1.5",
                 const std::string& range = "*:*") {
    if (curves.empty()) return "";
    std::string lines;
    for (const Curve& curve : curves)
        lines += fmt::format("{} '../history.csv' using 1:{} with {} title {}", lines.empty() ? "" : ", \\\n    ",
                             curve.column, style, quoted(curve.title));
    std::string text = fmt::format("set title {}\nset ylabel {}\nset yrange [{}]\n", quoted(title), quoted(y), range);
    for (const auto& [terminal, ending] : {std::pair{"svg", "svg"}, std::pair{"pngcairo", "png"}})
        text +=
            fmt::format("set terminal {} size 1000,600 font 'sans,13' background 'white'\nset output '{}.{}'\nplot{}\n"
                        "unset output\n",
                        terminal, name, ending, lines);
    return text;
}

std::string script(const std::vector<std::string>& names) {
    std::vector<Curve> contact, reactions, energies, steps;
    for (std::size_t c = 0; c < names.size(); ++c) {
        const std::string& name = names[c];
        const Curve curve{c + 1, name};
        if (name.starts_with("pair.") && (name.ends_with(".normal") || name.ends_with(".friction")))
            contact.push_back(curve);
        if (name.starts_with("set.")) reactions.push_back(curve);
        if (name.starts_with("energy.")) energies.push_back(curve);
        if (name == "dt") steps.push_back(curve);
    }
    return "set encoding utf8\nset datafile separator ','\nset datafile columnheaders\nset grid lc rgb '#dddddd'\n"
           "set key outside right top samplen 3 noenhanced\nset title noenhanced\nset xlabel 'time, s'\n"
           "set format y '%.3s %c'\n" +
           plot("contact", "Contact forces: sums of the nodes'", "N", contact) +
           plot("reactions", "Reactions", "N", reactions) + plot("energies", "Energies", "J", energies) +
           plot("steps", "Accepted steps", "dt, s", steps, "steps lw 1.5", "0:*");
}

} // namespace

std::string write_report_plots(const fs::path& run_folder) {
    output::NumberTable history;
    try {
        history = output::read_numbers(run_folder / "history.csv");
    } catch (const std::runtime_error&) { // the page has said so
        return "";
    }
    if (history.names.empty() || history.columns.front().empty()) return "";
    const fs::path folder = run_folder / "report";
    {
        std::ofstream file(folder / "plots.gp", std::ios::binary);
        file << script(history.names);
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
