#pragma once
/// Which of several texts a long one holds; a failure does not print the long one.

#include <string>
#include <vector>

namespace osculate::support {

[[nodiscard]] inline std::vector<std::string> missing(const std::string& text, const std::vector<std::string>& wanted) {
    std::vector<std::string> list;
    for (const std::string& one : wanted)
        if (text.find(one) == std::string::npos) list.push_back(one);
    return list;
}

[[nodiscard]] inline std::vector<std::string> found(const std::string& text, const std::vector<std::string>& unwanted) {
    std::vector<std::string> list;
    for (const std::string& one : unwanted)
        if (text.find(one) != std::string::npos) list.push_back(one);
    return list;
}

} // namespace osculate::support
