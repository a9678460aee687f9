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

/// The finest grid and the next are ours, in blocks of nodes; PETSc's GAMG goes on from there.
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
        make_cycle();
        for (Vector* v : {&b_, &x_, &other_}) v->resize(3 * nodes_.size());
    }

    void take(const NodalMatrix& bodies) override {
        fine_->take(bodies);
        coarse_->take(bodies);
    }

    FactorStatus couple(std::span<const NodalBlock> blocks) override {
        Coupling coupling(nodes_, blocks);
        const bool grown = coarse_->couple(coupling);
        fine_->couple(std::move(coupling));
        if (grown) {
            wrap_coarse();
            make_cycle(); // that of another pattern keeps some of it
        }
        if (coarse_->loose()) return FactorStatus::singular;
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
        check(PCSetOperators(cycle_, below_.back(), below_.back()));
        const PetscErrorCode code = PCSetUp(cycle_);
        if (code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_MAT_CH_ZRPVT) return FactorStatus::singular;
        check(code);
        return FactorStatus::ok;
    }

    /// Chebyshev's polynomial of the second degree before and after the coarser grids (Saad, Iterative Methods, algorithm 12.1).
    void cycle(const double* b, double* x) override {
        const double largest = fine_->largest_eigenvalue(), centre = (upper + lower) / 2 * largest,
                     half = (upper - lower) / 2 * largest, rho = 1 / (2 * centre / half - half / centre);
        const double first = 1 / centre, momentum = rho * half / centre, second = 2 * rho / half;
        for (std::size_t i = 0; i < unknowns_.node.size(); ++i) {
            Vec3 local = Vec3::Zero();
            for (std::size_t k = 0; k < 3; ++k)
                if (const SparseIndex e = unknowns_.equation[3 * i + k]; e >= 0) local(static_cast<Index>(k)) = b[e];
            b_.segment<3>(3 * static_cast<Index>(i)) = unknowns_.frame[i] * local;
        }
        fine_->first_sweep(b_.data(), first, x_.data());
        fine_->sweep(b_.data(), x_.data(), nullptr, momentum, second, other_.data());
        fine_->residual(b_.data(), other_.data(), x_.data());
        correct(x_, other_);
        fine_->sweep(b_.data(), other_.data(), other_.data(), 0, first, x_.data());
        fine_->sweep(b_.data(), x_.data(), other_.data(), momentum, second, other_.data());
        for (std::size_t i = 0; i < unknowns_.node.size(); ++i) {
            const Vec3 local = unknowns_.frame[i].transpose() * other_.segment<3>(3 * static_cast<Index>(i));
            for (std::size_t k = 0; k < 3; ++k)
                if (const SparseIndex e = unknowns_.equation[3 * i + k]; e >= 0) x[e] = local(static_cast<Index>(k));
        }
    }

private:
    /// x += P of the coarser grids' answer to a residual.
    void correct(const Vector& residual, Vector& x) {
        double* to = nullptr;
        check(VecGetArrayWrite(coarse_residual_, &to));
        P_->to_coarse(residual.data(), to);
        check(VecRestoreArrayWrite(coarse_residual_, &to));
        check(PCApply(cycle_, coarse_residual_, correction_));
        const double* from = nullptr;
        check(VecGetArrayRead(correction_, &from));
        P_->add_to_fine(from, x.data());
        check(VecRestoreArrayRead(correction_, &from));
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
        check(VecDuplicate(like, &coarse_residual_));
        check(VecDuplicate(like, &correction_));
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

    /// Of all grids but the finest.
    void make_cycle() {
        PCDestroy(&cycle_);
        const auto levels = static_cast<PetscInt>(below_.size());
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
            check(PCMGSetInterpolation(cycle_, level, interpolation_[static_cast<std::size_t>(level - 1)]));
            check(PCSetType(pc, PCPBJACOBI));
        }
    }

    void clear() {
        PCDestroy(&cycle_);
        for (Mat& P : interpolation_) MatDestroy(&P);
        for (Mat& A : below_) MatDestroy(&A);
        interpolation_.clear();
        below_.clear();
        VecDestroy(&coarse_residual_);
        VecDestroy(&correction_);
        coarse_.reset();
        P_.reset();
        fine_.reset();
    }

    NodalUnknowns unknowns_;
    FreeNodes nodes_;
    std::optional<FineGrid> fine_;
    std::optional<Prolongation> P_;
    std::optional<CoarseMatrix> coarse_;
    std::vector<Mat> below_;         ///< by level, 0 the coarsest, without the finest grid; last that of coarse_
    std::vector<Mat> interpolation_; ///< from level i to i + 1 of these
    PC cycle_ = nullptr;
    Vec coarse_residual_ = nullptr, correction_ = nullptr;
    Vector b_, x_, other_; ///< (3 n)
};

} // namespace
} // namespace osculate::solve

extern "C" osculate::solve::Multigrid* osculate_make_multigrid(osculate::solve::NodalUnknowns* unknowns) {
    return new osculate::solve::Gamg(std::move(*unknowns));
}
