#pragma once
/// Edge lengths near surfaces that meet others.

#include "osculate/mesh/gmsh.hpp"

#include <memory>

namespace osculate::mesh {

/// Lengths that grow with the distance from the triangles.
class ContactSize {
public:
    /// @param contact    its size is above 0
    /// @param triangles  one at least, m
    ContactSize(const CadContact& contact, const std::vector<std::array<Vec3, 3>>& triangles);
    ~ContactSize();

    /// Edge length at a point, not more than `largest`. [m]
    [[nodiscard]] double at(const Vec3& x, double largest) const;
    /// How many cubes with such edges fill the layers at the triangles in a geometry of some volume [m^3], about.
    [[nodiscard]] double cubes(double volume) const;

private:
    struct Tree;
    CadContact contact_;
    double area_ = 0;
    std::unique_ptr<Tree> tree_;
};

} // namespace osculate::mesh
