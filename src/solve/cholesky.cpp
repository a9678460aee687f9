#include "osculate/core/error.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "solve/blas_threads.hpp"
#include "solve/supernodal_selection.hpp"

#include <algorithm>
#include <cholmod.h>
#include <cstring>
#include <optional>

extern "C" void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace osculate::solve {
namespace {

/// What is left of a diagonal entry after elimination, of that entry, below which it counts as round-off: unlike the ratio of
/// pivots it does not take soft bodies beside stiff ones, or other units, for singular.
constexpr double negligible_pivot = 1e-13;

class Cholesky final : public CondensingSolver {
public:
    explicit Cholesky(std::vector<SparseIndex> kept = {}) : kept_(std::move(kept)) {
        use_one_blas_thread();
        cholmod_l_start(&common_);
        common_.print = 0; // a failed factorisation is an outcome here, not a message
        common_.supernodal = CHOLMOD_SUPERNODAL;
        common_.nmethods = 1;
        common_.method[0].ordering = CHOLMOD_METIS;
        common_.quick_return_if_not_posdef = 1;
    }
    ~Cholesky() override {
        cholmod_l_free_factor(&factor_, &common_);
        cholmod_l_free_dense(&y_, &common_);
        cholmod_l_free_dense(&e_, &common_);
        cholmod_l_free_dense(&x_, &common_);
        cholmod_l_finish(&common_);
    }
    Cholesky(const Cholesky&) = delete;
    Cholesky& operator=(const Cholesky&) = delete;

    FactorStatus factorise(const SparseMatrix& A) override {
        failing_ = -1;
        selection_.reset();
        empty_ = A.rows() == 0; // everything is held
        if (empty_) return FactorStatus::ok;
        // The rows of a symmetric CSR matrix are the columns CHOLMOD expects; it reads the lower triangle only.
        cholmod_sparse view{};
        view.nrow = view.ncol = static_cast<std::size_t>(A.rows());
        view.nzmax = static_cast<std::size_t>(A.nonzeros());
        view.p = const_cast<SparseIndex*>(A.row_start.data());
        view.i = const_cast<SparseIndex*>(A.column.data());
        view.x = const_cast<double*>(A.value.data());
        view.stype = -1;
        view.itype = CHOLMOD_LONG;
        view.xtype = CHOLMOD_REAL;
        view.dtype = CHOLMOD_DOUBLE;
        view.sorted = 1;
        view.packed = 1;
        if (factor_ == nullptr || A.pattern != pattern_) {
            cholmod_l_free_factor(&factor_, &common_);
            factor_ = kept_.empty() ? cholmod_l_analyze(&view, &common_) : analyse_keeping(A, view);
            require(factor_ != nullptr, "CHOLMOD could not analyse the matrix");
            pattern_ = A.pattern;
        }
        cholmod_l_factorize(&view, factor_, &common_);
        if (common_.status == CHOLMOD_NOT_POSDEF) {
            const auto* permutation = static_cast<const SparseIndex*>(factor_->Perm);
            if (factor_->minor < factor_->n) failing_ = permutation[factor_->minor];
            return FactorStatus::indefinite;
        }
        if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw RunFailure("out of memory in a sparse factorisation");
        require(common_.status >= CHOLMOD_OK, "CHOLMOD factorisation failed");
        failing_ = negligible_equation(A);
        return failing_ >= 0 ? FactorStatus::singular : FactorStatus::ok;
    }

    void solve(const double* b, double* x) override {
        if (empty_) return;
        require(factor_ != nullptr, "solve before factorise");
        solve_columns(b, 1);
        std::memcpy(x, x_->x, factor_->n * sizeof(double));
    }

    void solve(const Matrix& B, Matrix& X) override {
        X.resize(B.rows(), B.cols());
        if (empty_ || B.cols() == 0) return;
        require(factor_ != nullptr, "solve before factorise");
        solve_columns(B.data(), B.cols());
        X = Eigen::Map<const Matrix>(static_cast<const double*>(x_->x), B.rows(), B.cols());
    }

    SparseIndex failing_equation() const override { return failing_; }

    void select(std::span<const SparseIndex> equations) override {
        if (empty_) return;
        require(factor_ != nullptr, "select before factorise");
        if (selection_ && std::ranges::equal(equations, selected_)) return;
        selected_.assign(equations.begin(), equations.end());
        selection_.emplace(*factor_, equations);
    }

    void solve_selected(const double* b, double* x) override {
        if (empty_) return;
        require(selection_.has_value(), "solve_selected before select");
        selection_->solve(b, x);
    }

    double effort() const override {
        if (empty_ || factor_ == nullptr) return 0;
        constexpr double as_fast = 4; // dense operations are as much quicker than solutions, which wait for memory
        return common_.fl / (4 * common_.lnz) / as_fast;
    }

    Matrix compliance() override {
        const auto n = static_cast<SparseIndex>(factor_->n), k = static_cast<SparseIndex>(kept_.size());
        const auto* permutation = static_cast<const SparseIndex*>(factor_->Perm);
        std::vector<SparseIndex> place(static_cast<std::size_t>(n), -1); // equation -> position among the kept
        for (SparseIndex i = 0; i < k; ++i) place[kept_[i]] = i;
        for (SparseIndex i = n - k; i < n; ++i)
            if (place[permutation[i]] < 0) return compliance_by_solves();
        Matrix W = trailing_factor(k);
        char lower = 'L';
        auto size = static_cast<int>(k);
        int info = 0;
        dpotri_(&lower, &size, W.data(), &size, &info); // (L L^T)^-1, lower triangle
        require(info == 0, "LAPACK could not invert a Schur complement");
        Matrix result(k, k);
        for (SparseIndex j = 0; j < k; ++j) {
            const SparseIndex to = place[permutation[n - k + j]];
            for (SparseIndex i = j; i < k; ++i) {
                const SparseIndex from = place[permutation[n - k + i]];
                result(from, to) = result(to, from) = W(i, j);
            }
        }
        return result;
    }

private:
    /// Order of elimination: METIS on all but the kept unknowns, then those.
    cholmod_factor* analyse_keeping(const SparseMatrix& A, cholmod_sparse& view) {
        const SparseIndex n = A.rows(), rest = n - static_cast<SparseIndex>(kept_.size());
        std::vector<SparseIndex> number(static_cast<std::size_t>(n), 0), equation, order;
        for (const SparseIndex e : kept_) number[e] = -1;
        for (SparseIndex e = 0; e < n; ++e)
            if (number[e] == 0) {
                number[e] = static_cast<SparseIndex>(equation.size());
                equation.push_back(e);
            }
        std::vector<SparseIndex> start{0}, row;
        for (const SparseIndex e : equation) {
            for (SparseIndex k = A.row_start[e]; k < A.row_start[e + 1]; ++k)
                if (const SparseIndex r = number[A.column[k]]; r >= number[e]) row.push_back(r); // lower triangle
            start.push_back(static_cast<SparseIndex>(row.size()));
        }
        order.resize(static_cast<std::size_t>(rest));
        if (rest > 0) {
            cholmod_sparse inner{};
            inner.nrow = inner.ncol = static_cast<std::size_t>(rest);
            inner.nzmax = row.size();
            inner.p = start.data();
            inner.i = row.data();
            inner.stype = -1;
            inner.itype = CHOLMOD_LONG;
            inner.xtype = CHOLMOD_PATTERN;
            inner.sorted = inner.packed = 1;
            require(cholmod_l_metis(&inner, nullptr, 0, 1, order.data(), &common_) != 0, "METIS failed");
        }
        for (SparseIndex& e : order) e = equation[e];
        order.insert(order.end(), kept_.begin(), kept_.end());
        common_.method[0].ordering = CHOLMOD_GIVEN;
        return cholmod_l_analyze_p(&view, order.data(), nullptr, 0, &common_);
    }

    /// The last k rows and columns of L, dense, k x k.
    [[nodiscard]] Matrix trailing_factor(SparseIndex k) const {
        const auto* first = static_cast<const SparseIndex*>(factor_->super);
        const auto* rows_start = static_cast<const SparseIndex*>(factor_->pi);
        const auto* start = static_cast<const SparseIndex*>(factor_->px);
        const auto* row = static_cast<const SparseIndex*>(factor_->s);
        const auto* L = static_cast<const double*>(factor_->x);
        const SparseIndex begin = static_cast<SparseIndex>(factor_->n) - k;
        Matrix result = Matrix::Zero(k, k);
        for (std::size_t s = 0; s < factor_->nsuper; ++s) {
            const SparseIndex rows = rows_start[s + 1] - rows_start[s];
            for (SparseIndex c = std::max(first[s], begin); c < first[s + 1]; ++c)
                for (SparseIndex r = c - first[s]; r < rows; ++r)
                    result(row[rows_start[s] + r] - begin, c - begin) = L[start[s] + (c - first[s]) * rows + r];
        }
        return result;
    }

    /// Where elimination had to take another order than asked for, as where parts of the matrix do not touch.
    [[nodiscard]] Matrix compliance_by_solves() {
        constexpr SparseIndex batch = 64; // beyond it solves get no cheaper
        const auto n = static_cast<SparseIndex>(factor_->n), k = static_cast<SparseIndex>(kept_.size());
        Matrix result(k, k), rhs;
        for (SparseIndex begin = 0; begin < k; begin += batch) {
            const SparseIndex count = std::min(batch, k - begin);
            rhs.setZero(n, count);
            for (SparseIndex c = 0; c < count; ++c) rhs(kept_[begin + c], c) = 1;
            solve_columns(rhs.data(), count);
            const Eigen::Map<const Matrix> x(static_cast<const double*>(x_->x), n, count);
            for (SparseIndex c = 0; c < count; ++c)
                for (SparseIndex i = 0; i < k; ++i) result(i, begin + c) = x(kept_[i], c);
        }
        return 0.5 * (result + result.transpose());
    }

    /// Into x_.
    void solve_columns(const double* b, SparseIndex columns) {
        cholmod_dense rhs{};
        rhs.nrow = rhs.d = factor_->n;
        rhs.ncol = static_cast<std::size_t>(columns);
        rhs.nzmax = rhs.nrow * rhs.ncol;
        rhs.x = const_cast<double*>(b);
        rhs.xtype = CHOLMOD_REAL;
        rhs.dtype = CHOLMOD_DOUBLE;
        cholmod_l_solve2(CHOLMOD_A, factor_, &rhs, nullptr, &x_, nullptr, &y_, &e_, &common_);
    }

    /// The first equation whose pivot is negligible, -1 where there is none.
    [[nodiscard]] SparseIndex negligible_equation(const SparseMatrix& A) const {
        const auto* permutation = static_cast<const SparseIndex*>(factor_->Perm);
        const auto* first = static_cast<const SparseIndex*>(factor_->super);
        const auto* row = static_cast<const SparseIndex*>(factor_->pi);
        const auto* start = static_cast<const SparseIndex*>(factor_->px);
        const auto* L = static_cast<const double*>(factor_->x);
        for (std::size_t s = 0; s < factor_->nsuper; ++s) {
            const SparseIndex rows = row[s + 1] - row[s];
            for (SparseIndex k = first[s]; k < first[s + 1]; ++k) {
                const double pivot = L[start[s] + (k - first[s]) * (rows + 1)];
                const SparseIndex equation = permutation[k];
                const auto begin = A.column.begin() + A.row_start[equation];
                const auto end = A.column.begin() + A.row_start[equation + 1];
                const double diagonal = A.value[std::lower_bound(begin, end, equation) - A.column.begin()];
                if (!(pivot * pivot > negligible_pivot * diagonal)) return equation;
            }
        }
        return -1;
    }

    cholmod_common common_{};
    cholmod_factor* factor_ = nullptr;
    cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;
    std::uint64_t pattern_ = 0;
    SparseIndex failing_ = -1;
    bool empty_ = false;
    std::vector<SparseIndex> kept_, selected_;
    std::optional<SupernodalSelection> selection_; ///< at selected_
};

} // namespace

std::unique_ptr<DirectSolver> make_cholesky() {
    return std::make_unique<Cholesky>();
}

std::unique_ptr<CondensingSolver> make_condensing_cholesky(std::vector<SparseIndex> kept) {
    return std::make_unique<Cholesky>(std::move(kept));
}

} // namespace osculate::solve
