#include "report/html.hpp"

#include "osculate/core/escaped.hpp"
#include "osculate/scene/outline.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace osculate::report {

std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows,
                  const std::vector<std::size_t>& numbers) {
    const auto line = [&](const std::vector<std::string>& cells, const std::string& tag) {
        std::string text;
        for (std::size_t c = 0; c < cells.size(); ++c)
            text += element(tag + (std::ranges::count(numbers, c) > 0 ? " class=\"number\"" : ""), escaped(cells[c]));
        return element("tr", text);
    };
    std::string body;
    for (const auto& row : rows) body += line(row, "td") + "\n";
    return "<div class=\"scrolls\">" +
           element("table", element("thead", line(head, "th")) + "\n" + element("tbody", body)) + "</div>\n";
}

std::string section(const std::string& id, const std::string& title, const std::string& inner) {
    return "<section id=\"" + id + "\">\n" + element("h2", escaped(title)) + "\n" + inner + "</section>\n";
}

std::string count(double value) {
    if (!std::isfinite(value)) return "–";
    const std::string digits = fmt::format("{:.0f}", value);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0 && digits[i - 1] != '-' && digits.size() > 4) text += "\u202f";
        text += digits[i];
    }
    return text;
}

std::string measure(double value, const std::string& unit) {
    if (!std::isfinite(value)) return "–";
    return scene::engineering(std::stod(fmt::format("{:.3g}", value)), unit);
}

std::string figure(double value) {
    return std::isfinite(value) ? fmt::format("{:.3g}", value) : "–";
}

} // namespace osculate::report
