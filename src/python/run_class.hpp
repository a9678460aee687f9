#pragma once
/// The classes `Run`, `Step` and `Pair` of Python, and the function `run`.

#include <pybind11/pybind11.h>

namespace osculate::python {

void add_run(pybind11::module_& module);

} // namespace osculate::python
