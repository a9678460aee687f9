#pragma once

namespace osculate::app {

inline constexpr const char* version = "0.2.0"; ///< project version in CMakeLists.txt

} // namespace osculate::app
