#include "osculate/core/error.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "solve/blas_threads.hpp"

#include <cholmod.h>
#include <cstring>

namespace osculate::solve {
namespace {

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
        failing_ = -1;
        if (common_.status == CHOLMOD_NOT_POSDEF) {
            const auto* permutation = static_cast<const SparseIndex*>(factor_->Perm);
            if (factor_->minor < factor_->n) failing_ = permutation[factor_->minor];
            return FactorStatus::indefinite;
        }
        if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw RunFailure("out of memory in a sparse factorisation");
        require(common_.status >= CHOLMOD_OK, "CHOLMOD factorisation failed");
        return cholmod_l_rcond(factor_, &common_) < 1e-15 ? FactorStatus::singular : FactorStatus::ok;
    }

    void solve(const double* b, double* x) override {
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
    cholmod_common common_{};
    cholmod_factor* factor_ = nullptr;
    cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;
    std::uint64_t pattern_ = 0;
    SparseIndex failing_ = -1;
};

} // namespace

std::unique_ptr<DirectSolver> make_cholesky() {
    return std::make_unique<Cholesky>();
}

} // namespace osculate::solve
