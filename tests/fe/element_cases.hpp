#pragma once
/// Every element and formulation pair under test, small meshes of them, and a dense assembly.

#include "osculate/fe/element_block.hpp"
#include "osculate/fe/with_element.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <ostream>
#include <string>
#include <vector>

namespace osculate::fe::fixtures {

struct ElementCase {
    const char* name;
    mesh::CellType type;
    HexFormulation formulation;

    [[nodiscard]] std::unique_ptr<ElementKernel> kernel(const material::LinearElastic& material) const {
        return make_kernel(type, formulation, material);
    }
};

inline const std::vector<ElementCase> all_cases{
    {"hex8_full", mesh::CellType::hex8, HexFormulation::full},
    {"hex8_b_bar", mesh::CellType::hex8, HexFormulation::b_bar},
    {"hex8_incompatible_modes", mesh::CellType::hex8, HexFormulation::incompatible_modes},
    {"tet4", mesh::CellType::tet4, HexFormulation::full},
    {"wedge6", mesh::CellType::wedge6, HexFormulation::full},
    {"tet10", mesh::CellType::tet10, HexFormulation::full},
    {"hex20", mesh::CellType::hex20, HexFormulation::full},
    {"wedge15", mesh::CellType::wedge15, HexFormulation::full},
    {"hex20_reduced", mesh::CellType::hex20, HexFormulation::reduced},
};

inline std::ostream& operator<<(std::ostream& stream, const ElementCase& c) {
    return stream << c.name;
}

inline std::string case_name(const ::testing::TestParamInfo<ElementCase>& parameter) {
    return parameter.param.name;
}

inline std::vector<mesh::CellType> all_types() {
    std::vector<mesh::CellType> types;
    for (const mesh::CellInfo& info : mesh::cell_types()) types.push_back(info.type);
    return types;
}

/// Natural coordinates of the nodes, 3 x n.
inline Eigen::Matrix3Xd reference_positions(mesh::CellType type) {
    return with_element(type, []<class E>() { return Eigen::Matrix3Xd(E::node_positions()); });
}

/// Reproducible numbers in [-1, 1] without symmetry.
inline double scatter(int k) {
    const double s = std::sin(12.9898 * (k + 1)) * 43758.5453;
    return 2 * (s - std::floor(s)) - 1;
}

/// Puts every midside node midway between its corners.
inline void straighten(mesh::CellType type, Eigen::Matrix3Xd& X) {
    int middle = mesh::cell_info(type).corners();
    for (const auto& [a, b] : mesh::cell_info(type).edges) X.col(middle++) = (X.col(a) + X.col(b)) / 2;
}

/// The reference element with every node moved by up to `amount` in every direction, then tilted and stretched; edges
/// stay straight.
inline Eigen::Matrix3Xd distorted_element(mesh::CellType type, double amount = 0.15) {
    Eigen::Matrix3Xd X = reference_positions(type);
    for (int k = 0; k < X.size(); ++k) X(k % 3, k / 3) += amount * scatter(k);
    straighten(type, X);
    Mat3 A;
    A << 1.1, 0.2, 0.0, -0.1, 0.9, 0.1, 0.05, 0.0, 1.3;
    return A * X;
}

/// Faces of a cell, outward, in the order of mesh::SurfaceFace.
inline std::vector<std::vector<Index>> cell_faces(mesh::CellType type) {
    std::vector<std::vector<Index>> faces;
    for (const mesh::LocalFace& face : mesh::cell_info(type).faces) {
        const auto all = mesh::cell_info(type).face_nodes(face);
        faces.emplace_back(all.nodes.begin(), all.nodes.begin() + all.count);
    }
    return faces;
}

/// Boxes that a cell spans in every direction, so that its midside nodes are nodes of the grid.
inline int boxes_per_cell(mesh::CellType type) {
    return mesh::cell_info(type).edges.empty() ? 1 : 2;
}

/// A box of cells and its dense stiffness. The divisions are multiples of boxes_per_cell.
struct Grid {
    mesh::CellType type;
    std::array<int, 3> divisions;
    Eigen::Matrix3Xd X;
    std::vector<std::vector<int>> cells;
    std::unique_ptr<ElementKernel> kernel;

