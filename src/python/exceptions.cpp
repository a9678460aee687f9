#include "python/exceptions.hpp"

#include "osculate/app/run.hpp"
#include "osculate/core/error.hpp"

#include <pybind11/stl.h>
#include <string>

namespace osculate::python {

namespace py = pybind11;

namespace {

/// Raises type(message) with an attribute. Classes live as long as the interpreter.
void raise(py::handle type, const std::string& message, const char* attribute = nullptr, const py::object& value = {}) {
    const py::object error = type(message);
    if (attribute != nullptr) error.attr(attribute) = value;
    PyErr_SetObject(type.ptr(), error.ptr());
}

py::handle scene_error, run_failure, internal_error;

py::handle add(py::module_& module, const char* name, PyObject* base, const char* doc) {
    const std::string full = std::string("osculate.") + name;
    auto type = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(full.c_str(), doc, base, nullptr));
    module.attr(name) = type;
    return type.release();
}

} // namespace

void add_exceptions(py::module_& module) {
    py::class_<Fault>(module, "Fault", "One fault of a scene, with everything needed to mend it.")
        .def_readonly("file", &Fault::file)
        .def_readonly("line", &Fault::line, "from 1; 0 where it has no place in the file")
        .def_readonly("column", &Fault::column)
        .def_readonly("key", &Fault::key, "dotted path, such as 'contact.sliding.friction'")
        .def_readonly("expected", &Fault::expected)
        .def_readonly("found", &Fault::found)
        .def_readonly("nearest", &Fault::nearest, "known key or name that it is close to, or ''")
        .def("__str__", &Fault::message)
        .def("__repr__", [](const Fault& fault) { return "<osculate.Fault " + fault.message() + ">"; });

    scene_error =
        add(module, "SceneError", PyExc_ValueError, "A scene that cannot be run; `faults` has all that is wrong.");
    run_failure = add(module, "RunFailure", PyExc_RuntimeError,
                      "A run that gave up; `post_mortem` says in words what was found, '' where nothing was.");
    internal_error = add(module, "InternalError", PyExc_RuntimeError, "A defect of Osculate itself.");
    py::register_exception_translator([](std::exception_ptr pointer) {
        try {
            if (pointer) std::rethrow_exception(pointer);
        } catch (const SceneError& error) {
            raise(scene_error, error.what(), "faults", py::cast(error.faults()));
        } catch (const app::GaveUp& error) {
            raise(run_failure, error.what(), "post_mortem", py::str(error.post_mortem()));
        } catch (const RunFailure& error) {
            raise(run_failure, error.what(), "post_mortem", py::str());
        } catch (const InternalError& error) {
            raise(internal_error, error.what());
        }
    });
}

} // namespace osculate::python
