#include "osculate/core/error.hpp"

#include <utility>

namespace osculate {

std::string Fault::message() const {
    std::string text = file.empty() ? std::string("scene") : file;
    if (line > 0) text += ":" + std::to_string(line) + ":" + std::to_string(column);
    text += ": ";
    if (!key.empty()) text += key + ": ";
    if (!expected.empty()) text += "expected " + expected;
    if (!found.empty()) text += (expected.empty() ? "found " : ", found ") + found;
    if (!nearest.empty()) text += " (did you mean '" + nearest + "'?)";
    return text;
}

namespace {
std::string join(const std::vector<Fault>& faults) {
    std::string text;
    for (const Fault& fault : faults) text += (text.empty() ? "" : "\n") + fault.message();
    return text;
}
} // namespace

SceneError::SceneError(std::vector<Fault> faults) : std::runtime_error(join(faults)), faults_(std::move(faults)) {}

} // namespace osculate
