#pragma once
/// Fields over time in few bytes: 16-bit integers between the smallest and the largest value.

#include "osculate/report/encode.hpp"

#include <vector>

namespace osculate::report {

/// Values of one field: frame by frame, point by point, component by component.
struct FieldFrames {
    int components = 1;
    std::vector<std::vector<float>> frames; ///< (points * components) each; NaN: no value
};

/// The value of component c is low[c] + level * step[c]; level 65535 means no value. Levels are ordered by frame,
/// component and point. Each is stored as difference to the previous frame, in the first frame to the previous point,
/// modulo 65536; first all low bytes, then all high bytes; then deflated.
struct Packed {
    std::vector<double> low, step; ///< (components)
    Bytes bytes;
};

[[nodiscard]] Packed pack(const FieldFrames& field);
/// @throws std::runtime_error if the bytes do not fit
[[nodiscard]] FieldFrames unpack(const Packed& packed, std::size_t frames, std::size_t points);

/// 32-bit floats or integers, deflated, little-endian.
[[nodiscard]] Bytes packed_floats(const std::vector<float>& values);
[[nodiscard]] Bytes packed_integers(const std::vector<std::uint32_t>& values);

} // namespace osculate::report
