#pragma once

namespace osculate::app {

inline constexpr const char* version = "0.1.0"; ///< the project's in CMakeLists.txt

} // namespace osculate::app
