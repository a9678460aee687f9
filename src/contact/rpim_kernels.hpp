#pragma once
/// Inner loops of radial point interpolation, on plain arrays. They are compiled for several instruction sets; results
/// are the same bits with all of them: sums over a row run in four lanes, whatever the width of a register.

#include "osculate/contact/radial_basis.hpp"
#include "osculate/core/types.hpp"

namespace osculate::contact::kernels {

/// Rows are filled up with zeros to a multiple of this.
inline constexpr Index lanes = 4;
[[nodiscard]] constexpr Index padded(Index n) {
    return (n + lanes - 1) / lanes * lanes;
}

/// Fills `table` with R(rho), rho = |t - t_i|^2, and its derivatives by u = dc t + c, one row of `width` each, in the order
/// of BasisTable.
/// @param t1, t2  (width) t_i
/// @param rows    3 to first derivatives, 6 to second, 10 to third
void radial_rows(const Multiquadric& basis, const double* t1, const double* t2, Index width, const Vec2& t, double dc,
                 int rows, double* table);

/// out (3 x rows) = sum_k table(row, k) a(k, c).
/// @param rows  6 or 4
/// @param a     three columns, `width` apart
void sums(const double* table, Index width, int rows, const double* a, double* out);

/// out (rows x size) = table (rows x functions) times H (functions x size).
/// @param rows         2, or a multiple of 3
/// @param width, size  lengths of rows of the table, and of H and out, multiples of 4
void times(const double* table, Index width, int rows, const double* H, Index functions, Index size, double* out);

/// Makes phi (rows x size) reproduce polynomials to the last digit:  phi += (p - phi D) fit.
/// @param rows  2 or 3
/// @param p    (rows x terms) values of the polynomials, rows `width` apart
/// @param D    (terms x size) the polynomials at the nodes, and `fit` (terms x size), their inverse by least squares
void reproduce(const double* p, Index width, int rows, const double* D, const double* fit, Index terms, Index size,
               double* phi);

/// Coefficients (functions and terms, 3) of the surface through x (size x 3, from one of its nodes):
///     beta = fit x,   H (x - D beta) + [0; beta]
/// @param x   three columns, `size` apart; overwritten with x - D beta
/// @param a   three columns, `width` apart
void coefficients(const double* H, Index functions, const double* D, const double* fit, Index terms, Index size,
                  double* x, Index width, double* a);

} // namespace osculate::contact::kernels
