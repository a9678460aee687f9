#pragma once
/// Where this checkout is. A function, so that only one object file depends on the place: compiler caches serve any checkout.

#include <string>

namespace osculate::support {

[[nodiscard]] std::string source_tree();

} // namespace osculate::support
