#pragma once
/// A small valid scene for tests to spoil.

#include "osculate/scene/reader.hpp"

#include <stdexcept>
#include <string>

namespace osculate::scene {

/// Line numbers count from the line after R"(; the tests of faults name them.
inline const std::string small_scene = R"(bodies:
  base:
    mesh: {block: {size: [2 m, 2 m, 1 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
  cap:
    mesh: {block: {origin: [0, 0, 1 m], size: [1 m, 1 m, 50 cm]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: base, surface: z_min}
  ground: {body: base, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, plane: {point: [0, 0, 1.5 m], normal: [0, 0, 1]}}
supports:
  bed: {fix: [x, y, z]}
contact:
  joint:
    slave: under
    master: {set: ground, surface: {rpim: {ring: 1}}}
    friction: 0.3
stages:
  load:
    steps: 2
    duration: 1 min
    pressure: {top: 5 kPa}
    body_force: {cap: [0, 0, -2 kN/m^3]}
    displacement: {top: {x: 1 mm}}
output: {template: minimal, iterations: true}
)";

/// The scene with one piece of text replaced; the piece must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("no '" + from + "' in the scene");
    return text.replace(at, from.size(), to);
}

/// Faults of a scene, empty when it is right.
inline std::vector<Fault> faults_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    try {
        static_cast<void>(parse_scene(text, "bad.yaml", overrides));
    } catch (const SceneError& error) {
        return error.faults();
    }
    return {};
}

inline std::vector<std::string> messages(const std::vector<Fault>& faults) {
    std::vector<std::string> texts;
    for (const Fault& fault : faults) texts.push_back(fault.message());
    return texts;
}

} // namespace osculate::scene
