#pragma once
/// Force and moment at a point, as a traction on a surface.

#include "osculate/core/field.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <vector>

namespace osculate::app {

/// Traction t(x) = F / A + I^-1 (M + (p - c) x F) x (x - c) on a surface of area A with the centroid c and the second moments
/// I = integral of |x - c|^2 - (x - c)(x - c)^T: what statics and the least sum of squares ask of it. A set of nodes without
/// faces has sums over them in place of integrals.
class LoadSpread {
public:
    /// @param nodes  without faces  @param X  reference positions of all nodes, m
    /// @param point  p; null: c
    LoadSpread(const std::vector<mesh::SurfaceFace>& faces, const std::vector<Index>& nodes, const std::vector<Vec3>& X,
               const Vec3* point);
    /// Whether it can carry moments about every axis: the places are not all on one line.
    [[nodiscard]] bool is_spatial() const { return spatial_; }
    /// Adds the nodal forces of F, N, and M, N m, at the point.
    void add(const Vec3& force, const Vec3& moment, Field& forces) const;

private:
    struct Share {
        Index node = -1;
        double weight = 0;         ///< of F
        Vec3 first = Vec3::Zero(); ///< moments about c
    };
    std::vector<Share> shares_;
    double sum_ = 0;
    Vec3 arm_ = Vec3::Zero();     ///< p - c
    Mat3 inverse_ = Mat3::Zero(); ///< I^-1
    bool spatial_ = false;
};

} // namespace osculate::app
