#pragma once
/// Errors of Osculate as exceptions of Python.

#include <pybind11/pybind11.h>

namespace osculate::python {

/// SceneError(ValueError) with `faults`, RunFailure(RuntimeError) with `post_mortem`, InternalError(RuntimeError), and the
/// class Fault.
void add_exceptions(pybind11::module_& module);

} // namespace osculate::python
