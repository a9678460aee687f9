#pragma once
/// A YAML document as a plain tree that knows where every key and value stood.

#include "osculate/core/error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace osculate::scene {

struct Place {
    std::string file{};
    int line = 0, column = 0; ///< 1-based; 0 where there is none
};

struct Tree {
    enum class Kind { null, scalar, list, map };
    Kind kind = Kind::null;
    std::string scalar{};
    std::string key{};            ///< under which it stands in its map; empty in a list
    std::vector<Tree> children{}; ///< of a list or a map, in the order of the file
    Place place{};                ///< of the value
    Place key_place{};
    bool implied = false; ///< a map made only because an override went inside it

    [[nodiscard]] const Tree* find(std::string_view name) const;
    [[nodiscard]] Tree* find(std::string_view name);

    /// What stands here, for a message: "'3 m'", "a list", "a map", "nothing".
    [[nodiscard]] std::string found() const;
};

/// Name by which places of overrides go.
inline constexpr const char* override_file = "--set";

/// Parses one document. Syntax errors, duplicate keys, keys that are no scalars and texts with control characters become
/// faults; the rest is kept.
/// @param with_lines  keys whose texts may have line breaks
[[nodiscard]] Tree parse_yaml(const std::string& text, const std::string& file, std::vector<Fault>& faults,
                              const std::vector<std::string>& with_lines = {});

/// The same for a file; an unreadable file becomes a fault.
[[nodiscard]] Tree read_yaml(const std::string& path, std::vector<Fault>& faults,
                             const std::vector<std::string>& with_lines = {});

/// Fault at a place.
[[nodiscard]] Fault fault_at(const Place& place, std::string key, std::string expected, std::string found,
                             std::string nearest_name = {});

/// "a, b, c", shortened when long.
[[nodiscard]] std::string join(const std::vector<std::string>& words, const char* separator = ", ");

} // namespace osculate::scene
