#pragma once
/// The finite element facet itself as a patch: bilinear quadrilateral or flat triangle.

#include "osculate/contact/projection.hpp"

#include <optional>

namespace osculate::contact {

/// Quadrilateral: u in [-1, 1]^2, corners counter-clockwise from (-1, -1). Triangle: u = (L2, L3), u >= 0, u1 + u2 <= 1.
/// Beyond the corners of a quadrilateral that is no parallelogram its map folds over: N = X,1 x X,2 is linear in u and turns
/// round where two opposite edges would meet. No foot is taken from there.
class FacetPatch {
public:
    /// @param corners 3 or 4
    explicit FacetPatch(int corners) : corners_(corners) {}
    /// The parallelogram through the middles of a quadrilateral's edges, N_b = (1 +- u1 +- u2)/4: nowhere folded over, and
    /// in the plane of the quadrilateral if that has one.
    [[nodiscard]] FacetPatch flattened() const {
        FacetPatch flat(*this);
        flat.flat_ = true;
        return flat;
    }
    /// Foot of the perpendicular from s, sought from u on, then from where it would be if the facet were plane.
    /// @param x  (corners x 3) positions, m
    /// @returns no value without convergence, or where a quadrilateral's map has folded over, past its edges also if nearly:
    ///          N . N(0) <= 0.1 |N(0)|^2 there, or the normal has turned by 60 degrees from that of the middle
    [[nodiscard]] std::optional<Foot> foot(const Vec3& s, const MatrixX3& x, const Vec2& u) const;

    [[nodiscard]] Index size() const { return corners_; }
    [[nodiscard]] double node_distance() const { return corners_ == 4 ? 2 : 1; } ///< in natural coordinates
    [[nodiscard]] Vec2 centre() const { return corners_ == 4 ? Vec2::Zero() : Vec2::Constant(1.0 / 3); }
    [[nodiscard]] MatrixX3 coefficients(const MatrixX3& x) const { return x; }
    [[nodiscard]] PatchPoint point(const Vec2& u, const MatrixX3& x) const;
    void weights(const Vec2& u, Eigen::Ref<Vector> phi, Eigen::Ref<MatrixX2> phi_a) const;

private:
    [[nodiscard]] bool folded(const Foot& foot, const MatrixX3& x) const;
    /// Coordinates of s in a plane quadrilateral, on the side that has not folded over; no value if it is not there.
    [[nodiscard]] std::optional<Vec2> in_plane(const Vec3& s, const MatrixX3& x) const;

    int corners_;
    bool flat_ = false;
};

} // namespace osculate::contact
