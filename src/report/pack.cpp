#include "osculate/report/pack.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace osculate::report {

namespace {

constexpr std::uint16_t no_value = 65535;
constexpr double most_levels = 65534;

template <class Value> Bytes deflated_values(const std::vector<Value>& values) {
    Bytes bytes(values.size() * sizeof(Value));
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return deflated(bytes);
}

} // namespace

Packed pack(const FieldFrames& field) {
    const auto components = static_cast<std::size_t>(field.components);
    Packed packed;
    packed.low.assign(components, 0);
    packed.step.assign(components, 0);
    for (std::size_t c = 0; c < components; ++c) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const std::vector<float>& frame : field.frames)
            for (std::size_t i = c; i < frame.size(); i += components)
                if (std::isfinite(frame[i])) {
                    low = std::min(low, static_cast<double>(frame[i]));
                    high = std::max(high, static_cast<double>(frame[i]));
                }
        if (low > high) continue; // no value at all
        packed.low[c] = low;
        packed.step[c] = (high - low) / most_levels;
    }

    std::vector<std::uint16_t> before, differences;
    for (const std::vector<float>& frame : field.frames) {
        std::vector<std::uint16_t> levels;
        levels.reserve(frame.size());
        for (std::size_t c = 0; c < components; ++c)
            for (std::size_t i = c; i < frame.size(); i += components) {
                if (!std::isfinite(frame[i]))
                    levels.push_back(no_value);
                else if (packed.step[c] == 0)
                    levels.push_back(0);
                else
                    levels.push_back(static_cast<std::uint16_t>(
                        std::clamp(std::round((frame[i] - packed.low[c]) / packed.step[c]), 0., most_levels)));
            }
        for (std::size_t i = 0; i < levels.size(); ++i) {
            const unsigned reference = before.empty() ? (i > 0 ? levels[i - 1] : 0U) : before[i];
            differences.push_back(static_cast<std::uint16_t>(levels[i] - reference));
        }
        before = std::move(levels);
    }
    Bytes planes;
    planes.reserve(2 * differences.size());
    for (const std::uint16_t d : differences) planes.push_back(static_cast<std::uint8_t>(d & 255U));
    for (const std::uint16_t d : differences) planes.push_back(static_cast<std::uint8_t>(d >> 8));
    packed.bytes = deflated(planes);
    return packed;
}

FieldFrames unpack(const Packed& packed, std::size_t frames, std::size_t points) {
    const Bytes planes = inflated(packed.bytes);
    const std::size_t components = packed.low.size(), size = points * components, all = frames * size;
    if (planes.size() != 2 * all) throw std::runtime_error("the bytes of an array do not fit its points");
    FieldFrames field{static_cast<int>(components), std::vector<std::vector<float>>(frames)};
    std::vector<std::uint16_t> levels(size, 0);
    for (std::size_t f = 0; f < frames; ++f) {
        field.frames[f].resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            const unsigned difference = planes[f * size + i] + 256U * planes[all + f * size + i];
            const unsigned reference = f > 0 ? levels[i] : i > 0 ? levels[i - 1] : 0U;
            levels[i] = static_cast<std::uint16_t>(reference + difference);
            const std::size_t c = i / points, point = i % points;
            field.frames[f][point * components + c] =
                levels[i] == no_value ? std::numeric_limits<float>::quiet_NaN()
                                      : static_cast<float>(packed.low[c] + levels[i] * packed.step[c]);
        }
    }
    return field;
}

Bytes packed_floats(const std::vector<float>& values) {
    return deflated_values(values);
}

Bytes packed_integers(const std::vector<std::uint32_t>& values) {
    return deflated_values(values);
}

} // namespace osculate::report
