#pragma once
/// Text within markup.

#include <string>
#include <string_view>

namespace osculate {

/// Escapes text for HTML and XML, within elements and within quoted attributes; removes characters that end or break a
/// page.
[[nodiscard]] std::string escaped(std::string_view text);

} // namespace osculate
