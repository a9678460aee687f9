#pragma once
/// The class `Scene` of Python.

#include "osculate/scene/reader.hpp"

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace osculate::python {

/// A scene that was read, and what it was read from.
struct SceneFile {
    std::string path; ///< empty: from a text
    std::vector<scene::Override> overrides;
    scene::Scene scene;

    /// @param overrides  key path -> value, a text as for --set or a value of Python
    /// @throws SceneError
    [[nodiscard]] static SceneFile read(const std::string& path, const pybind11::dict& overrides);
    [[nodiscard]] static SceneFile parse(const std::string& text, const pybind11::dict& overrides);
};

void add_scene(pybind11::module_& module);

} // namespace osculate::python
