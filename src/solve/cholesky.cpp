#include "osculate/core/error.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "solve/blas_threads.hpp"

#include <algorithm>
#include <cholmod.h>
#include <cstring>

namespace osculate::solve {
namespace {

/// What is left of a diagonal entry after elimination, of that entry, below which it counts as round-off: unlike the ratio of
/// pivots it does not take soft bodies beside stiff ones, or other units, for singular.
constexpr double negligible_pivot = 1e-13;

class Cholesky final : public DirectSolver {
public:
    Cholesky() {
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
            factor_ = cholmod_l_analyze(&view, &common_);
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
        cholmod_dense rhs{};
        rhs.nrow = rhs.d = rhs.nzmax = factor_->n;
        rhs.ncol = 1;
        rhs.x = const_cast<double*>(b);
        rhs.xtype = CHOLMOD_REAL;
        rhs.dtype = CHOLMOD_DOUBLE;
        cholmod_l_solve2(CHOLMOD_A, factor_, &rhs, nullptr, &x_, nullptr, &y_, &e_, &common_);
        std::memcpy(x, x_->x, factor_->n * sizeof(double));
    }

    SparseIndex failing_equation() const override { return failing_; }

private:
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
};

} // namespace

std::unique_ptr<DirectSolver> make_cholesky() {
    return std::make_unique<Cholesky>();
}

} // namespace osculate::solve
