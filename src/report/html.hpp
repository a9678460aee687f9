#pragma once
/// Pieces of HTML. Texts given are plain and are escaped here; only what is called `inner` is HTML already.

#include "osculate/report/encode.hpp"

#include <string>
#include <vector>

namespace osculate::report {

[[nodiscard]] inline std::string element(const std::string& tag, const std::string& inner) {
    return "<" + tag + ">" + inner + "</" + tag.substr(0, tag.find(' ')) + ">";
}

/// A table with a head; cells are plain texts.
/// @param numbers  columns of numbers, set to the right
[[nodiscard]] std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows,
                                const std::vector<std::size_t>& numbers = {});

/// @param id  fit for an attribute
[[nodiscard]] std::string section(const std::string& id, const std::string& title, const std::string& inner);

/// 12 345 678, with narrow spaces; a dash where it is no number.
[[nodiscard]] std::string count(double value);

/// Three digits and a prefixed unit: "1.25 mm"; a dash where it is no number.
[[nodiscard]] std::string measure(double value, const std::string& unit);

/// Three digits, as 1.2e-10 where it is very small or large.
[[nodiscard]] std::string figure(double value);

} // namespace osculate::report
