#include "multigrid/fine_grid.hpp"

#include "osculate/core/parallel.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace osculate::solve {
namespace {

auto at(auto* x, Index i) {
    using Map = std::conditional_t<std::is_const_v<std::remove_pointer_t<decltype(x)>>, const Vec3, Vec3>;
    return Eigen::Map<Map>(x + 3 * static_cast<std::size_t>(i));
}

/// Some rows of a matrix in single precision.
struct Rows {
    const Index *begin, *end; ///< where each starts, and where the last ends
    const Index* column;      ///< of all rows
    const float* value;
};

/// to_i = (A x)_i of these rows, one after the other.
void multiply_by_one(const Rows& A, const double* x, double* to) {
    for (const Index* start = A.begin; start != A.end; ++start, to += 3) {
        double sum[3] = {};
        for (Index k = start[0]; k < start[1]; ++k) {
            const double* from = x + 3 * static_cast<std::size_t>(A.column[k]);
            const float* value = A.value + 9 * static_cast<std::size_t>(k);
            for (std::size_t c = 0; c < 3; ++c, value += 3)
                for (std::size_t r = 0; r < 3; ++r) sum[r] += static_cast<double>(value[r]) * from[c];
        }
        std::copy(sum, sum + 3, to);
    }
}

#if defined(__x86_64__)
/// The same sums, three at a time.
[[gnu::target("avx2")]] void multiply_by_four(const Rows& A, const double* x, double* to) {
    for (const Index* start = A.begin; start != A.end; ++start, to += 3) {
        __m256d sum = _mm256_setzero_pd();
        const float* value = A.value + 9 * static_cast<std::size_t>(start[0]);
        for (Index k = start[0]; k < start[1]; ++k) {
            const double* from = x + 3 * static_cast<std::size_t>(A.column[k]);
            for (std::size_t c = 0; c < 3; ++c, value += 3) // the fourth value is the next column's
                sum = _mm256_add_pd(sum,
                                    _mm256_mul_pd(_mm256_cvtps_pd(_mm_loadu_ps(value)), _mm256_broadcast_sd(from + c)));
        }
        _mm_storeu_pd(to, _mm256_castpd256_pd128(sum));
        _mm_store_sd(to + 2, _mm256_extractf128_pd(sum, 1));
    }
}
#endif

void multiply(const Rows& A, const double* x, double* to) {
#if defined(__x86_64__)
    static const auto by_this_processor = __builtin_cpu_supports("avx2") ? multiply_by_four : multiply_by_one;
    by_this_processor(A, x, to);
#else
    multiply_by_one(A, x, to);
#endif
}

} // namespace

FineGrid::FineGrid(const FreeNodes& nodes, const NodalMatrix& bodies, int threads)
    : nodes_(nodes), threads_(threads), start_{0} {
    for (Index i = 0; i < nodes_.size(); ++i) {
        nodes_.for_row(bodies, i, [&](Index j, const Mat3&) { node_.push_back(j); });
        start_.push_back(static_cast<Index>(node_.size()));
    }
    value_.resize(9 * node_.size() + 1); // columns are read four values at a time
    diagonal_.resize(static_cast<std::size_t>(nodes_.size()));
    take(bodies);
}

void FineGrid::take(const NodalMatrix& bodies) {
    parallel_for(threads_, nodes_.size(), [&](Index begin, Index end) {
        float* to = value_.data() + 9 * static_cast<std::size_t>(start_[begin]);
        for (Index i = begin; i < end; ++i)
            nodes_.for_row(bodies, i, [&](Index j, Mat3 block) {
                if (i == j) {
                    const double scale = block.trace() > 0 ? block.trace() : 1;
                    block += scale * (Mat3::Identity() - nodes_.projection(i));
                    diagonal_[i] = block;
                }
                for (Index k = 0; k < 9; ++k) *to++ = static_cast<float>(block(k));
            });
    });
    couple({});
    std::vector<Index> all(static_cast<std::size_t>(nodes_.size()));
    std::iota(all.begin(), all.end(), 0);
    largest_of_bodies_ = estimate(all);
}

