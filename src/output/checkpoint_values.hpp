#pragma once
/// Plain values in checkpoints: as bytes within JSON, and checked when they are read.

#include "osculate/core/types.hpp"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace osculate::output {

using Json = nlohmann::json;
static_assert(std::endian::native == std::endian::little, "values are stored as they lie in memory");

[[noreturn]] inline void incomplete(const std::string& what) {
    throw std::runtime_error("it holds no " + what);
}

template <class T> Json packed(const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    Json::binary_t::container_type bytes(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return Json::binary(std::move(bytes));
}

template <class T> Json packed_matrices(const std::vector<T>& values) {
    std::vector<double> flat;
    for (const T& value : values) flat.insert(flat.end(), value.data(), value.data() + value.size());
    return packed(flat);
}

inline const Json& member(const Json& object, const char* name) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    if (!object.is_object() || found == object.end()) incomplete(name);
    return *found;
}

template <class T> std::vector<T> unpacked(const Json& object, const char* name) {
    const Json& value = member(object, name);
    if (!value.is_binary() || value.get_binary().size() % sizeof(T) != 0) incomplete(name);
    std::vector<T> values(value.get_binary().size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), value.get_binary().data(), value.get_binary().size());
    return values;
}

template <class T> std::vector<T> unpacked_matrices(const Json& object, const char* name) {
    const std::vector<double> flat = unpacked<double>(object, name);
    constexpr auto size = static_cast<std::size_t>(T::SizeAtCompileTime);
    if (flat.size() % size != 0) incomplete(name);
    std::vector<T> values(flat.size() / size);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = Eigen::Map<const T>(flat.data() + size * i);
    return values;
}

template <class T> T number(const Json& object, const char* name) {
    const Json& value = member(object, name);
    if (std::is_integral_v<T> ? !value.is_number_integer() : !value.is_number()) incomplete(name);
    return value.get<T>();
}

inline std::string text(const Json& object, const char* name) {
    const Json& value = member(object, name);
    if (!value.is_string()) incomplete(name);
    return value.get<std::string>();
}

/// Lists of different lengths: the lengths, and all values one after another.
template <class T> struct Ragged {
    std::vector<Index> length;
    std::vector<T> value;

    void add(const std::vector<T>& list) {
        length.push_back(static_cast<Index>(list.size()));
        value.insert(value.end(), list.begin(), list.end());
    }
    [[nodiscard]] std::vector<std::vector<T>> lists(const char* name) const {
        std::vector<std::vector<T>> result;
        std::size_t at = 0;
        for (const Index n : length) {
            if (n < 0 || static_cast<std::size_t>(n) > value.size() - at) incomplete(name);
            const auto begin = value.begin() + static_cast<std::ptrdiff_t>(at);
            result.emplace_back(begin, begin + n);
            at += static_cast<std::size_t>(n);
        }
        if (at != value.size()) incomplete(name);
        return result;
    }
};

} // namespace osculate::output
