#pragma once
/// Files of report_page/ and the browser libraries, which the program carries along.

#include <string_view>
#include <vector>

namespace osculate::report {

struct Asset {
    std::string_view name, content;
};

/// In the order of report_page/, libraries last. Those not there at build time are missing.
[[nodiscard]] const std::vector<Asset>& assets();

/// Content of a file; empty where there is none.
[[nodiscard]] std::string_view asset(std::string_view name);

} // namespace osculate::report