    /// Node (i, j, k) of the grid starts at (i, j, k) divided by the divisions and goes where `place` sends it.
    Grid(const ElementCase& element, const material::LinearElastic& material, std::array<int, 3> n,
         const std::function<Vec3(const Vec3&)>& place)
        : type(element.type), divisions(n), X(3, (n[0] + 1) * (n[1] + 1) * (n[2] + 1)),
          kernel(element.kernel(material)) {
        for (int k = 0; k <= n[2]; ++k)
            for (int j = 0; j <= n[1]; ++j)
                for (int i = 0; i <= n[0]; ++i)
                    X.col(node(i, j, k)) = place(Vec3(double(i) / n[0], double(j) / n[1], double(k) / n[2]));
        const int step = boxes_per_cell(type);
        for (int k = 0; k < n[2]; k += step)
            for (int j = 0; j < n[1]; j += step)
                for (int i = 0; i < n[0]; i += step) add_cells(corners(i, j, k, step));
    }

    /// Puts every midside node midway between its corners.
    void straighten_edges() {
        for (const auto& cell : cells) {
            Eigen::Matrix3Xd straight = gather(cell, X);
            straighten(type, straight);
            for (std::size_t a = 0; a < cell.size(); ++a) X.col(cell[a]) = straight.col(int(a));
        }
    }

    [[nodiscard]] int node(int i, int j, int k) const { return i + (divisions[0] + 1) * (j + (divisions[1] + 1) * k); }

    /// The eight corners of `s` boxes each way from (i, j, k), in hexahedron order.
    [[nodiscard]] std::vector<int> corners(int i, int j, int k, int s = 1) const {
        return {node(i, j, k),     node(i + s, j, k),     node(i + s, j + s, k),     node(i, j + s, k),
                node(i, j, k + s), node(i + s, j, k + s), node(i + s, j + s, k + s), node(i, j + s, k + s)};
    }

    [[nodiscard]] Eigen::Matrix3Xd gather(const std::vector<int>& cell, const Eigen::Matrix3Xd& field) const {
        return field(Eigen::all, cell);
    }

    [[nodiscard]] Matrix stiffness() const {
        Matrix K = Matrix::Zero(X.size(), X.size());
        Matrix Ke(3 * kernel->nodes(), 3 * kernel->nodes());
        for (const auto& cell : cells) {
            kernel->stiffness(gather(cell, X), Ke);
            for (int a = 0; a < kernel->nodes(); ++a)
                for (int b = 0; b < kernel->nodes(); ++b)
                    K.block<3, 3>(3 * cell[std::size_t(a)], 3 * cell[std::size_t(b)]) += Ke.block<3, 3>(3 * a, 3 * b);
        }
        return K;
    }

    /// Solves K u = f with the displacements of `fixed` degrees of freedom prescribed by `u`; returns u.
    [[nodiscard]] Eigen::Matrix3Xd solve(const std::vector<bool>& fixed, const Eigen::Matrix3Xd& u,
                                         const Eigen::Matrix3Xd& f) const {
        Matrix K = stiffness();
        for (int d = 0; d < X.size(); ++d)
            if (K.col(d).isZero(0)) K(d, d) = 1; // of a node that no cell has
        Vector rhs = f.reshaped();
        for (int d = 0; d < X.size(); ++d) {
            if (fixed[std::size_t(d)]) rhs -= K.col(d) * u(d % 3, d / 3);
        }
        for (int d = 0; d < X.size(); ++d) {
            if (!fixed[std::size_t(d)]) continue;
            K.row(d).setZero();
            K.col(d).setZero();
            K(d, d) = 1;
            rhs[d] = u(d % 3, d / 3);
        }
        const Vector all = K.llt().solve(rhs);
        return all.reshaped(3, X.cols());
    }

private:
    void add_cells(const std::vector<int>& c) {
        std::vector<std::vector<std::size_t>> pieces{{0, 1, 2, 3, 4, 5, 6, 7}};
        if (mesh::cell_info(type).faces.size() == 5) pieces = {{0, 2, 1, 4, 6, 5}, {0, 3, 2, 4, 7, 6}};
        if (mesh::cell_info(type).faces.size() == 4)
            pieces = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
        for (const auto& piece : pieces) {
            std::vector<int> cell;
            for (const std::size_t i : piece) cell.push_back(c[i]);
            for (const auto& [a, b] : mesh::cell_info(type).edges) // node numbers are linear in (i, j, k)
                cell.push_back((cell[std::size_t(a)] + cell[std::size_t(b)]) / 2);
            cells.push_back(cell);
        }
    }
};

} // namespace osculate::fe::fixtures
