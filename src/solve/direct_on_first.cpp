#include "osculate/solve/direct_on_first.hpp"

#include "osculate/core/ranks.hpp"

#include <algorithm>
#include <array>

namespace osculate::solve {

namespace {
class DirectOnFirst final : public DirectSolver {
public:
    DirectOnFirst(std::unique_ptr<DirectSolver> solver, Ranks& ranks)
        : solver_(ranks.rank() == 0 ? std::move(solver) : nullptr), ranks_(ranks) {}

    FactorStatus factorise(const SparseMatrix& A) override {
        rows_ = A.rows();
        std::array<double, 2> found{}; // status and equation: small whole numbers
        if (solver_) {
            found[0] = static_cast<double>(solver_->factorise(A));
            found[1] = static_cast<double>(solver_->failing_equation());
        }
        tell(found);
        failing_equation_ = static_cast<SparseIndex>(found[1]);
        return static_cast<FactorStatus>(static_cast<int>(found[0]));
    }

    void solve(const double* b, double* x) override {
        if (solver_) solver_->solve(b, x);
        tell({x, static_cast<std::size_t>(rows_)});
    }

    [[nodiscard]] SparseIndex failing_equation() const override { return failing_equation_; }

private:
    /// Gives all processes the values of the first.
    void tell(std::span<double> values) {
        std::vector<int> sizes(static_cast<std::size_t>(ranks_.count()), 0);
        sizes[0] = static_cast<int>(values.size());
        std::vector<double> all(values.size());
        ranks_.gather(solver_ ? values : values.first(0), sizes, all.data());
        std::ranges::copy(all, values.begin());
    }

    std::unique_ptr<DirectSolver> solver_; ///< null: not on this process
    Ranks& ranks_;
    Index rows_ = 0;
    SparseIndex failing_equation_ = -1;
};
} // namespace

std::unique_ptr<DirectSolver> make_direct_on_first(std::unique_ptr<DirectSolver> solver, Ranks& ranks) {
    return std::make_unique<DirectOnFirst>(std::move(solver), ranks);
}

} // namespace osculate::solve
