#pragma once
/// Bodies that are a single hexahedron thick.

#include "app/check/warning.hpp"
#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

/// Of bodies that something bends, with `full` hexahedra that reach through them: their strains are constant along the
/// element where bending wants them to change, so that they lock in shear.
[[nodiscard]] std::vector<Warning> thin_layers(const scene::Scene& scene, const Plan& plan);

/// How many times too stiff a rectangular `full` element is in bending: the energy of its one shape for that, u = c x y
/// (axial strain c y, none across; shear strain c x, which should not be there), over a beam's:
///     (1-nu) / ((1+nu)(1-2nu)) + (a/t)^2 / (2(1+nu)).
/// @param slenderness  a/t, length over thickness of the element
[[nodiscard]] double too_stiff_in_bending(double slenderness, double nu);

} // namespace osculate::app
