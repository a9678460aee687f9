/// solve::Multigrid by PETSc: a module of its own, as PETSc and MPI take a third of a second to load.

#include "multigrid/single_blocks.hpp"
#include "osculate/core/error.hpp"
#include "osculate/solve/multigrid.hpp"

#include <Eigen/QR>
#include <cstdlib>
#include <optional>
#include <petscksp.h>

namespace osculate::solve {
namespace {

void check(PetscErrorCode code) {
    if (code == 0) return;
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw RunFailure(std::string("PETSc: ") + (text != nullptr ? text : "unknown error"));
}

void begin_petsc() {
    static const bool begun = [] {
        setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);                 // one process: no daemon beside it
        for (const char* option : {"-no_signal_handler", "-skip_petscrc"}) // no file of the user's changes a result
            check(PetscOptionsSetValue(nullptr, option, nullptr));
        check(PetscInitializeNoArguments());
        check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr)); // codes are checked, and tell enough
        return true;
    }();
    (void)begun;
}

constexpr PetscInt sweeps = 2; // of a smoother, before and after

class Gamg final : public Multigrid {
public:
    explicit Gamg(NodalUnknowns unknowns) : unknowns_(std::move(unknowns)) { begin_petsc(); }
    ~Gamg() override { clear(); }
    Gamg(const Gamg&) = delete;
    Gamg& operator=(const Gamg&) = delete;

    FactorStatus factorise(const SparseMatrix& A, const std::function<std::vector<double>()>& apart) override {
        const bool coupling = find_coupling(A, apart);
        if (A.pattern != pattern_) coarsen();
        pattern_ = A.pattern;
        fill(A, A.value);
        changed(matrix_);
        blocks_->set(row_start_, column_, value_);
        changed(smoothed_);
        for (std::size_t level = interpolation_.size(); level-- > 0;) {
            if (level + 1 == coarse_.size() && coupling)
                add_coupling(level);
            else
                check(MatPtAP(level + 1 < coarse_.size() ? coarse_[level + 1] : matrix_, interpolation_[level],
                              MAT_REUSE_MATRIX, PETSC_DEFAULT, &coarse_[level]));
            mend(coarse_[level]);
            KSP smoother = nullptr;
            check(PCMGGetSmoother(cycle_, static_cast<PetscInt>(level), &smoother));
            check(KSPSetOperators(smoother, coarse_[level], coarse_[level]));
        }
        check(PCSetOperators(cycle_, smoothed_, matrix_));
        const PetscErrorCode code = PCSetUp(cycle_);
        if (code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_MAT_CH_ZRPVT) return FactorStatus::singular;
        check(code);
        return FactorStatus::ok;
    }

    void cycle(const double* b, double* x) override {
        double *from = nullptr, *to = nullptr;
        check(VecGetArrayWrite(b_, &from));
        for (std::size_t i = 0; i < unknowns_.equation.size(); ++i)
            from[i] = unknowns_.equation[i] < 0 ? 0 : b[unknowns_.equation[i]];
        check(VecRestoreArrayWrite(b_, &from));
        check(PCApply(cycle_, b_, x_));
        check(VecGetArray(x_, &to));
        for (std::size_t i = 0; i < unknowns_.equation.size(); ++i)
            if (unknowns_.equation[i] >= 0) x[unknowns_.equation[i]] = to[i];
        check(VecRestoreArray(x_, &to));
    }

private:
    static PetscErrorCode multiply(Mat matrix, Vec from, Vec to) {
        SingleBlocks* blocks = nullptr;
        const double* x = nullptr;
        double* y = nullptr;
        check(MatShellGetContext(matrix, &blocks));
        check(VecGetArrayRead(from, &x));
        check(VecGetArrayWrite(to, &y));
        blocks->multiply(x, y);
        check(VecRestoreArrayWrite(to, &y));
        check(VecRestoreArrayRead(from, &x));
        return 0;
    }

    static void changed(Mat matrix) {
        check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
        check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    }

    /// A node that makes up an aggregate of its own has fewer components than there are rigid motions: the rest of its
    /// coarse unknowns are empty, and get a diagonal for smoothers to divide by.
    static void mend(Mat coarse) {
        constexpr double empty = 1e-14;
        Vec diagonal = nullptr;
        check(MatCreateVecs(coarse, &diagonal, nullptr));
        check(MatGetDiagonal(coarse, diagonal));
        PetscReal largest = 0;
        check(VecMax(diagonal, nullptr, &largest));
        PetscInt n = 0;
        const double* d = nullptr;
        check(VecGetSize(diagonal, &n));
        check(VecGetArrayRead(diagonal, &d));
        for (PetscInt i = 0; i < n; ++i)
            if (d[i] <= empty * largest) check(MatSetValue(coarse, i, i, largest, ADD_VALUES));
        check(VecRestoreArrayRead(diagonal, &d));
        check(VecDestroy(&diagonal));
        changed(coarse);
    }

