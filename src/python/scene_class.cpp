#include "python/scene_class.hpp"

#include "osculate/scene/writer.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace osculate::python {

namespace py = pybind11;

namespace {

/// A value of Python as YAML: numbers, truth values, lists, tuples, arrays, maps; a text stands as it is.
std::string yaml(const py::handle& value) {
    if (value.is_none()) return "null";
    if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
    if (py::isinstance<py::str>(value)) return value.cast<std::string>();
    if (py::isinstance<py::dict>(value)) {
        std::string text;
        for (const auto& [key, item] : value.cast<py::dict>())
            text += (text.empty() ? "" : ", ") + yaml(key) + ": " + yaml(item);
        return "{" + text + "}";
    }
    if (py::hasattr(value, "tolist")) return yaml(value.attr("tolist")()); // NumPy's arrays and numbers
    if (py::hasattr(value, "__iter__")) {
        std::string text;
        for (const py::handle item : value) text += (text.empty() ? "" : ", ") + yaml(item);
        return "[" + text + "]";
    }
    return py::repr(value).cast<std::string>();
}

std::vector<scene::Override> list(const py::dict& overrides) {
    std::vector<scene::Override> result;
    for (const auto& [key, value] : overrides) {
        if (!py::isinstance<py::str>(key))
            throw py::type_error("overrides: expected paths of keys such as 'solver.tolerance', found " +
                                 py::repr(key).cast<std::string>());
        result.push_back({key.cast<std::string>(), yaml(value)});
    }
    return result;
}

template <class T> std::vector<std::string> names(const scene::Named<T>& named) {
    std::vector<std::string> result;
    for (const auto& [name, value] : named) result.push_back(name);
    return result;
}

} // namespace

SceneFile SceneFile::read(const std::string& path, const py::dict& overrides) {
    SceneFile file{path, list(overrides), {}};
    file.scene = scene::read_scene(path, file.overrides);
    return file;
}

SceneFile SceneFile::parse(const std::string& text, const py::dict& overrides) {
    SceneFile file{{}, list(overrides), {}};
    file.scene = scene::parse_scene(text, "<text>", file.overrides);
    return file;
}

void add_scene(py::module_& module) {
    using scene::Scene;
    py::class_<SceneFile>(module, "Scene", "A scene file, read and checked; every default filled in.")
        .def(py::init([](const std::filesystem::path& path, const py::dict& overrides) {
                 return SceneFile::read(path.string(), overrides);
             }),
             py::arg("path"), py::arg("overrides") = py::dict(),
             "Reads a scene file. `overrides` maps key paths to values, as --set does.\n\nRaises SceneError with all "
             "faults.")
        .def_static("parse", &SceneFile::parse, py::arg("text"), py::arg("overrides") = py::dict(),
                    "A scene from a text in YAML; relative paths in it start at the current folder.")
        .def_readonly("path", &SceneFile::path)
        .def_property_readonly("name", [](const SceneFile& file) { return file.scene.name; })
        .def_property_readonly("bodies", [](const SceneFile& file) { return names(file.scene.bodies); })
        .def_property_readonly("sets", [](const SceneFile& file) { return names(file.scene.sets); })
        .def_property_readonly("pairs", [](const SceneFile& file) { return names(file.scene.contact); })
        .def_property_readonly("stages", [](const SceneFile& file) { return names(file.scene.stages); })
        .def_property_readonly(
            "yaml", [](const SceneFile& file) { return scene::write_scene(file.scene); },
            "The resolved scene, in SI units: what a run writes as scene.yaml.")
        .def(py::pickle(
            [](const SceneFile& file) { // of a file: what it was read from
                py::list overrides;
                for (const scene::Override& one : file.overrides) overrides.append(py::make_tuple(one.key, one.value));
                const bool text = file.path.empty();
                return py::make_tuple(text ? std::string() : std::filesystem::absolute(file.path).string(),
                                      text ? py::list() : overrides,
                                      text ? scene::write_scene(file.scene) : std::string());
            },
            [](const py::tuple& state) {
                if (state.size() != 3) throw py::value_error("not a pickled osculate.Scene");
                SceneFile file{state[0].cast<std::string>(), {}, {}};
                for (const py::handle one : state[1].cast<py::list>()) {
                    const auto [key, value] = one.cast<std::pair<std::string, std::string>>();
                    file.overrides.push_back({key, value});
                }
                file.scene = file.path.empty() ? scene::parse_scene(state[2].cast<std::string>(), "<text>")
                                               : scene::read_scene(file.path, file.overrides);
                return file;
            }))
        .def("__repr__", [](const SceneFile& file) {
            return "<osculate.Scene '" + file.scene.name + "'" + (file.path.empty() ? "" : " of " + file.path) + ">";
        });
}

} // namespace osculate::python
