#include "solve/gmres_vector.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/ranks.hpp"
#include "osculate/core/thread_pool.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nvector/nvector_serial.h>
#include <span>
#include <vector>

namespace osculate::solve {
namespace {

/// Begins as serial vectors do, whose other operations read no further.
struct Content {
    _N_VectorContent_Serial slice;
    Ranks* ranks;
    int threads;
};

constexpr Index at_once = 4096; // numbers whose products are added up by themselves, in the order of the vector

const Content& content(N_Vector v) {
    return *static_cast<const Content*>(v->content);
}
Index length_of(N_Vector v) {
    return static_cast<Index>(content(v).slice.length);
}
const double* values(N_Vector v) {
    return content(v).slice.data;
}

Index parts_of(N_Vector v) {
    return (length_of(v) + at_once - 1) / at_once;
}
/// Chunks of a vector that threads work on side by side.
Index chunks_of(N_Vector v) {
    return std::clamp<Index>(parts_of(v) / 2, 1, content(v).threads); // shorter loops end before a thread wakes
}

/// Calls body(begin, end) on parts of a vector, which begin at multiples of at_once.
void share(N_Vector v, auto&& body) {
    const Index parts = parts_of(v), chunks = chunks_of(v);
    if (chunks == 1) {
        body(Index{0}, length_of(v));
        return;
    }
    run_side_by_side(chunks, [&](Index chunk) {
        body(at_once * static_cast<Index>(std::int64_t{parts} * chunk / chunks),
             std::min(at_once * static_cast<Index>(std::int64_t{parts} * (chunk + 1) / chunks), length_of(v)));
    });
}

/// Eight sums, so that one does not wait for another.
double product(const double* a, const double* b, Index length) {
    constexpr Index sums = 8;
    std::array<double, sums> sum{};
    Index i = 0;
    for (; i + sums <= length; i += sums)
        for (Index k = 0; k < sums; ++k) sum[static_cast<std::size_t>(k)] += a[i + k] * b[i + k];
    for (Index k = 0; i < length; ++i, ++k) sum[static_cast<std::size_t>(k)] += a[i] * b[i];
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

double own_dot(N_Vector a, N_Vector b) {
    const auto of_part = [&](Index i, Index end) {
        return product(values(a) + i, values(b) + i, std::min(at_once, end - i));
    };
    double sum = 0;
    if (chunks_of(a) == 1) {
        for (Index i = 0; i < length_of(a); i += at_once) sum += of_part(i, length_of(a));
        return sum;
    }
    std::vector<double> part(static_cast<std::size_t>(parts_of(a)));
    share(a, [&](Index begin, Index end) {
        for (Index i = begin; i < end; i += at_once) part[i / at_once] = of_part(i, end);
    });
    for (const double p : part) sum += p;
    return sum;
}

double dot(N_Vector a, N_Vector b) {
    double sum = own_dot(a, b);
    if (content(a).ranks != nullptr) content(a).ranks->sum({&sum, 1});
    return sum;
}

/// The same sums as by dot(); each part of `a` is read once.
int dots(int count, N_Vector a, N_Vector* with, double* products) {
    const auto of = static_cast<std::size_t>(count);
    const Index parts = parts_of(a);
    std::vector<double> part(static_cast<std::size_t>(parts) * of);
    share(a, [&](Index begin, Index end) {
        for (Index i = begin; i < end; i += at_once)
            for (std::size_t k = 0; k < of; ++k)
                part[static_cast<std::size_t>(i / at_once) * of + k] =
                    product(values(a) + i, values(with[k]) + i, std::min(at_once, end - i));
    });
    std::fill_n(products, count, 0.0);
    for (Index p = 0; p < parts; ++p)
        for (std::size_t k = 0; k < of; ++k) products[k] += part[static_cast<std::size_t>(p) * of + k];
    if (content(a).ranks != nullptr) content(a).ranks->sum({products, static_cast<std::size_t>(count)});
    return 0;
}

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    const double *from = values(x), *other = values(y);
    double* to = content(z).slice.data;
    share(x, [=](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) to[i] = a * from[i] + b * other[i];
    });
}

void scale(double c, N_Vector x, N_Vector z) {
    const double* from = values(x);
    double* to = content(z).slice.data;
    share(x, [=](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) to[i] = c * from[i];
    });
}

