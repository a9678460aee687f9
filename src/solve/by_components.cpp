#include "osculate/solve/by_components.hpp"

#include "osculate/core/error.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace osculate::solve {
namespace {

/// Factorises each connected component of the matrix by itself: a right side costs solves in those that it loads.
class ByComponents final : public DirectSolver {
public:
    explicit ByComponents(std::function<std::unique_ptr<DirectSolver>()> make) : make_(std::move(make)) {}

    FactorStatus factorise(const SparseMatrix& A) override {
        if (parts_.empty() || A.pattern != pattern_) split(A);
        failing_ = -1;
        for (Part& part : parts_) {
            const auto rows = static_cast<SparseIndex>(part.equation.size());
            for (SparseIndex i = 0; i < rows; ++i)
                std::copy(A.value.begin() + A.row_start[part.equation[i]],
                          A.value.begin() + A.row_start[part.equation[i] + 1],
                          part.matrix.value.begin() + part.matrix.row_start[i]);
            ++part.matrix.revision;
            const FactorStatus status = part.solver->factorise(part.matrix);
            if (status == FactorStatus::ok) continue;
            const SparseIndex failing = part.solver->failing_equation();
            failing_ = failing < 0 ? -1 : part.equation[failing];
            return status;
        }
        return FactorStatus::ok;
    }

    void solve(const double* b, double* x) override {
        for (Part& part : parts_) {
            const auto rows = static_cast<Index>(part.equation.size());
            Vector right(rows), solved(rows);
            for (Index i = 0; i < rows; ++i) right(i) = b[part.equation[i]];
            part.solver->solve(right.data(), solved.data());
            for (Index i = 0; i < rows; ++i) x[part.equation[i]] = solved(i);
        }
    }

    void solve(const Matrix& B, Matrix& X) override {
        X.setZero(B.rows(), B.cols());
        Matrix right, solved;
        std::vector<Index> loaded;
        for (Part& part : parts_) {
            const auto rows = static_cast<Index>(part.equation.size());
            loaded.clear();
            for (Index c = 0; c < B.cols(); ++c)
                if (std::ranges::any_of(part.equation, [&](SparseIndex e) { return B(e, c) != 0; }))
                    loaded.push_back(c);
            if (loaded.empty()) continue;
            right.resize(rows, static_cast<Index>(loaded.size()));
            for (Index c = 0; c < right.cols(); ++c)
                for (Index i = 0; i < rows; ++i) right(i, c) = B(part.equation[i], loaded[static_cast<std::size_t>(c)]);
            part.solver->solve(right, solved);
            for (Index c = 0; c < right.cols(); ++c)
                for (Index i = 0; i < rows; ++i)
                    X(part.equation[i], loaded[static_cast<std::size_t>(c)]) = solved(i, c);
        }
    }

    [[nodiscard]] SparseIndex failing_equation() const override { return failing_; }

private:
    struct Part {
        std::vector<SparseIndex> equation; ///< of the whole matrix, ascending
        SparseMatrix matrix;
        std::unique_ptr<DirectSolver> solver;
    };

    void split(const SparseMatrix& A) {
        std::vector<SparseIndex> root(static_cast<std::size_t>(A.rows()));
        std::iota(root.begin(), root.end(), 0);
        const auto find = [&root](SparseIndex e) {
            while (root[e] != e) e = root[e] = root[root[e]];
            return e;
        };
        for (SparseIndex e = 0; e < A.rows(); ++e)
            for (SparseIndex k = A.row_start[e]; k < A.row_start[e + 1]; ++k) {
                const SparseIndex a = find(e), b = find(A.column[k]);
                root[std::max(a, b)] = std::min(a, b); // roots are the first of their component
            }
        parts_.clear();
        std::vector<SparseIndex> part(root.size()), place(root.size());
        for (SparseIndex e = 0; e < A.rows(); ++e) {
            const SparseIndex first = find(e);
            if (first == e) {
                part[e] = static_cast<SparseIndex>(parts_.size());
                parts_.emplace_back();
            }
            part[e] = part[first];
            std::vector<SparseIndex>& equation = parts_[static_cast<std::size_t>(part[e])].equation;
            place[e] = static_cast<SparseIndex>(equation.size());
            equation.push_back(e);
        }
        for (Part& one : parts_) {
            SparseMatrix& matrix = one.matrix;
            for (const SparseIndex e : one.equation) {
                for (SparseIndex k = A.row_start[e]; k < A.row_start[e + 1]; ++k)
                    matrix.column.push_back(place[A.column[k]]);
                matrix.row_start.push_back(static_cast<SparseIndex>(matrix.column.size()));
            }
            matrix.value.resize(matrix.column.size());
            matrix.symmetric_positive_definite = A.symmetric_positive_definite;
            matrix.pattern = 1;
            one.solver = make_();
        }
        pattern_ = A.pattern;
    }

    std::function<std::unique_ptr<DirectSolver>()> make_;
    std::vector<Part> parts_;
    std::uint64_t pattern_ = 0;
    SparseIndex failing_ = -1;
};

} // namespace

std::unique_ptr<DirectSolver> make_by_components(std::function<std::unique_ptr<DirectSolver>()> make) {
    return std::make_unique<ByComponents>(std::move(make));
}

} // namespace osculate::solve
