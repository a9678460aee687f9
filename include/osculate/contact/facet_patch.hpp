#pragma once
/// The finite element facet itself as a patch: bilinear quadrilateral or flat triangle.

#include "osculate/contact/surface_patch.hpp"

namespace osculate::contact {

/// Quadrilateral: u in [-1, 1]^2, corners counter-clockwise from (-1, -1). Triangle: u = (L2, L3), u >= 0, u1 + u2 <= 1.
class FacetPatch {
public:
    /// @param corners 3 or 4
    explicit FacetPatch(int corners) : corners_(corners) {}

    [[nodiscard]] Index size() const { return corners_; }
    [[nodiscard]] double node_distance() const { return corners_ == 4 ? 2 : 1; } ///< in natural coordinates
    [[nodiscard]] Vec2 centre() const { return corners_ == 4 ? Vec2::Zero() : Vec2::Constant(1.0 / 3); }
    [[nodiscard]] MatrixX3 coefficients(const MatrixX3& x) const { return x; }
    [[nodiscard]] PatchPoint point(const Vec2& u, const MatrixX3& x) const;
    void weights(const Vec2& u, Eigen::Ref<Vector> phi, Eigen::Ref<MatrixX2> phi_a) const;

private:
    int corners_;
};

} // namespace osculate::contact
