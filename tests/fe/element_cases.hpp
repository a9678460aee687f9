#pragma once
/// Every element and formulation pair under test, small meshes of them, and a dense assembly.

#include "osculate/fe/element_block.hpp"
#include "osculate/fe/reference_element.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <ostream>
#include <string>
#include <vector>

namespace osculate::fe::testing {

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
};

inline std::ostream& operator<<(std::ostream& stream, const ElementCase& c) {
    return stream << c.name;
}

inline std::string case_name(const ::testing::TestParamInfo<ElementCase>& parameter) {
    return parameter.param.name;
}

/// Natural coordinates of the nodes, 3 x n.
inline Eigen::Matrix3Xd reference_positions(mesh::CellType type) {
    switch (type) {
    case mesh::CellType::tet4: return Tet4::node_positions();
    case mesh::CellType::wedge6: return Wedge6::node_positions();
    case mesh::CellType::tet10: return Tet10::node_positions();
    case mesh::CellType::hex8: break;
    }
    return Hex8::node_positions();
}

/// Reproducible numbers in [-1, 1] without symmetry.
inline double scatter(int k) {
    const double s = std::sin(12.9898 * (k + 1)) * 43758.5453;
    return 2 * (s - std::floor(s)) - 1;
}

/// Puts the midside nodes of a tet10 midway between its corners.
inline void straighten(Eigen::Matrix3Xd& X) {
    for (int m = 0; m < 6; ++m) X.col(4 + m) = (X.col(Tet10::edges[m][0]) + X.col(Tet10::edges[m][1])) / 2;
}

/// The reference element with every node moved by up to `amount` in every direction, then tilted and stretched; the
/// edges of a tet10 stay straight.
inline Eigen::Matrix3Xd distorted_element(mesh::CellType type, double amount = 0.15) {
    Eigen::Matrix3Xd X = reference_positions(type);
    for (int k = 0; k < X.size(); ++k) X(k % 3, k / 3) += amount * scatter(k);
    if (type == mesh::CellType::tet10) straighten(X);
    Mat3 A;
    A << 1.1, 0.2, 0.0, -0.1, 0.9, 0.1, 0.05, 0.0, 1.3;
    return A * X;
}

/// Faces of a cell, outward, in the order of mesh::SurfaceFace.
inline std::vector<std::vector<Index>> cell_faces(mesh::CellType type) {
    switch (type) {
    case mesh::CellType::tet4: return {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
    case mesh::CellType::wedge6: return {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
    case mesh::CellType::tet10: // corners, then the nodes midway
        return {{0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {2, 0, 3, 6, 7, 9}, {0, 2, 1, 6, 5, 4}};
    case mesh::CellType::hex8: break;
    }
    return {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
}

/// A box of cells and its dense stiffness. A tet10 spans two boxes in every direction; its divisions are even.
struct Grid {
    std::array<int, 3> divisions;
    Eigen::Matrix3Xd X;
    std::vector<std::vector<int>> cells;
    std::unique_ptr<ElementKernel> kernel;

    /// Node (i, j, k) of the grid starts at (i, j, k) divided by the divisions and goes where `place` sends it.
    Grid(const ElementCase& element, const material::LinearElastic& material, std::array<int, 3> n,
         const std::function<Vec3(const Vec3&)>& place)
        : divisions(n), X(3, (n[0] + 1) * (n[1] + 1) * (n[2] + 1)), kernel(element.kernel(material)) {
        for (int k = 0; k <= n[2]; ++k)
            for (int j = 0; j <= n[1]; ++j)
                for (int i = 0; i <= n[0]; ++i)
                    X.col(node(i, j, k)) = place(Vec3(double(i) / n[0], double(j) / n[1], double(k) / n[2]));
        const int step = element.type == mesh::CellType::tet10 ? 2 : 1;
        for (int k = 0; k < n[2]; k += step)
            for (int j = 0; j < n[1]; j += step)
                for (int i = 0; i < n[0]; i += step) add_cells(element.type, corners(i, j, k, step));
    }

    /// Puts every midside node of a tet10 midway between its corners.
    void straighten_edges() {
        for (const auto& cell : cells) {
            Eigen::Matrix3Xd straight = gather(cell, X);
            straighten(straight);
            for (std::size_t a = 4; a < 10; ++a) X.col(cell[a]) = straight.col(int(a));
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
    void add_cells(mesh::CellType type, const std::vector<int>& c) {
        std::vector<std::vector<std::size_t>> pieces{{0, 1, 2, 3, 4, 5, 6, 7}};
        if (type == mesh::CellType::wedge6) pieces = {{0, 2, 1, 4, 6, 5}, {0, 3, 2, 4, 7, 6}};
        if (type == mesh::CellType::tet4 || type == mesh::CellType::tet10)
            pieces = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
        for (const auto& piece : pieces) {
            std::vector<int> cell;
            for (const std::size_t i : piece) cell.push_back(c[i]);
            if (type == mesh::CellType::tet10) { // node numbers are linear in (i, j, k)
                for (const auto& edge : Tet10::edges) cell.push_back((cell[edge[0]] + cell[edge[1]]) / 2);
            }
            cells.push_back(cell);
        }
    }
};

} // namespace osculate::fe::testing
