#pragma once
/// Quadrature over one plane piece of a face.

#include "osculate/mesh/face_shape.hpp"

#include <array>
#include <vector>

namespace osculate::fe {

/// A point of a piece, by coordinates s, t from -1 to 1 on the piece; its weight is for ds dt.
struct PiecePoint {
    double weight = 0;
    std::array<double, 4> phi{}, by_s{}, by_t{};       ///< shape functions of the piece, and their derivatives
    std::array<double, mesh::most_nodes_per_face> N{}; ///< shape functions of the face
};

/// Points that are exact for polynomials of degree nine in s and in t. A triangle is a square with two corners in one place.
[[nodiscard]] std::vector<PiecePoint> piece_points(const mesh::FaceShape& face, const mesh::LocalFace& piece);

} // namespace osculate::fe
