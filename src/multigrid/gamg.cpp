/// solve::Multigrid by PETSc: a module of its own, as PETSc and MPI take a third of a second to load.

#include "multigrid/coarse_matrix.hpp"
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
constexpr double lower = 0.3,
                 upper = 1.1; // what it damps, over the largest eigenvalue: 0.1 costs a fifth more iterations

/// Calls act(x, y) with the values of two vectors. PETSc, which is C, calls these: errors go back as codes.
PetscErrorCode with_values(Vec from, Vec to, auto&& act) noexcept {
    const double* x = nullptr;
    double* y = nullptr;
    PetscErrorCode code = VecGetArrayRead(from, &x);
    if (code == 0) code = VecGetArrayWrite(to, &y);
    if (code != 0) return code;
    act(x, y);
    code = VecRestoreArrayWrite(to, &y);
    return code != 0 ? code : VecRestoreArrayRead(from, &x);
}

/// The finest grid and the next are ours, in blocks of nodes; PETSc's GAMG goes on from there, and cycles over all.
class Gamg final : public Multigrid {
public:
    explicit Gamg(NodalUnknowns unknowns) : unknowns_(std::move(unknowns)), nodes_(unknowns_) { begin_petsc(); }
    ~Gamg() override { clear(); }
    Gamg(const Gamg&) = delete;
    Gamg& operator=(const Gamg&) = delete;

    void coarsen(const NodalMatrix& undeformed) override {
        clear();
        fine_.emplace(nodes_, undeformed);
        P_.emplace(nodes_, undeformed, *fine_, unknowns_.near_kernel);
        coarse_.emplace(nodes_, *P_, undeformed);
        coarse_->couple({});
        wrap_coarse();
        choose_grids();
        wrap_fine();
        make_cycle();
    }

    void take(const NodalMatrix& bodies) override {
        fine_->take(bodies);
        coarse_->take(bodies);
    }

    FactorStatus couple(std::span<const NodalBlock> coupling) override {
        fine_->couple(coupling);
        changed(smoothed_);
        const bool grown = coarse_->couple(coupling);
        if (grown) {
            wrap_coarse();
            make_cycle(); // that of another pattern keeps some of it
        }
        if (coarse_->loose()) return FactorStatus::singular;
        const double largest = fine_->largest_eigenvalue();
        check(KSPChebyshevSetEigenvalues(smoother_, upper * largest, lower * largest));
        changed(below_.back());
        for (std::size_t level = below_.size(); level-- > 0;) {
            Mat& A = below_[level];
            if (level + 1 < below_.size()) {
                if (grown) MatDestroy(&A);
                check(MatPtAP(below_[level + 1], interpolation_[level],
                              A == nullptr ? MAT_INITIAL_MATRIX : MAT_REUSE_MATRIX, PETSC_DEFAULT, &A));
                mend(A);
            }
            KSP smoother = nullptr;
            check(PCMGGetSmoother(cycle_, static_cast<PetscInt>(level), &smoother));
            check(KSPSetOperators(smoother, A, A));
        }
        check(PCSetOperators(cycle_, smoothed_, smoothed_));
        const PetscErrorCode code = PCSetUp(cycle_);
        if (code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_MAT_CH_ZRPVT) return FactorStatus::singular;
        check(code);
        return FactorStatus::ok;
    }