void FineGrid::couple(Coupling coupling) {
    coupling_ = std::move(coupling);
    inverse_ = diagonal_;
    std::vector<char> is_near(static_cast<std::size_t>(nodes_.with_copies()),
                              0); // stiff springs show in their nodes and next to them
    for (Index r = 0; r < coupling_.rows(); ++r) {
        const Index i = coupling_.row(r);
        for (Index k = coupling_.begin(r); k < coupling_.end(r); ++k)
            if (coupling_.column(k) == i) inverse_[i] += coupling_.block(k);
        for (Index k = start_[i]; k < start_[i + 1]; ++k) is_near[node_[k]] = 1;
    }
    parallel_for(threads_, nodes_.size(), [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) inverse_[i] = inverse_[i].inverse().eval();
    });

    if (!nodes_.exchange().alone()) { // a node may be near by the coupling of another process
        std::vector<double> marks(is_near.begin(), is_near.end());
        nodes_.exchange().add(marks.data(), 1);
        for (Index i = 0; i < nodes_.size(); ++i) is_near[i] = marks[i] > 0 ? 1 : 0;
    }
    std::vector<Index> near;
    for (Index i = 0; i < nodes_.size(); ++i)
        if (is_near[i] != 0) near.push_back(i);
    largest_of_coupled_ = estimate(near);
}

template <class Each> void FineGrid::for_rows(double* x, Each&& each) const {
    nodes_.exchange().fill(x, 3);
    parallel_for(threads_, nodes_.size(), [&](Index begin, Index end) {
        constexpr Index at_once = 128; // their products stay in the cache
        double product[3 * at_once];
        Index r = coupling_.first_row_from(begin);
        for (Index first = begin; first < end; first += at_once) {
            const Index last = std::min(first + at_once, end);
            multiply({start_.data() + first, start_.data() + last, node_.data(), value_.data()}, x, product);
            for (; r < coupling_.rows() && coupling_.row(r) < last; ++r)
                for (Index k = coupling_.begin(r); k < coupling_.end(r); ++k)
                    at(product, coupling_.row(r) - first) += coupling_.block(k) * at(x, coupling_.column(k));
            for (Index i = first; i < last; ++i) each(i, at(std::as_const(product), i - first));
        }
    });
}

void FineGrid::residual(const double* b, double* x, double* r) const {
    for_rows(x, [&](Index i, const Vec3& Ax) { at(r, i) = at(b, i) - Ax; });
}

void FineGrid::sweep(const double* b, double* x, const double* before, double momentum, double step, double* to) const {
    for_rows(x, [&](Index i, const Vec3& Ax) {
        const Vec3 moved = before == nullptr ? Vec3(at(x, i)) : Vec3(at(x, i) - at(before, i));
        at(to, i) = at(x, i) + momentum * moved + step * (inverse_[i] * (at(b, i) - Ax));
    });
}

void FineGrid::first_sweep(const double* b, double step, double* to) const {
    parallel_for(threads_, nodes_.size(), [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) at(to, i) = step * (inverse_[i] * at(b, i));
    });
}

double FineGrid::estimate(std::span<const Index> rows) const {
    constexpr int iterations = 12;
    constexpr double short_of_it = 1.1; // what these iterations lack
    Vector x = Vector::Zero(3 * nodes_.with_copies()), y(x.size());
    for (const Index i : rows)
        for (Index k = 0; k < 3; ++k)
            at(x.data(), i)(k) = std::sin(1.0 + 7.0 * (3 * nodes_.place(i) + k)); // rich in all frequencies
    double largest = 0;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        double squares = 0;
        for (const Index i : rows) squares += at(x.data(), i).squaredNorm();
        if (!nodes_.exchange().alone()) squares = sum_over_ranks({squares}).front();
        if (squares == 0) return 0; // no rows
        largest = std::sqrt(squares);
        for (const Index i : rows) at(x.data(), i) /= largest;
        nodes_.exchange().fill(x.data(), 3);
        parallel_for(threads_, static_cast<Index>(rows.size()), [&](Index begin, Index end) {
            for (const Index i : rows.subspan(begin, end - begin))
                multiply({&start_[i], &start_[i] + 1, node_.data(), value_.data()}, x.data(), &at(y.data(), i)(0));
        });
        for (Index r = 0; r < coupling_.rows(); ++r)
            for (Index k = coupling_.begin(r); k < coupling_.end(r); ++k)
                at(y.data(), coupling_.row(r)) += coupling_.block(k) * at(x.data(), coupling_.column(k));
        for (const Index i : rows) at(x.data(), i) = inverse_[i] * at(y.data(), i);
    }
    return short_of_it * largest;
}

} // namespace osculate::solve
