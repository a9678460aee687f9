#pragma once
/// Overlap of a slave facet and a master facet, as integration points.

#include "osculate/core/types.hpp"

#include <optional>
#include <span>
#include <vector>

namespace osculate::contact {

/// One point of an overlap: on the slave facet, and on the master facet where the line through it along the normal of
/// the slave plane meets that facet.
struct OverlapPoint {
    Vec2 xi = Vec2::Zero(); ///< natural coordinates on the slave facet, as in FacetPatch
    Vec2 u = Vec2::Zero();  ///< natural coordinates on the master facet
    double area = 0;        ///< weight: area in the slave plane, m^2
};

/// A point of the part of a master edge that lies over the slave facet: where the overlap ends if the master ends there.
struct EdgePoint {
    Vec2 xi = Vec2::Zero(); ///< natural coordinates on the slave facet
    double s = 0;           ///< share of the edge from its first end
    double length = 0;      ///< weight: length in the slave plane, m
};

/// The plane of a slave facet: through its centre, normal to its area vector.
class SlavePlane {
public:
    /// @param corners (3 or 4) positions, counter-clockwise seen from outside
    explicit SlavePlane(std::span<const Vec3> corners);

    [[nodiscard]] const Vec3& normal() const { return normal_; } ///< unit, out of the slave
    [[nodiscard]] double area() const { return area_; }          ///< area of the facet projected along the normal, m^2
    [[nodiscard]] Vec2 operator()(const Vec3& x) const { return {e1_.dot(x - centre_), e2_.dot(x - centre_)}; }

    /// Integration points of the overlap of the two facets, projected along the normal. They are exact for polynomials
    /// of degree 4. Empty if the facets do not overlap, or if the master facet does not face the slave.
    /// @param master  (3 or 4) corners of the master facet
    [[nodiscard]] std::vector<OverlapPoint> overlap(std::span<const Vec3> master) const;
    /// Integration points of the part of an edge over the facet, projected along the normal; of degree 7.
    [[nodiscard]] std::vector<EdgePoint> edge_over(const Vec3& from, const Vec3& to) const;

private:
    std::vector<Vec2> polygon_; ///< the slave facet in its plane
    Vec3 centre_, normal_, e1_, e2_;
    double area_ = 0;
};

/// Natural coordinates of point p in a plane triangle or quadrilateral; no value if the iteration fails.
[[nodiscard]] std::optional<Vec2> natural_coordinates(std::span<const Vec2> corners, const Vec2& p);

} // namespace osculate::contact
