#pragma once
/// Faults of a scene that its text alone does not show.

#include "osculate/core/error.hpp"

#include <string>
#include <utility>

namespace osculate::app {

inline Fault fault(std::string key, std::string expected, std::string found) {
    Fault f;
    f.key = std::move(key);
    f.expected = std::move(expected);
    f.found = std::move(found);
    return f;
}

} // namespace osculate::app
