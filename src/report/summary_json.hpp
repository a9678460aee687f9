#pragma once
/// Members of summary.json, which may be missing or of another type: then NaN, an empty object, list or text.

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace osculate::report {

inline double member(const nlohmann::json& object, const char* name) {
    const auto at = object.find(name);
    return at != object.end() && at->is_number() ? at->get<double>() : std::nan("");
}

inline nlohmann::json object(const nlohmann::json& parent, const char* name) {
    const auto at = parent.find(name);
    return at != parent.end() && at->is_object() ? *at : nlohmann::json::object();
}

inline nlohmann::json list(const nlohmann::json& parent, const char* name) {
    const auto at = parent.find(name);
    return at != parent.end() && at->is_array() ? *at : nlohmann::json::array();
}

inline std::string word(const nlohmann::json& object, const char* name) {
    const auto at = object.find(name);
    return at != object.end() && at->is_string() ? at->get<std::string>() : "";
}

} // namespace osculate::report
