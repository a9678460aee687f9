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
/// A cantilever of 3 to 20 elements is 1.12 to 6.3 times too stiff under its load, this says 1.13 to 6.6; with nu = 0.3 up to
/// 15 % more than it is, as elements narrow a little where they are stretched.
/// @param slenderness  a/t, length over thickness of the element
[[nodiscard]] double too_stiff_in_bending(double slenderness, double nu);

} // namespace osculate::app
