#pragma once
/// JSON files of a run.

#include "output/files.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace osculate::output {

/// Writes indented JSON as write_atomic does; bytes that are not UTF-8 are replaced, numbers that are not finite are null.
inline void write_json_atomic(const std::filesystem::path& path, const nlohmann::ordered_json& value) {
    write_atomic(path, value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

} // namespace osculate::output