    void cycle(const double* b, double* x) override {
        double* from = nullptr;
        const double* to = nullptr;
        check(VecGetArrayWrite(b_, &from));
        for (std::size_t i = 0; i < unknowns_.node.size(); ++i) {
            Vec3 local = Vec3::Zero();
            for (std::size_t k = 0; k < 3; ++k)
                if (const SparseIndex e = unknowns_.equation[3 * i + k]; e >= 0) local(static_cast<Index>(k)) = b[e];
            Eigen::Map<Vec3>(from + 3 * i) = unknowns_.frame[i] * local;
        }
        check(VecRestoreArrayWrite(b_, &from));
        check(PCApply(cycle_, b_, x_));
        check(VecGetArrayRead(x_, &to));
        for (std::size_t i = 0; i < unknowns_.node.size(); ++i) {
            const Vec3 local = unknowns_.frame[i].transpose() * Eigen::Map<const Vec3>(to + 3 * i);
            for (std::size_t k = 0; k < 3; ++k)
                if (const SparseIndex e = unknowns_.equation[3 * i + k]; e >= 0) x[e] = local(static_cast<Index>(k));
        }
        check(VecRestoreArrayRead(x_, &to));
    }

private:
    /// A shell's product, by a member of the object that it wraps.
    template <class Wrapped, void (Wrapped::*act)(const double*, double*) const>
    static PetscErrorCode product(Mat matrix, Vec from, Vec to) noexcept {
        Wrapped* wrapped = nullptr;
        const PetscErrorCode code = MatShellGetContext(matrix, &wrapped);
        return code != 0 ? code : with_values(from, to, [&](const double* x, double* y) { (wrapped->*act)(x, y); });
    }
    static PetscErrorCode scale(PC scaling, Vec from, Vec to) noexcept {
        FineGrid* grid = nullptr;
        const PetscErrorCode code = PCShellGetContext(scaling, &grid);
        return code != 0 ? code : with_values(from, to, [&](const double* x, double* y) { grid->scale(x, y); });
    }
    static void changed(Mat matrix) {
        check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
        check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    }

    /// An aggregate with fewer nodes than its motions need has empty unknowns: they get a diagonal for smoothers to divide by.
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

