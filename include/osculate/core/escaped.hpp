#pragma once
/// Text within markup.

#include <string>
#include <string_view>

namespace osculate {

/// Text for HTML and XML, within elements and within quoted attributes; characters that end or break a page are gone.
[[nodiscard]] std::string escaped(std::string_view text);

} // namespace osculate
