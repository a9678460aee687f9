#include "osculate/core/error.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "solve/blas_threads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <umfpack.h>
#include <vector>

namespace osculate::solve {
namespace {

/// Smallest over largest pivot below which the matrix counts as singular. UMFPACK scales by the unknowns first, so that
/// neither units nor soft bodies beside stiff ones count.
constexpr double singular_rcond = 1e-14;

class Lu final : public DirectSolver {
public:
    Lu() {
        use_one_blas_thread();
        umfpack_dl_defaults(control_.data());
        control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
        control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
        control_[UMFPACK_PRL] = 0;
        control_[UMFPACK_IRSTEP] = 1;
    }
    ~Lu() override {
        umfpack_dl_free_numeric(&numeric_);
        umfpack_dl_free_symbolic(&symbolic_);
    }
    Lu(const Lu&) = delete;
    Lu& operator=(const Lu&) = delete;

    FactorStatus factorise(const SparseMatrix& A) override {
        if (symbolic_ == nullptr || A.pattern != pattern_) {
            umfpack_dl_free_symbolic(&symbolic_);
            // UMFPACK takes columns: it is given A^T, and solve() asks for the transposed system
            const long status = umfpack_dl_symbolic(A.rows(), A.rows(), A.row_start.data(), A.column.data(),
                                                    A.value.data(), &symbolic_, control_.data(), info_.data());
            if (status == UMFPACK_ERROR_out_of_memory) throw RunFailure("out of memory in a sparse factorisation");
            require(status == UMFPACK_OK, "UMFPACK could not analyse the matrix");
            pattern_ = A.pattern;
        }
        umfpack_dl_free_numeric(&numeric_);
        const long status = umfpack_dl_numeric(A.row_start.data(), A.column.data(), A.value.data(), symbolic_,
                                               &numeric_, control_.data(), info_.data());
        if (status == UMFPACK_ERROR_out_of_memory) throw RunFailure("out of memory in a sparse factorisation");
        require(status == UMFPACK_OK || status == UMFPACK_WARNING_singular_matrix, "UMFPACK factorisation failed");
        // iterative refinement in solve() reads the matrix again
        matrix_ = &A;
        failing_ = -1;
        if (status == UMFPACK_OK && info_[UMFPACK_RCOND] > singular_rcond) return FactorStatus::ok;
        failing_ = smallest_pivot(A.rows());
        return FactorStatus::singular;
    }

    void solve(const double* b, double* x) override {
        require(numeric_ != nullptr, "solve before factorise");
        umfpack_dl_solve(UMFPACK_At, matrix_->row_start.data(), matrix_->column.data(), matrix_->value.data(), x, b,
                         numeric_, control_.data(), info_.data());
    }

    void solve(const Matrix& B, Matrix& X) override {
        const double steps =
            control_[UMFPACK_IRSTEP]; // of refinement, which takes twice the time of the solution itself
        control_[UMFPACK_IRSTEP] = 0;
        DirectSolver::solve(B, X);
        control_[UMFPACK_IRSTEP] = steps;
    }

    SparseIndex failing_equation() const override { return failing_; }

private:
    /// Unknown of the smallest pivot.
    [[nodiscard]] SparseIndex smallest_pivot(SparseIndex size) const {
        std::vector<SparseIndex> unknown(static_cast<std::size_t>(size)), equation(unknown.size());
        std::vector<double> pivot(unknown.size());
        umfpack_dl_get_numeric(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, unknown.data(), equation.data(),
                               pivot.data(), nullptr, nullptr, numeric_);
        const auto smallest =
            std::ranges::min_element(pivot, {}, [](double p) { return std::isfinite(p) ? std::abs(p) : 0; });
        return unknown[static_cast<std::size_t>(smallest - pivot.begin())];
    }

    std::array<double, UMFPACK_CONTROL> control_{};
    std::array<double, UMFPACK_INFO> info_{};
    void* symbolic_ = nullptr;
    void* numeric_ = nullptr;
    const SparseMatrix* matrix_ = nullptr;
    std::uint64_t pattern_ = 0;
    SparseIndex failing_ = -1;
};

} // namespace

std::unique_ptr<DirectSolver> make_lu() {
    return std::make_unique<Lu>();
}

} // namespace osculate::solve