    /// Where A differs from the matrix of uncoupled bodies, and, if its pattern is new, that matrix in matrix_.
    /// @returns  whether this is at few rows, so that the coarse matrix of uncoupled bodies wants little added
    bool find_coupling(const SparseMatrix& A, const std::function<std::vector<double>()>& apart) {
        if (A.pattern != pattern_) clear();
        const std::vector<double> uncoupled = apart();
        const std::vector<PetscInt> component = components(A);
        coupling_ = {};
        SparseIndex rows = 0;
        for (const SparseIndex e : unknowns_.equation) {
            for (SparseIndex k = e < 0 ? 0 : A.row_start[e]; k < (e < 0 ? 0 : A.row_start[e + 1]); ++k)
                if (A.value[k] != uncoupled[k]) {
                    coupling_.column.push_back(component[A.column[k]]);
                    coupling_.value.push_back(A.value[k] - uncoupled[k]);
                }
            const auto end = static_cast<PetscInt>(coupling_.column.size());
            rows += coupling_.row_start.back() < end ? 1 : 0;
            coupling_.row_start.push_back(end);
        }
        constexpr SparseIndex few = 4; // of as many rows one: above, a product of all is as quick
        if (A.pattern != pattern_) {
            lay_out(A, component);
            fill(A, uncoupled);
            create();
        }
        return few * rows <= A.rows();
    }

