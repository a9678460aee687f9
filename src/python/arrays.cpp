#include "python/arrays.hpp"

#include <memory>
#include <utility>

namespace osculate::python {

namespace py = pybind11;

static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of vectors are looked at as rows of three numbers");

namespace {

py::array read_only(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

py::array::ShapeContainer shape(std::size_t values, int components) {
    const auto rows = static_cast<py::ssize_t>(values) / components;
    if (components == 1) return {rows};
    return {rows, static_cast<py::ssize_t>(components)};
}

template <class T> py::array keep(std::vector<T> values, int components) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    const T* data = kept->data();
    const std::size_t size = kept->size();
    const py::capsule owner(kept.release(), [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
    return read_only(py::array(py::dtype::of<T>(), shape(size, components), data, owner));
}

} // namespace

py::array view(std::span<const Vec3> vectors, const py::handle& owner) {
    const auto* data = reinterpret_cast<const double*>(vectors.data());
    return read_only(py::array(py::dtype::of<double>(), shape(3 * vectors.size(), 3), data, owner));
}

py::array view(std::span<const double> values, const py::handle& owner) {
    return read_only(py::array(py::dtype::of<double>(), shape(values.size(), 1), values.data(), owner));
}

py::array view(std::span<const Index> values, Index columns, const py::handle& owner) {
    const py::array::ShapeContainer rows{static_cast<py::ssize_t>(values.size()) / columns,
                                         static_cast<py::ssize_t>(columns)};
    return read_only(py::array(py::dtype::of<Index>(), rows, values.data(), owner));
}

py::array owned(std::vector<double> values, int components) {
    return keep(std::move(values), components);
}

py::array owned(std::vector<std::int32_t> values) {
    return keep(std::move(values), 1);
}

py::array owned(const Vec3& vector) {
    return keep(std::vector<double>{vector.x(), vector.y(), vector.z()}, 1);
}

} // namespace osculate::python
