#pragma once
/// The list of shapes that faces of elements have; what reads, divides or integrates faces uses its rows.

#include <array>
#include <span>

namespace osculate::mesh {

inline constexpr int most_nodes_per_face = 8;

/// Local node numbers of a triangle or quadrilateral, counter-clockwise seen from outside; nodes[3] is -1 for a triangle.
struct LocalFace {
    std::array<int, 4> nodes;
    int count;
};

/// Nodes: the corners counter-clockwise seen from outside, then, where edges have midside nodes, those of the edges
/// 01, 12, ... and from the last corner to the first.
struct FaceShape {
    int nodes;
    int corners;
    int vtk;                           ///< VTK's number
    int gmsh;                          ///< Gmsh's number
    std::span<const LocalFace> pieces; ///< plane facets of surfaces that take its place, in its own nodes
};

namespace faces {

inline constexpr LocalFace triangle[] = {{{0, 1, 2, -1}, 3}};
inline constexpr LocalFace quadrilateral[] = {{{0, 1, 2, 3}, 4}};
inline constexpr LocalFace six_nodes[] = {
    {{0, 3, 5, -1}, 3}, {{3, 1, 4, -1}, 3}, {{5, 4, 2, -1}, 3}, {{3, 4, 5, -1}, 3}};
inline constexpr LocalFace eight_nodes[] = {
    {{0, 4, 7, -1}, 3}, {{4, 1, 5, -1}, 3}, {{5, 2, 6, -1}, 3}, {{6, 3, 7, -1}, 3}, {{4, 5, 6, 7}, 4}};

inline constexpr FaceShape list[] = {
    {3, 3, 5, 2, triangle}, {4, 4, 9, 3, quadrilateral}, {6, 3, 22, 9, six_nodes}, {8, 4, 23, 16, eight_nodes}};

} // namespace faces

/// Pieces of any face, at most.
inline constexpr int most_pieces_per_face = 5;

/// The first row for which f is true; null if there is none.
template <class F> [[nodiscard]] constexpr const FaceShape* find_face_shape(F&& f) {
    for (const FaceShape& shape : faces::list)
        if (f(shape)) return &shape;
    return nullptr;
}

/// The shape of a face with so many nodes, which must be that of a row.
[[nodiscard]] constexpr const FaceShape& face_shape(int nodes) {
    return *find_face_shape([&](const FaceShape& shape) { return shape.nodes == nodes; });
}

/// Calls use(nodes, count) for every piece of a face, with an array of 4 of its numbers.
template <class Numbers, class Use> constexpr void for_each_piece(const Numbers& face, int count, Use&& use) {
    for (const LocalFace& piece : face_shape(count).pieces) {
        std::array<typename Numbers::value_type, 4> numbers;
        numbers.fill(-1);
        for (int i = 0; i < piece.count; ++i)
            numbers[static_cast<std::size_t>(i)] =
                face[static_cast<std::size_t>(piece.nodes[static_cast<std::size_t>(i)])];
        use(numbers, piece.count);
    }
}

} // namespace osculate::mesh
