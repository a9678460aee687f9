#pragma once
/// Choices that a scene makes and that numerical code uses. The names are those in scenes.

namespace osculate {

/// How a hexahedron avoids locking. `full`: not at all. `b_bar`: mean dilatation, against locking in near
/// incompressibility; a single element through the thickness is too soft in bending; at finite strain this is F-bar.
/// `incompatible_modes`: internal bending modes, against locking in bending, and also in near incompressibility unless
/// elements are badly distorted; small strain only. These two are for hex8. `reduced`: 2 x 2 x 2 points for a hex20,
/// against locking of both kinds.
enum class HexFormulation { full, b_bar, incompatible_modes, reduced };

/// Where gaps are measured and how forces reach the master. `node`: at the slave nodes, by the weights of the smooth
/// surface there. `mortar`: both averaged over the slave facets. `petrov_galerkin`: gaps at the slave nodes, forces
/// averaged over the slave facets.
enum class Discretisation { node, mortar, petrov_galerkin };

/// Whether forces are averaged over the slave facets.
[[nodiscard]] constexpr bool averages(Discretisation d) {
    return d != Discretisation::node;
}

/// Coordinates of a patch's nodes in its reference plane.
enum class PatchCoordinates {
    tangential,  ///< orthogonal projection on the reference plane                     [Qian 2014, eq (21)]
    equal_length ///< the same directions, true lengths
};

/// How Newton's linear systems are solved.
enum class LinearSolver {
    automatic, ///< multigrid for many nodes, else condensed if that costs less, else iterative
    condensed, ///< linear::CondensedTangent, if bodies are linear and no pressure follows its faces; else iterative
    iterative, ///< GMRES with the whole tangent and linear::ContactPreconditioner, factorised
    multigrid, ///< the same, but the preconditioner is inverted by multigrid
    direct     ///< factorises the tangent in every iteration
};

} // namespace osculate
