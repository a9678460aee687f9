#pragma once
/// NumPy arrays over memory of C++, never copied and never to be written to.

#include "osculate/core/types.hpp"

#include <pybind11/numpy.h>
#include <span>
#include <string>
#include <vector>

namespace osculate::python {

/// (n, 3) view of vectors that `owner` keeps in place.
[[nodiscard]] pybind11::array view(std::span<const Vec3> vectors, const pybind11::handle& owner);
/// (n) view.
[[nodiscard]] pybind11::array view(std::span<const double> values, const pybind11::handle& owner);
/// (n / columns, columns) view.
[[nodiscard]] pybind11::array view(std::span<const Index> values, Index columns, const pybind11::handle& owner);

/// Array of values that become its own: (n) with one component, else (n, components).
[[nodiscard]] pybind11::array owned(std::vector<double> values, int components);
[[nodiscard]] pybind11::array owned(std::vector<std::int32_t> values);
[[nodiscard]] pybind11::array owned(const Vec3& vector);

} // namespace osculate::python
