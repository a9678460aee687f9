#pragma once
/// Pictures by an external program that need not be there.

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace osculate::app {

/// Colours of curves, told apart by most eyes.
inline constexpr std::array gnuplot_colours{"#d55e00", "#0072b2", "#111111", "#009e73", "#cc79a7", "#e69f00",
                                            "#56b4e9", "#882255", "#44aa99", "#999933", "#332288", "#808080"};

/// A text as gnuplot's scripts hold it, quotes included: the one way that a text gets into a script. What gnuplot prints of it
/// is the text, byte for byte, with a space for every control character.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

/// Places of tics of a logarithmic axis, as gnuplot takes them: its own where there are decades enough, else "('0.2' 0.2, '0.5' 0.5)".
[[nodiscard]] std::string gnuplot_log_tics(double least, double largest);

enum class Gnuplot { drawn, missing, failed };

/// Runs gnuplot on a script in its folder and waits for it. @param quiet  its warnings are of no concern
[[nodiscard]] Gnuplot run_gnuplot(const std::filesystem::path& folder, const std::string& script, bool quiet = false);

} // namespace osculate::app
