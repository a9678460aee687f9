/// The Python module `osculate`.

#include "osculate/app/version.hpp"
#include "osculate/scene/keys.hpp"
#include "python/exceptions.hpp"
#include "python/run_class.hpp"
#include "python/scene_class.hpp"

#include <pybind11/pybind11.h>

PYBIND11_MODULE(osculate, module) {
    namespace py = pybind11;
    using namespace osculate;
    module.doc() = "Deformable bodies in frictional contact on smooth surfaces.";
    module.attr("__version__") = app::version;
    python::add_exceptions(module);
    python::add_scene(module);
    python::add_run(module);
    module.def("keys", &scene::describe_keys, py::arg("path") = "",
               "The keys of a scene at or below a path: type and unit, range, default, meaning.");
}
