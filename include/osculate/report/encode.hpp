#pragma once
/// Bytes made small, and made fit for the text of a page.

#include <cstdint>
#include <string>
#include <vector>

namespace osculate::report {

using Bytes = std::vector<std::uint8_t>;

/// In zlib's format, which browsers call "deflate". Same bytes, same result.
[[nodiscard]] Bytes deflated(const Bytes& bytes);
/// @throws std::runtime_error where the bytes are none of deflated()
[[nodiscard]] Bytes inflated(const Bytes& bytes);

[[nodiscard]] std::string base64(const Bytes& bytes);

} // namespace osculate::report