/// z = sum_k c_k x_k, where x_0 may be z; each part of z is written once.
int combine(int count, double* c, N_Vector* x, N_Vector z) {
    double* to = content(z).slice.data;
    share(z, [&](Index begin, Index end) {
        for (Index first = begin; first < end; first += at_once) {
            const Index last = std::min(first + at_once, end);
            const double* from = values(x[0]);
            for (Index i = first; i < last; ++i) to[i] = c[0] * from[i];
            for (int k = 1; k < count; ++k) {
                from = values(x[k]);
                const double factor = c[k];
                for (Index i = first; i < last; ++i) to[i] += factor * from[i];
            }
        }
    });
    return 0;
}

/// Makes a serial vector one of these. Its own operations free the content by free().
N_Vector extended(N_Vector serial, Ranks* ranks, int threads) {
    require(serial != nullptr, "no memory for a vector");
    auto* content = static_cast<Content*>(std::malloc(sizeof(Content)));
    require(content != nullptr, "no memory for a vector");
    *content = {*static_cast<N_VectorContent_Serial>(serial->content), ranks, threads};
    std::free(serial->content);
    serial->content = content;
    return serial;
}

/// Of all slices.
double largest(N_Vector v) {
    double own = 0; // of absolute values; of what is no number, it may be anything: callers look for these first
    for (Index i = 0; i < length_of(v); ++i) own = std::max(own, std::abs(values(v)[i]));
    return content(v).ranks->largest(own);
}
double smallest(N_Vector v) {
    double own = -std::numeric_limits<double>::max(); // of negatives
    for (Index i = 0; i < length_of(v); ++i) own = std::max(own, -values(v)[i]);
    return -content(v).ranks->largest(own);
}
double weighted_norm(N_Vector v, N_Vector weight) {
    double sum = 0;
    for (Index i = 0; i < length_of(v); ++i) sum += std::pow(values(v)[i] * values(weight)[i], 2);
    content(v).ranks->sum({&sum, 1});
    return std::sqrt(sum);
}

N_Vector clone(N_Vector of) {
    return extended(N_VClone_Serial(of), content(of).ranks, content(of).threads);
}

} // namespace

N_Vector make_gmres_vector(Index length, Ranks* ranks, int threads, SUNContext context) {
    N_Vector v = extended(N_VMake_Serial(length, nullptr, context), ranks, threads);
    if (ranks != nullptr) N_VEnableFusedOps_Serial(v, SUNTRUE);
    v->ops->nvclone = clone;
    v->ops->nvdotprod = dot;
    if (ranks != nullptr) {
        v->ops->nvdotprodmulti = dots;
        v->ops->nvlinearcombination = combine;
        v->ops->nvmaxnorm = largest;
        v->ops->nvmin = smallest;
        v->ops->nvwl2norm = weighted_norm;
        // those that nobody calls would speak of a slice alone
        v->ops->nvwrmsnorm = nullptr;
        v->ops->nvwrmsnormmask = nullptr;
        v->ops->nvl1norm = nullptr;
        v->ops->nvinvtest = nullptr;
        v->ops->nvconstrmask = nullptr;
        v->ops->nvminquotient = nullptr;
        v->ops->nvwrmsnormvectorarray = nullptr;
        v->ops->nvwrmsnormmaskvectorarray = nullptr;
    }
    v->ops->nvlinearsum = linear_sum;
    v->ops->nvscale = scale;
    return v;
}

} // namespace osculate::solve