    /// The coarse matrix of uncoupled bodies, and the coupling's, on the level below the finest.
    void add_coupling(std::size_t level) {
        check(MatCopy(uncoupled_, coarse_[level], SAME_NONZERO_PATTERN));
        if (coupling_.column.empty()) return;
        const auto n = static_cast<PetscInt>(unknowns_.equation.size());
        Mat fine = nullptr, coarse = nullptr;
        check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, coupling_.row_start.data(), coupling_.column.data(),
                                        coupling_.value.data(), &fine));
        check(MatPtAP(fine, interpolation_[level], MAT_INITIAL_MATRIX, PETSC_DEFAULT, &coarse));
        check(MatAXPY(coarse_[level], 1, coarse, SUBSET_NONZERO_PATTERN));
        check(MatDestroy(&coarse));
        check(MatDestroy(&fine));
    }

    [[nodiscard]] std::vector<PetscInt> components(const SparseMatrix& A) const {
        std::vector<PetscInt> component(static_cast<std::size_t>(A.rows()));
        for (std::size_t i = 0; i < unknowns_.equation.size(); ++i)
            if (unknowns_.equation[i] >= 0)
                component[static_cast<std::size_t>(unknowns_.equation[i])] = static_cast<PetscInt>(i);
        return component;
    }

    /// Three rows a node, those of held components with a diagonal entry alone.
    void lay_out(const SparseMatrix& A, const std::vector<PetscInt>& component) {
        const std::size_t n = unknowns_.equation.size();
        row_start_.assign(1, 0);
        column_.clear();
        for (std::size_t i = 0; i < n; ++i) {
            if (const SparseIndex e = unknowns_.equation[i]; e >= 0)
                for (SparseIndex k = A.row_start[e]; k < A.row_start[e + 1]; ++k)
                    column_.push_back(component[A.column[k]]);
            else
                column_.push_back(static_cast<PetscInt>(i));
            row_start_.push_back(static_cast<PetscInt>(column_.size()));
        }
        value_.assign(column_.size(), 0.0);
    }

    void fill(const SparseMatrix& A, const std::vector<double>& values) {
        double largest = 0;
        for (const double v : values) largest = std::max(largest, v);
        for (std::size_t i = 0; i < unknowns_.equation.size(); ++i) {
            double* to = value_.data() + row_start_[i];
            if (const SparseIndex e = unknowns_.equation[i]; e >= 0)
                std::copy(values.data() + A.row_start[e], values.data() + A.row_start[e + 1], to);
            else
                *to = largest;
        }
    }

    void create() {
        const auto n = static_cast<PetscInt>(unknowns_.equation.size());
        check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, row_start_.data(), column_.data(), value_.data(),
                                        &matrix_));
        check(MatSetBlockSize(matrix_, 3));
        check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
        check(MatCreateVecs(matrix_, &x_, &b_));
        blocks_.emplace(row_start_, column_);
        check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &*blocks_, &smoothed_));
        check(MatShellSetOperation(smoothed_, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
        check(MatSetOption(smoothed_, MAT_SPD, PETSC_TRUE));
        check(VecSetBlockSize(b_, 3));
        // an orthonormal basis
        const Eigen::HouseholderQR<Matrix> qr(unknowns_.near_kernel);
        const Matrix Q = qr.householderQ() * Matrix::Identity(n, unknowns_.near_kernel.cols());
        std::vector<Vec> basis;
        for (Index c = 0; c < Q.cols(); ++c) {
            Vec& v = basis.emplace_back();
            check(VecDuplicate(b_, &v));
            double* to = nullptr;
            check(VecGetArrayWrite(v, &to));
            std::copy(Q.col(c).data(), Q.col(c).data() + n, to);
            check(VecRestoreArrayWrite(v, &to));
        }
        MatNullSpace space = nullptr;
        check(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, static_cast<PetscInt>(basis.size()), basis.data(),
                                 &space));
        check(MatSetNearNullSpace(matrix_, space));
        check(MatNullSpaceDestroy(&space));
        for (Vec& v : basis) check(VecDestroy(&v));
    }

    /// Aggregates and interpolations, and cycles over them.
    void coarsen() {
        PC grids = nullptr;
        check(PCCreate(PETSC_COMM_SELF, &grids));
        check(PCSetOperators(grids, matrix_, matrix_));
        check(PCSetType(grids, PCGAMG));
        check(PCSetOptionsPrefix(grids, "osculate_grids_"));
        for (const char* level : {"levels", "coarse"}) { // nothing is solved on these
            const std::string name = std::string("-osculate_grids_mg_") + level;
            check(PetscOptionsSetValue(nullptr, (name + "_ksp_type").c_str(), "preonly"));
            check(PetscOptionsSetValue(nullptr, (name + "_pc_type").c_str(), "none"));
        }
        check(PCSetFromOptions(grids));
        check(PCSetUp(grids));
        PetscInt levels = 0;
        check(PCMGGetLevels(grids, &levels));
        check(PCCreate(PETSC_COMM_SELF, &cycle_));
        check(PCSetType(cycle_, PCMG));
        check(PCMGSetLevels(cycle_, levels, nullptr));
        check(PCMGSetGalerkin(cycle_, PC_MG_GALERKIN_NONE));
        interpolation_.resize(static_cast<std::size_t>(levels - 1));
        coarse_.assign(interpolation_.size(), nullptr);
        for (PetscInt level = 0; level < levels; ++level) {
            KSP smoother = nullptr;
            check(PCMGGetSmoother(cycle_, level, &smoother));
            PC pc = nullptr;
            check(KSPGetPC(smoother, &pc));
            if (level == 0) {
                check(KSPSetType(smoother, KSPPREONLY));
                check(PCSetType(pc, PCLU));
                check(PCFactorSetShiftType(pc, MAT_SHIFT_INBLOCKS));
            } else {
                check(KSPSetType(smoother, KSPCHEBYSHEV));
                check(KSPSetTolerances(smoother, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, sweeps));
                check(PCSetType(pc, PCPBJACOBI));
                if (level == levels - 1) check(KSPSetOperators(smoother, smoothed_, matrix_));
            }
            if (level == 0) continue;
            Mat& P = interpolation_[static_cast<std::size_t>(level - 1)];
            check(PCMGGetInterpolation(grids, level, &P));
            check(PetscObjectReference(reinterpret_cast<PetscObject>(P)));
            KSP below = nullptr;
            check(PCMGGetSmoother(grids, level - 1, &below));
            Mat& product =
                coarse_[static_cast<std::size_t>(level - 1)]; // P^T A P, of which factorise() needs new values
            check(KSPGetOperators(below, &product, nullptr));
            check(PetscObjectReference(reinterpret_cast<PetscObject>(product)));
            check(PCMGSetInterpolation(cycle_, level, P));
        }
        if (!coarse_.empty()) check(MatDuplicate(coarse_.back(), MAT_COPY_VALUES, &uncoupled_));
        check(PCDestroy(&grids));
    }

    void clear() {
        pattern_ = 0;
        row_start_ = column_ = {};
        value_ = {};
        blocks_.reset();
        PCDestroy(&cycle_);
        for (Mat& P : interpolation_) MatDestroy(&P);
        for (Mat& A : coarse_) MatDestroy(&A);
        VecDestroy(&b_);
        VecDestroy(&x_);
        MatDestroy(&uncoupled_);
        MatDestroy(&smoothed_);
        MatDestroy(&matrix_);
    }

    NodalUnknowns unknowns_;
    std::vector<PetscInt> row_start_, column_;
    std::vector<double> value_; ///< PETSc works on these three in place
    std::uint64_t pattern_ = 0;
    Mat matrix_ = nullptr, smoothed_ = nullptr; ///< smoothed_: products of matrix_ by blocks_
    std::optional<SingleBlocks> blocks_;
    struct {
        std::vector<PetscInt> row_start{0}, column;
        std::vector<double> value;
    } coupling_;                              ///< what A has beside the matrix of uncoupled bodies
    Mat uncoupled_ = nullptr;                 ///< of uncoupled bodies, on the level below the finest
    std::vector<Mat> interpolation_, coarse_; ///< from level i to i + 1, and at level i, 0 the coarsest
    PC cycle_ = nullptr;
    Vec b_ = nullptr, x_ = nullptr;
};

} // namespace
} // namespace osculate::solve

extern "C" osculate::solve::Multigrid* osculate_make_multigrid(osculate::solve::NodalUnknowns* unknowns) {
    return new osculate::solve::Gamg(std::move(*unknowns));
}