    /// The matrix below the finest grid in the arrays of coarse_.
    void wrap_coarse() {
        if (below_.empty()) below_.push_back(nullptr);
        check(MatDestroy(&below_.back()));
        check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, coarse_->rows(), coarse_->rows(), coarse_->row_start(),
                                        coarse_->column(), coarse_->value(), &below_.back()));
        check(MatSetBlockSize(below_.back(), Prolongation::modes));
        check(MatSetOption(below_.back(), MAT_SPD, PETSC_TRUE));
    }

    /// Aggregates and interpolations of GAMG below ours.
    void choose_grids() {
        const Mat A = below_.back();
        Vec like = nullptr;
        check(MatCreateVecs(A, &like, nullptr));
        check(VecSetBlockSize(like, Prolongation::modes));
        // an orthonormal basis
        const Matrix& motions = P_->near_kernel();
        const Eigen::HouseholderQR<Matrix> qr(motions);
        const Matrix Q = qr.householderQ() * Matrix::Identity(motions.rows(), motions.cols());
        std::vector<Vec> basis;
        for (Index c = 0; c < Q.cols(); ++c) {
            Vec& v = basis.emplace_back();
            check(VecDuplicate(like, &v));
            double* to = nullptr;
            check(VecGetArrayWrite(v, &to));
            std::copy(Q.col(c).data(), Q.col(c).data() + Q.rows(), to);
            check(VecRestoreArrayWrite(v, &to));
        }
        check(VecDestroy(&like));
        MatNullSpace space = nullptr;
        check(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, static_cast<PetscInt>(basis.size()), basis.data(),
                                 &space));
        check(MatSetNearNullSpace(A, space));
        check(MatNullSpaceDestroy(&space));
        for (Vec& v : basis) check(VecDestroy(&v));

        PC grids = nullptr;
        check(PCCreate(PETSC_COMM_SELF, &grids));
        check(PCSetOperators(grids, A, A));
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
        for (PetscInt level = 1; level < levels; ++level) {
            Mat& P = interpolation_.emplace_back();
            check(PCMGGetInterpolation(grids, level, &P));
            check(PetscObjectReference(reinterpret_cast<PetscObject>(P)));
        }
        check(PCDestroy(&grids));
        below_.insert(below_.begin(), interpolation_.size(), nullptr);
    }

    /// The finest grid and the interpolation to it in shells.
    void wrap_fine() {
        const PetscInt n = 3 * nodes_.size(), coarse = coarse_->rows();
        check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &*fine_, &smoothed_));
        check(MatShellSetOperation(smoothed_, MATOP_MULT,
                                   reinterpret_cast<void (*)()>(product<FineGrid, &FineGrid::multiply>)));
        check(MatSetOption(smoothed_, MAT_SPD, PETSC_TRUE));
        check(MatCreateVecs(smoothed_, &x_, &b_));
        check(MatCreateShell(PETSC_COMM_SELF, n, coarse, n, coarse, &*P_, &to_fine_));
        check(MatShellSetOperation(to_fine_, MATOP_MULT,
                                   reinterpret_cast<void (*)()>(product<Prolongation, &Prolongation::to_fine>)));
        check(MatShellSetOperation(to_fine_, MATOP_MULT_TRANSPOSE,
                                   reinterpret_cast<void (*)()>(product<Prolongation, &Prolongation::to_coarse>)));
    }

    void make_cycle() {
        PCDestroy(&cycle_);
        const auto levels = static_cast<PetscInt>(below_.size()) + 1;
        check(PCCreate(PETSC_COMM_SELF, &cycle_));
        check(PCSetType(cycle_, PCMG));
        check(PCMGSetLevels(cycle_, levels, nullptr));
        check(PCMGSetGalerkin(cycle_, PC_MG_GALERKIN_NONE));
        for (PetscInt level = 0; level < levels; ++level) {
            KSP smoother = nullptr;
            check(PCMGGetSmoother(cycle_, level, &smoother));
            PC pc = nullptr;
            check(KSPGetPC(smoother, &pc));
            if (level == 0) {
                check(KSPSetType(smoother, KSPPREONLY));
                check(PCSetType(pc, PCLU));
                check(PCFactorSetShiftType(pc, MAT_SHIFT_INBLOCKS));
                continue;
            }
            check(KSPSetType(smoother, KSPCHEBYSHEV));
            check(KSPSetTolerances(smoother, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, sweeps));
            const bool finest = level == levels - 1;
            check(PCMGSetInterpolation(cycle_, level,
                                       finest ? to_fine_ : interpolation_[static_cast<std::size_t>(level - 1)]));
            check(PCSetType(pc, finest ? PCSHELL : PCPBJACOBI));
            if (!finest) continue;
            smoother_ = smoother;
            check(PCShellSetContext(pc, &*fine_));
            check(PCShellSetApply(pc, scale));
            check(KSPSetOperators(smoother, smoothed_, smoothed_));
        }
    }

    void clear() {
        PCDestroy(&cycle_);
        for (Mat& P : interpolation_) MatDestroy(&P);
        for (Mat& A : below_) MatDestroy(&A);
        interpolation_.clear();
        below_.clear();
        VecDestroy(&b_);
        VecDestroy(&x_);
        MatDestroy(&to_fine_);
        MatDestroy(&smoothed_);
        coarse_.reset();
        P_.reset();
        fine_.reset();
    }

    NodalUnknowns unknowns_;
    FreeNodes nodes_;
    std::optional<FineGrid> fine_;
    std::optional<Prolongation> P_;
    std::optional<CoarseMatrix> coarse_;
    Mat smoothed_ = nullptr, to_fine_ = nullptr; ///< of fine_ and P_
    std::vector<Mat> below_;         ///< by level, 0 the coarsest, without the finest grid; last that of coarse_
    std::vector<Mat> interpolation_; ///< from level i to i + 1 of these
    PC cycle_ = nullptr;
    KSP smoother_ = nullptr; ///< of the finest grid, cycle_ owns it
    Vec b_ = nullptr, x_ = nullptr;
};

} // namespace
} // namespace osculate::solve

extern "C" osculate::solve::Multigrid* osculate_make_multigrid(osculate::solve::NodalUnknowns* unknowns) {
    return new osculate::solve::Gamg(std::move(*unknowns));
}
