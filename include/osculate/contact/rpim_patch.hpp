#pragma once
/// Radial point interpolation on scattered nodes of a reference plane.

#include "osculate/contact/basis_table.hpp"
#include "osculate/contact/radial_basis.hpp"
#include "osculate/contact/surface_patch.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::contact {

/// Plane through `origin` with orthonormal axes; axes.col(0) x axes.col(1) is its normal.
struct ReferencePlane {
    Vec3 origin = Vec3::Zero();
    Matrix32 axes = Matrix32::Zero();

    /// Plane with unit normal n, rotated from the x1x2 plane by the shortest rotation.             [Qian 2014, eq (20)]
    [[nodiscard]] static ReferencePlane through(const Vec3& origin, const Vec3& n);
    /// Orthogonal projection of x, metres.                                                    [Qian 2014, eq (21)]
    [[nodiscard]] Vec2 tangential(const Vec3& x) const { return axes.transpose() * (x - origin); }
    /// The same direction, but with the length of x - origin: an azimuthal equidistant chart. Strongly curved patches
    /// do not fold, and normals are several times more accurate than with eq (21).
    [[nodiscard]] Vec2 equal_length(const Vec3& x) const;
};

/// What nodes determine of the polynomials [1 x y | xx xy yy], as columns of coefficients (6 x 3 to 6): the linear ones, then
/// combinations of the others. Nodes in two rows determine none that is quadratic across them.
/// @param u  (n x 2) not on one line
[[nodiscard]] Matrix determined_polynomials(const MatrixX2& u);

/// Interpolation through n nodes with natural coordinates frozen at construction:
///     t = (u - c)/dc,  Phi(u) = [r(t); p(t)]^T H,  X(u) = sum_i Phi_i(u) x_i               [Qian 2014, eqs (9)-(16)]
/// so X is linear in the nodal positions and Phi is a constant of the run.
class RpimPatch {
public:
    /// @param u      (n x 2) natural coordinates, m; at least three, not on one line
    /// @param basis  radial function
    /// @param m      terms of the polynomial basis, 3 or 6; 6 falls back to 3 if the nodes do not determine a quadratic
    /// @returns no value if the nodes do not even determine a plane, or two of them coincide. Cost O(n^3).
    [[nodiscard]] static std::optional<RpimPatch> fit(const MatrixX2& u, const Multiquadric& basis, int m);
    /// @param polynomials  (m x k) the basis has combinations of the m terms: a column each, the first three the linear ones
    [[nodiscard]] static std::optional<RpimPatch> fit(const MatrixX2& u, const Multiquadric& basis,
                                                      const Matrix& polynomials);
    /// The patch of a surface: as fit() with 6 terms, but where the nodes do not determine all of them, with those that they
    /// do.
    /// @param flat    (n x 2) orthogonal projections of the nodes, m: two straight rows of them are two straight rows there
    /// @param basis   none: `suited`, or r^3 where it needs terms that are missing
    [[nodiscard]] static std::optional<RpimPatch> fit(const MatrixX2& u, const MatrixX2& flat,
                                                      const std::optional<Multiquadric>& basis,
                                                      const Multiquadric& suited, int m);

    [[nodiscard]] Index size() const { return n_; }
    [[nodiscard]] int polynomial_terms() const { return terms_; } ///< 3 to 6
    [[nodiscard]] double node_distance() const { return dc_; }    ///< dc, mean nearest-neighbour distance, m

    /// Coefficients H x of the surface through nodal positions x (n x 3), filled up with zeros to the width of a table; they
    /// make point() O(n).
    [[nodiscard]] MatrixX3 coefficients(const MatrixX3& x) const;
    /// The same; storage of both is used again. @param x  (padded_size() x 3), zeros below the nodes; overwritten
    void coefficients(MatrixX3& x, MatrixX3& result) const;
    /// Values and derivatives of the basis functions. @param rows  BasisTable::first, second or third
    void tabulate(const Vec2& u, int rows, BasisTable& table) const;

    [[nodiscard]] PatchPoint point(const Vec2& u, const MatrixX3& coefficients) const;
    /// @param table  with second derivatives
    [[nodiscard]] PatchPoint point(const BasisTable& table, const MatrixX3& coefficients) const;

    /// Weights Phi (n) and their derivatives Phi,1 Phi,2 (n x 2). Phi_i(u_j) = delta_ij; they sum to 1.  Cost O(n^2).
    void weights(const Vec2& u, Eigen::Ref<Vector> phi, Eigen::Ref<MatrixX2> phi_a) const;
    /// Weights and derivatives from the first rows of a table, or from linear combinations of rows that replaced them.
    /// @param rows   2, 3 or 6
    /// @param exact  how many of them reproduce polynomials to the last digit, 2 or 3
    /// @param phi    (rows x padded_size()) row by row
    void weights(const BasisTable& table, int rows, int exact, double* phi) const;
    /// Second derivatives Phi,11 Phi,12 Phi,22 (n x 3).
    [[nodiscard]] MatrixX3 second_derivatives(const Vec2& u) const;
    /// Third derivatives of the surface with the given coefficients(). @param table  with third derivatives
    [[nodiscard]] PatchThird third(const Vec2& u, const MatrixX3& coefficients) const;
    [[nodiscard]] PatchThird third(const BasisTable& table, const MatrixX3& coefficients) const;
    /// Length of a row of weights: n, filled up with zeros.
    [[nodiscard]] Index padded_size() const { return size_; }
    /// Puts the numbers of patches into one array, which these share; it lives as long as one of them.
    [[nodiscard]] static std::shared_ptr<const std::vector<double>> put_together(std::span<RpimPatch* const> patches);

private:
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RpimPatch() = default;

    [[nodiscard]] const double* t() const { return numbers_.get(); } ///< (2 x width) t_i, zeros behind
    // rows filled up with zeros to padded_size()
    [[nodiscard]] const double* H() const { return t() + 2 * width_; }        ///< (n + m rows) first n columns of G^-1
    [[nodiscard]] const double* D() const { return H() + (n_ + m_) * size_; } ///< (m rows) p(t_i)
    [[nodiscard]] const double* fit() const { return D() + m_ * size_; }      ///< (m rows) its least-squares inverse
    [[nodiscard]] std::size_t numbers() const { return static_cast<std::size_t>(2 * width_ + (n_ + 3 * m_) * size_); }

    Index n_ = 0, size_ = 0, width_ = 0;
    std::shared_ptr<const double[]> numbers_;
    Vec2 c_ = Vec2::Zero();
    double dc_ = 1;
    Multiquadric basis_;
    int m_ = 6;     ///< polynomials that are evaluated
    int terms_ = 6; ///< combinations of them in the basis
};

} // namespace osculate::contact
