#include "app/report/gnuplot.hpp"

#include "app/report/external_program.hpp"
#include "osculate/core/printable.hpp"

#include <cmath>
#include <fmt/format.h>

namespace osculate::app {

/// Between double quotes, with octal codes for all that means anything to any of gnuplot's readers, which look at lines one
/// after another: quotes, escapes, commands of the shell in backticks, macros, comments, braces of blocks. Single quotes would not
/// do: gnuplot ends such a string at a doubled quote that it begins with.
std::string gnuplot_text(std::string_view text) {
    constexpr std::string_view meaningful = "\"'\\`@#{}";
    std::string result = "\"";
    bool after_code = false;
    for (const char c : text) {
        // gnuplot takes a fourth digit for part of a code that begins with 0
        const bool code = meaningful.find(c) != std::string_view::npos || (after_code && c >= '0' && c <= '9');
        result += is_control(c) ? std::string(" ")
                  : code        ? fmt::format("\\{:03o}", static_cast<unsigned char>(c))
                                : std::string(1, c);
        after_code = code;
    }
    return result + "\"";
}

std::string gnuplot_log_tics(double least, double largest) {
    constexpr double few_decades = 100;
    if (largest > few_decades * least) return "autofreq";
    std::string list;
    for (int decade = static_cast<int>(std::floor(std::log10(least))) - 1; std::pow(10, decade) < 2 * largest; ++decade)
        for (const int digit : {1, 2, 3, 5, 7}) {
            const double at = digit * std::pow(10, decade);
            if (at > least / 2 && at < 2 * largest)
                list += fmt::format("{}'{:.3g}' {:.6g}", list.empty() ? "" : ", ", at, at);
        }
    return "(" + list + ")";
}

Gnuplot run_gnuplot(const std::filesystem::path& folder, const std::string& script, bool quiet) {
    switch (run_external(folder, {"gnuplot", script}, quiet)) {
    case External::done: return Gnuplot::drawn;
    case External::missing: return Gnuplot::missing;
    case External::failed: break;
    }
    return Gnuplot::failed;
}

} // namespace osculate::app
