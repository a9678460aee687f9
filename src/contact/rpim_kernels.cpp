#include "contact/rpim_kernels.hpp"

#include <cmath>
#include <cstring>

// Each kernel is compiled twice, and the one for this processor is chosen as the program is loaded. Neither contracts
// a * b + c, so both give the same bits. Sanitizers are not ready when the choice is made.
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&    \
    !defined(__clang__)
#define OSCULATE_CLONES [[gnu::target_clones("avx2", "default")]]
#else
#define OSCULATE_CLONES
#endif
#define OSCULATE_INLINE [[gnu::always_inline]] inline
// Sums stay in registers only if their number is known: loops over rows and blocks are written out.
#ifdef __clang__
#define OSCULATE_UNROLL _Pragma("unroll")
#else
#define OSCULATE_UNROLL _Pragma("GCC unroll 8")
#endif

namespace osculate::contact::kernels {

namespace {

constexpr Index most_terms = 6; ///< of the polynomials

/// Four lanes of a sum; a compiler without registers of this width takes two.
using Four [[gnu::vector_size(32)]] = double;

OSCULATE_INLINE void load(const double* from, Four& into) {
    std::memcpy(&into, from, sizeof into);
}
OSCULATE_INLINE void store(const Four& from, double* into) {
    std::memcpy(into, &from, sizeof from);
}
OSCULATE_INLINE double sum_of(const Four& a) {
    return (a[0] + a[1]) + (a[2] + a[3]);
}

struct RadialFour {
    Four f, df, ddf, dddf;
};
OSCULATE_INLINE void root_of(const Four& a, Four& root) {
    root = Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
/// Added to divisors that are zero at the centre of a polyharmonic, where all they divide is multiplied by zero.
constexpr double tiny = 1e-100;

// Multiquadric::operator(), four at a time
struct FifthPower {
    double R2;
    OSCULATE_INLINE RadialFour operator()(Index, const Four& rho) const {
        const Four base = rho + R2;
        Four root;
        root_of(base, root);
        return {base * base * root, 2.5 * base * root, 3.75 * root, 1.875 / (root + tiny)};
    }
};
struct ThirdPower {
    double R2;
    OSCULATE_INLINE RadialFour operator()(Index, const Four& rho) const {
        const Four base = rho + R2;
        Four root;
        root_of(base, root);
        const Four second = 0.75 / (root + tiny);
        return {base * root, 1.5 * root, second, -0.5 * second / (base + tiny)};
    }
};
struct AnyPower {
    double R2, q;
    const double* power; ///< of the bases
    OSCULATE_INLINE RadialFour operator()(Index i, const Four& rho) const {
        RadialFour r;
        const Four by_base = 1 / (rho + (R2 + tiny));
        load(power + i, r.f);
        r.df = q * r.f * by_base;
        r.ddf = (q - 1) * r.df * by_base;
        r.dddf = (q - 2) * r.ddf * by_base;
        return r;
    }
};

/// Derivatives by u from those by rho, with d = t - t_i:
///     f,a   = 2 f' d_a /dc,   f,ab = (2 f' delta_ab + 4 f'' d_a d_b) /dc^2
///     f,abc = (8 f''' d_a d_b d_c + 4 f'' (delta_ab d_c + delta_bc d_a + delta_ca d_b)) /dc^3
template <int rows, class Radial>
OSCULATE_INLINE void fill(const Radial& radial, const double* t1, const double* t2, Index width, double t_1, double t_2,
                          double dc, double* table) {
    const double a = 1 / dc, b = a * a, c = b * a;
    for (Index i = 0; i < width; i += lanes) {
        Four x, y;
        load(t1 + i, x);
        load(t2 + i, y);
        x = t_1 - x;
        y = t_2 - y;
        const RadialFour r = radial(i, x * x + y * y);
        double* const at = table + i;
        const Four by_d = (2 * a) * r.df;
        store(r.f, at);
        store(by_d * x, at + width);
        store(by_d * y, at + 2 * width);
        if constexpr (rows > 3) {
            const Four both = (2 * b) * r.df, by_dd = (4 * b) * r.ddf;
            store(both + by_dd * x * x, at + 3 * width);
            store(by_dd * x * y, at + 4 * width);
            store(both + by_dd * y * y, at + 5 * width);
        }
        if constexpr (rows > 6) {
            const Four once = (4 * c) * r.ddf, by_ddd = (8 * c) * r.dddf, xx = by_ddd * x * x, yy = by_ddd * y * y;
            store((xx + 3 * once) * x, at + 6 * width);
            store((xx + once) * y, at + 7 * width);
            store((yy + once) * x, at + 8 * width);
            store((yy + 3 * once) * y, at + 9 * width);
        }
    }
}

template <int rows>
OSCULATE_INLINE void fill(const Multiquadric& basis, const double* t1, const double* t2, Index width, double t_1,
                          double t_2, double dc, double* table) {
    const double R2 = basis.R * basis.R, q = basis.q;
    if (q == 2.5) return fill<rows>(FifthPower{R2}, t1, t2, width, t_1, t_2, dc, table);
    if (q == 1.5) return fill<rows>(ThirdPower{R2}, t1, t2, width, t_1, t_2, dc, table);
    for (Index i = 0; i < width; ++i) {
        const double x = t_1 - t1[i], y = t_2 - t2[i], base = x * x + y * y + R2;
        table[i] = base > 0 ? std::pow(base, q) : 0;
    }
    fill<rows>(AnyPower{R2, q, table}, t1, t2, width, t_1, t_2, dc, table);
}

template <int rows> OSCULATE_INLINE void sum(const double* table, Index width, const double* a, double* out) {
    for (int c = 0; c < 3; ++c) {
        Four sums[rows]{};
        for (Index k = 0; k < width; k += lanes) {
            Four factor, value;
            load(a + c * width + k, factor);
            OSCULATE_UNROLL
            for (int r = 0; r < rows; ++r) {
                load(table + r * width + k, value);
                sums[r] += value * factor;
            }
        }
        OSCULATE_UNROLL
        for (int r = 0; r < rows; ++r) out[3 * r + c] = sum_of(sums[r]);
    }
}

/// `blocks` times four columns of a product: as many as stay in registers.
template <int rows, int blocks>
OSCULATE_INLINE void times_columns(const double* table, Index width, const double* H, Index functions, Index size,
                                   double* out) {
    Four result[rows][blocks]{};
    for (Index k = 0; k < functions; ++k, H += size) {
        Four h[blocks];
        OSCULATE_UNROLL
        for (int b = 0; b < blocks; ++b) load(H + lanes * b, h[b]);
        OSCULATE_UNROLL
        for (int r = 0; r < rows; ++r) {
            const double factor = table[r * width + k];
            OSCULATE_UNROLL
            for (int b = 0; b < blocks; ++b) result[r][b] += factor * h[b];
        }
    }
    OSCULATE_UNROLL
    for (int r = 0; r < rows; ++r) OSCULATE_UNROLL
    for (int b = 0; b < blocks; ++b) store(result[r][b], out + r * size + lanes * b);
}

/// All columns, `most` blocks at a time, then what is left in one go.
template <int rows, int most>
OSCULATE_INLINE void times(const double* table, Index width, const double* H, Index functions, Index size,
                           double* out) {
    Index i = 0;
    for (; i + most * lanes <= size; i += most * lanes)
        times_columns<rows, most>(table, width, H + i, functions, size, out + i);
    const Index left = (size - i) / lanes;
    if constexpr (most > 6)
        if (left == 6) return times_columns<rows, 6>(table, width, H + i, functions, size, out + i);
    if constexpr (most > 5)
        if (left == 5) return times_columns<rows, 5>(table, width, H + i, functions, size, out + i);
    if constexpr (most > 4)
        if (left == 4) return times_columns<rows, 4>(table, width, H + i, functions, size, out + i);
    if constexpr (most > 3)
        if (left == 3) return times_columns<rows, 3>(table, width, H + i, functions, size, out + i);
    if constexpr (most > 2)
        if (left == 2) return times_columns<rows, 2>(table, width, H + i, functions, size, out + i);
    if (left == 1) times_columns<rows, 1>(table, width, H + i, functions, size, out + i);
}

template <int rows>
OSCULATE_INLINE void reproduce(const double* p, Index width, const double* D, const double* fit, Index terms,
                               Index size, double* phi) {
    double missing[rows][most_terms];
    for (Index j = 0; j < terms; ++j) {
        Four sums[rows]{};
        for (Index i = 0; i < size; i += lanes) {
            Four factor, value;
            load(D + j * size + i, factor);
            OSCULATE_UNROLL
            for (int r = 0; r < rows; ++r) {
                load(phi + r * size + i, value);
                sums[r] += value * factor;
            }
        }
        OSCULATE_UNROLL
        for (int r = 0; r < rows; ++r) missing[r][j] = p[r * width + j] - sum_of(sums[r]);
    }
    for (Index i = 0; i < size; i += lanes) {
        Four value[rows], factor;
        OSCULATE_UNROLL
        for (int r = 0; r < rows; ++r) load(phi + r * size + i, value[r]);
        for (Index j = 0; j < terms; ++j) {
            load(fit + j * size + i, factor);
            OSCULATE_UNROLL
            for (int r = 0; r < rows; ++r) value[r] += missing[r][j] * factor;
        }
        OSCULATE_UNROLL
        for (int r = 0; r < rows; ++r) store(value[r], phi + r * size + i);
    }
}

/// Products of a row of length `size` with three columns.
OSCULATE_INLINE void with_columns(const double* row, const double* x, Index size, double (&out)[3]) {
    Four sums[3]{};
    for (Index i = 0; i < size; i += lanes) {
        Four factor, value;
        load(row + i, factor);
        for (int c = 0; c < 3; ++c) {
            load(x + c * size + i, value);
            sums[c] += value * factor;
        }
    }
    for (int c = 0; c < 3; ++c) out[c] = sum_of(sums[c]);
}

} // namespace

OSCULATE_CLONES void radial_rows(const Multiquadric& basis, const double* t1, const double* t2, Index width,
                                 const Vec2& t, double dc, int rows, double* table) {
    const double t_1 = t(0), t_2 = t(1);
    if (rows == 3) return fill<3>(basis, t1, t2, width, t_1, t_2, dc, table);
    if (rows == 6) return fill<6>(basis, t1, t2, width, t_1, t_2, dc, table);
    fill<10>(basis, t1, t2, width, t_1, t_2, dc, table);
}

OSCULATE_CLONES void sums(const double* table, Index width, int rows, const double* a, double* out) {
    if (rows == 6) return sum<6>(table, width, a, out);
    sum<4>(table, width, a, out);
}

OSCULATE_CLONES void times(const double* table, Index width, int rows, const double* H, Index functions, Index size,
                           double* out) {
    // as many columns at a time as have room in 16 registers
    if (rows == 2) return times<2, 7>(table, width, H, functions, size, out);
    if (rows == 3) return times<3, 3>(table, width, H, functions, size, out);
    for (int r = 0; r < rows; r += 3) times<3, 4>(table + r * width, width, H, functions, size, out + r * size);
}

OSCULATE_CLONES void reproduce(const double* p, Index width, int rows, const double* D, const double* fit, Index terms,
                               Index size, double* phi) {
    if (rows == 2) return reproduce<2>(p, width, D, fit, terms, size, phi);
    reproduce<3>(p, width, D, fit, terms, size, phi);
}

OSCULATE_CLONES void coefficients(const double* H, Index functions, const double* D, const double* fit, Index terms,
                                  Index size, double* x, Index width, double* a) {
    double beta[most_terms][3];
    for (Index j = 0; j < terms; ++j) with_columns(fit + j * size, x, size, beta[j]);
    for (int c = 0; c < 3; ++c)
        for (Index i = 0; i < size; i += lanes) {
            Four value, factor;
            load(x + c * size + i, value);
            for (Index j = 0; j < terms; ++j) {
                load(D + j * size + i, factor);
                value -= beta[j][c] * factor;
            }
            store(value, x + c * size + i);
        }
    for (Index k = 0; k < width; ++k) {
        double row[3] = {0, 0, 0};
        if (k < functions) with_columns(H + k * size, x, size, row);
        const Index j = k - (functions - terms);
        for (int c = 0; c < 3; ++c) a[c * width + k] = row[c] + (j >= 0 && j < terms ? beta[j][c] : 0);
    }
}

} // namespace osculate::contact::kernels
