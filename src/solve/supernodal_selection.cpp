#include "solve/supernodal_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

extern "C" {
void strsv_(const char* uplo, const char* trans, const char* diag, const int* n, const float* a, const int* lda,
            float* x, const int* incx);
void sgemv_(const char* trans, const int* m, const int* n, const float* alpha, const float* a, const int* lda,
            const float* x, const int* incx, const float* beta, float* y, const int* incy);
}

namespace osculate::solve {

SupernodalSelection::SupernodalSelection(const cholmod_factor& factor, std::span<const SparseIndex> equations) {
    const auto* permutation = static_cast<const SparseIndex*>(factor.Perm);
    const auto* first = static_cast<const SparseIndex*>(factor.super);
    const auto* rows_start = static_cast<const SparseIndex*>(factor.pi);
    const auto* start = static_cast<const SparseIndex*>(factor.px);
    const auto* row = static_cast<const SparseIndex*>(factor.s);
    const auto* L = static_cast<const double*>(factor.x);
    std::vector<SparseIndex> place(factor.n), supernode(factor.n);
    for (std::size_t i = 0; i < factor.n; ++i) place[permutation[i]] = static_cast<SparseIndex>(i);
    for (std::size_t s = 0; s < factor.nsuper; ++s)
        std::fill(supernode.begin() + first[s], supernode.begin() + first[s + 1], static_cast<SparseIndex>(s));
    std::vector<char> visited(factor.nsuper, 0);
    for (const SparseIndex equation : equations) visited[supernode[place[equation]]] = 1;

    std::vector<int> number(factor.n, -1); // row of the factor -> row here
    int next = 0;
    std::size_t values = 0, below = 0, most_below = 0;
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
        if (visited[s] == 0) continue;
        const SparseIndex columns = first[s + 1] - first[s], rows = rows_start[s + 1] - rows_start[s];
        if (columns < rows) visited[supernode[row[rows_start[s] + columns]]] = 1; // the parent: its ancestors follow
        visited_.push_back({next, static_cast<int>(columns), static_cast<int>(rows), below, values});
        for (SparseIndex k = first[s]; k < first[s + 1]; ++k) number[k] = next++;
        values += static_cast<std::size_t>(rows * columns);
        below += static_cast<std::size_t>(rows - columns);
        most_below = std::max(most_below, static_cast<std::size_t>(rows - columns));
    }
    L_.reserve(values);
    row_.reserve(below);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
        if (visited[s] == 0) continue;
        const SparseIndex rows = rows_start[s + 1] - rows_start[s], end = start[s] + rows * (first[s + 1] - first[s]);
        for (SparseIndex k = start[s]; k < end; ++k) L_.push_back(static_cast<float>(L[k]));
        for (SparseIndex k = rows_start[s] + first[s + 1] - first[s]; k < rows_start[s + 1]; ++k)
            row_.push_back(number[row[k]]);
    }
    for (const SparseIndex equation : equations) place_.push_back(number[place[equation]]);
    values_.resize(static_cast<std::size_t>(next));
    gathered_.resize(most_below);
}

void SupernodalSelection::solve(const double* b, double* x) {
    double largest = 0; // single precision has a short range
    for (std::size_t i = 0; i < place_.size(); ++i) {
        if (!std::isfinite(b[i])) largest = std::numeric_limits<double>::quiet_NaN();
        largest = largest < std::abs(b[i]) ? std::abs(b[i]) : largest;
    }
    if (!(largest > 0)) { // zero, or not finite
        std::fill_n(x, place_.size(), largest);
        return;
    }
    std::ranges::fill(values_, 0.0F);
    for (std::size_t i = 0; i < place_.size(); ++i) values_[place_[i]] = static_cast<float>(b[i] / largest);
    constexpr float plus = 1, minus = -1, none = 0;
    constexpr int step = 1;
    for (const Supernode& s : visited_) {
        const int below = s.rows - s.columns;
        strsv_("L", "N", "N", &s.columns, &L_[s.values], &s.rows, &values_[s.first], &step);
        if (below == 0) continue;
        sgemv_("N", &below, &s.columns, &plus, &L_[s.values] + s.columns, &s.rows, &values_[s.first], &step, &none,
               gathered_.data(), &step);
        for (int i = 0; i < below; ++i) values_[row_[s.below + i]] -= gathered_[i];
    }
    for (auto s = visited_.rbegin(); s != visited_.rend(); ++s) {
        const int below = s->rows - s->columns;
        if (below > 0) {
            for (int i = 0; i < below; ++i) gathered_[i] = values_[row_[s->below + i]];
            sgemv_("T", &below, &s->columns, &minus, &L_[s->values] + s->columns, &s->rows, gathered_.data(), &step,
                   &plus, &values_[s->first], &step);
        }
        strsv_("L", "T", "N", &s->columns, &L_[s->values], &s->rows, &values_[s->first], &step);
    }
    for (std::size_t i = 0; i < place_.size(); ++i) x[i] = largest * static_cast<double>(values_[place_[i]]);
}

} // namespace osculate::solve
