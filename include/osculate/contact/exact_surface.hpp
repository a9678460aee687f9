#pragma once
/// The exact surface of a rigid body as a master.

#include "osculate/contact/exact_shape.hpp"
#include "osculate/contact/master_surface.hpp"

#include <array>
#include <memory>
#include <span>

namespace osculate::contact {

/// Four vertices of a rigid body that are not in one plane, with their reference positions: their positions place the
/// body, and weights on them put a force on it wherever it acts.
struct RigidFrame {
    std::array<Index, 4> vertices{};
    std::array<Vec3, 4> X{}; ///< m
};
/// The four that span the most, one after another.
/// @param X  (vertices) reference positions, m; not all in one plane
[[nodiscard]] RigidFrame rigid_frame(const std::vector<Vec3>& X);

/// With S = X_0 + F^-1 (s - x_0), F = [x_i - x_0] [X_i - X_0]^-1, a rotation for a rigid motion, and the shape's signed
/// distance d with its gradient N and Hessian H at S:
///     g = d,   n = F N,   P = S - d N,   Phi_i = barycentric coordinates of P,   p_i = -Phi_i n.
/// The facet of a hit means nothing to it. First variations are exact for motions of the body as one: others do not occur.
[[nodiscard]] std::unique_ptr<MasterSurface> make_exact_surface(const ExactShape& shape, const RigidFrame& frame);

} // namespace osculate::contact
