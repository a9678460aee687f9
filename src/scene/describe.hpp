#pragma once
/// The one list of keys.

#include "osculate/scene/scene.hpp"
#include "osculate/scene/surface_study.hpp"
#include "scene/visitor.hpp"

namespace osculate::scene {

/// Shows every key of a scene to a visitor.
void describe(Visitor& v, Scene& scene);

/// The keys that an output template may hold: those of `output` but for the template's name.
void describe_output(Visitor& v, Output& output);

/// Every key of a template: those, and the template whose keys hold where this one has none.
void describe_template(Visitor& v, std::string& extends, Output& output);

/// Every key of a study of surfaces. @param methods  names that `methods` may list
void describe(Visitor& v, SurfaceStudy& study, const Words& methods);

} // namespace osculate::scene
