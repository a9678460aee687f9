#pragma once
/// A small study, read from changed text.

#include "osculate/scene/study.hpp"
#include "scene_text.hpp"
#include "support/scene_file.hpp"

#include <string>
#include <vector>

namespace osculate::scene {

inline double twice(const double* a) {
    return 2 * a[0];
}
inline const NamedFunctions functions{{"twice", 1, twice}};

inline const std::string small_study = R"(title: Small
scene: small.yaml
set: {stages.load.steps: 3}
constants:
  F: 5 * h
  G: twice(F)
axes:
  surface: {key: contact.joint.surface, values: [facets, {blend: {ring: 3}}]}
  mesh:
    coarse: {set: {bodies.cap.mesh.block.divisions: [1, 1, 1]}, parameters: {h: 1}}
    fine: {set: {bodies.cap.mesh.block.divisions: [2, 2, 2]}, parameters: {h: 1 / 2}}
leave_out:
  - {surface: facets, mesh: [fine]}
quantities:
  peak:
    contact: joint
    value: max(normal_stress)
    reference: G
  force:
    history: abs(pair.joint.force_x)
    reduce: max
refine: mesh
)";

inline std::string file_with(const std::string& text) {
    support::scene_file("small.yaml", small_scene);
    return support::scene_file("study.yaml", text);
}

inline Study read(const std::string& text, const std::vector<Override>& changes = {}) {
    return read_study(file_with(text), functions, changes);
}

/// Messages without the folder of the file.
inline std::vector<std::string> faults(const std::string& text, const std::vector<Override>& changes = {}) {
    const std::string path = file_with(text), folder = path.substr(0, path.rfind('/') + 1);
    std::vector<std::string> list;
    try {
        (void)read_study(path, functions, changes);
    } catch (const SceneError& error) {
        for (const Fault& fault : error.faults()) {
            std::string message = fault.message();
            for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder))
                message.erase(at, folder.size());
            list.push_back(message);
        }
    }
    return list;
}

} // namespace osculate::scene
