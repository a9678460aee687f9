#pragma once
/// Fields over time as few bytes: whole numbers of 16 bits between the least and the largest value.

#include "osculate/report/encode.hpp"

#include <vector>

namespace osculate::report {

/// Values of one field: frame by frame, point by point, component by component.
struct FieldFrames {
    int components = 1;
    std::vector<std::vector<float>> frames; ///< (points * components) each; NaN: no value
};

/// A value is low[c] + level * step[c] with its component c; level 65535 stands for no value.
/// Levels lie frame by frame, component by component, point by point; each as its difference to the frame before, or in
/// the first frame to the point before, modulo 65536; first all low bytes, then all high ones; deflated.
struct Packed {
    std::vector<double> low, step; ///< (components)
    Bytes bytes;
};

[[nodiscard]] Packed pack(const FieldFrames& field);
/// @throws std::runtime_error where the bytes do not fit
[[nodiscard]] FieldFrames unpack(const Packed& packed, std::size_t frames, std::size_t points);

/// 32-bit floats or whole numbers, deflated, little end first.
[[nodiscard]] Bytes packed_floats(const std::vector<float>& values);
[[nodiscard]] Bytes packed_integers(const std::vector<std::uint32_t>& values);

} // namespace osculate::report
