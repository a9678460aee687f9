#pragma once
/// Compression of bytes, and their encoding as text of a page.

#include <cstdint>
#include <string>
#include <vector>

namespace osculate::report {

using Bytes = std::vector<std::uint8_t>;

/// Compresses to zlib's format, which browsers call "deflate". The same bytes give the same result.
[[nodiscard]] Bytes deflated(const Bytes& bytes);
/// @throws std::runtime_error if the bytes are not from deflated()
[[nodiscard]] Bytes inflated(const Bytes& bytes);

[[nodiscard]] std::string base64(const Bytes& bytes);

} // namespace osculate::report
