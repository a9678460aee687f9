/// solve::Multigrid by PETSc: a module of its own, as PETSc and MPI take a third of a second to load.

#include "multigrid/coarse_matrix.hpp"
#include "multigrid/hubs.hpp"
#include "multigrid/petsc_check.hpp"
#include "multigrid/third_matrix.hpp"
#include "osculate/core/parallel.hpp"
#include "osculate/solve/multigrid.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <optional>
#include <petscksp.h>
#include <span>

namespace osculate::solve {
namespace {

constexpr PetscInt sweeps = 2; // of a smoother, before and after
constexpr double lower = 0.3,
                 upper = 1.1; // what it damps, over the largest eigenvalue: 0.1 costs a fifth more iterations

/// The finest grid and the next are ours, in blocks of nodes; PETSc's GAMG goes on from there.
class Gamg final : public Multigrid {
public:
    Gamg(NodalUnknowns unknowns, int threads)
        : unknowns_(std::move(unknowns)), threads_(threads), alone_(unknowns_.owner.empty()),
          comm_(alone_ ? PETSC_COMM_SELF : PETSC_COMM_WORLD) {
        begin_petsc();
    }
    ~Gamg() override { clear(); }
    Gamg(const Gamg&) = delete;
    Gamg& operator=(const Gamg&) = delete;

    void coarsen(const NodalMatrix& undeformed) override {
        require(alone_ || !nodes_, "grids are chosen once where processes share them");
        clear();
        nothing_free_ = unknowns_.node.empty();
        const FreeNodes& nodes = nodes_.emplace(unknowns_, undeformed);
        hubs_.emplace(nodes, unknowns_).take(undeformed);
        if (nothing_free_) return;
        fine_.emplace(nodes, undeformed, threads_);
        P_.emplace(nodes, undeformed, *fine_, unknowns_, threads_);
        coarse_.emplace(nodes, *P_, undeformed, threads_);
        coarse_->couple({});
        wrap_coarse();
        check(MatSetOption(below_.back(), MAT_SPD,
                           PETSC_TRUE)); // as GAMG asks; smoothers of a tangent may not trust in it
        choose_grids();
        make_cycle();
        for (Vector* v : {&b_, &x_, &other_}) v->setZero(3 * nodes.with_copies());
        c_.setZero(Prolongation::modes * P_->with_copies());
        if (!alone_) unknowns_ = nodes.own(std::move(unknowns_));
    }

    void take(const NodalMatrix& bodies) override {
        hubs_->take(bodies);
        if (nothing_free_) return;
        fine_->take(bodies);
        coarse_->take(bodies);
    }

    [[nodiscard]] bool reads_row(Index node) const override {
        const Index row = nodes_->number(node);
        return (row >= 0 && row < nodes_->size()) || hubs_->has(node);
    }

    FactorStatus couple(std::span<const NodalBlock> blocks) override {
        if (nothing_free_) return hubs_->eliminate(blocks, {}, {});
        Coupling coupling(*nodes_, blocks);
        const bool replaced = coarse_->couple(coupling); // the pattern
        fine_->couple(std::move(coupling));
        if (replaced) {
            PCDestroy(&cycle_); // it keeps what is replaced, some of it even where it gets another pattern
            for (Mat& A : std::span(below_).first(below_.size() - 1)) MatDestroy(&A); // before any return
            third_.reset();
            wrap_coarse();
            make_cycle();
        }
        if (coarse_->loose()) return FactorStatus::singular;
        changed(below_.back());
        for (std::size_t level = below_.size(); level-- > 0;) {
            Mat& A = below_[level];
            if (level + 1 < below_.size()) {
                if (alone_)
                    project(below_[level + 1], interpolation_[level], A);
                else if (level + 2 == below_.size())
                    project_blocks(interpolation_[level], A);
                else
                    project_row_by_row(level, A);
                if (alone_ || level + 2 < below_.size()) mend(A);
            }
            KSP smoother = nullptr;
            check(PCMGGetSmoother(cycle_, static_cast<PetscInt>(level), &smoother));
            check(KSPSetOperators(smoother, A, A));
        }
        check(PCSetOperators(cycle_, below_.back(), below_.back()));
        const PetscErrorCode code = PCSetUp(cycle_);
        if (code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_MAT_CH_ZRPVT) return FactorStatus::singular;
        check(code);
        Vector zero = Vector::Zero(b_.size()), given(b_.size());
        return hubs_->eliminate(
            blocks,
            [&](const Vector& from, Vector& to) {
                given = from; // with its copies
                fine_->residual(zero.data(), given.data(), to.data());
                to = -to;
            },
            [&](const Vector& from, Vector& to) { cycle_on_nodes(from, to); });
    }

    void cycle(const double* b, double* x) override {
        if (nothing_free_) return hubs_->correct(b, x, b_, other_);
        for_own_nodes([&](Index i) {
            Vec3 local = Vec3::Zero();
            for_equations(i, [&](Index k, SparseIndex e) { local(k) = b[e]; });
            b_.segment<3>(3 * i) = unknowns_.frame(i) * local;
        });
        cycle_on_nodes(b_, other_);
        hubs_->correct(b, x, b_, other_);
        for_own_nodes([&](Index i) {
            const Vec3 local = unknowns_.frame(i).transpose() * other_.segment<3>(3 * i);
            for_equations(i, [&](Index k, SparseIndex e) { x[e] = local(k); });
        });
    }
    [[nodiscard]] Index cycles_to_couple() const override { return hubs_ ? hubs_->cycles() : 0; }

private:
    /// Chebyshev's polynomial of the second degree before and after the coarser grids (Saad, Iterative Methods, algorithm 12.1).
    void cycle_on_nodes(const Vector& b, Vector& x) {
        const double largest = fine_->largest_eigenvalue(), centre = (upper + lower) / 2 * largest,
                     half = (upper - lower) / 2 * largest, rho = 1 / (2 * centre / half - half / centre);
        const double first = 1 / centre, momentum = rho * half / centre, second = 2 * rho / half;
        fine_->first_sweep(b.data(), first, x_.data());
        fine_->sweep(b.data(), x_.data(), nullptr, momentum, second, x.data());
        fine_->residual(b.data(), x.data(), x_.data());
        correct(x_, x);
        fine_->sweep(b.data(), x.data(), x.data(), 0, first, x_.data());
        fine_->sweep(b.data(), x_.data(), x.data(), momentum, second, x.data());
    }

    void for_own_nodes(auto&& each) const {
        parallel_for(threads_, nodes_->size(), [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) each(i);
        });
    }
    /// Calls each(local component, equation) of a node.
    void for_equations(Index i, auto&& each) const {
        for (Index k = 0; k < 3; ++k)
            if (const SparseIndex e = unknowns_.equation[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(k)];
                e >= 0)
                each(k, e);
    }
    /// x += P of the coarser grids' answer to a residual.
    void correct(const Vector& residual, Vector& x) {
        const Index own = Prolongation::modes * P_->aggregates();
        P_->to_coarse(residual.data(), c_.data());
        double* to = nullptr;
        check(VecGetArrayWrite(coarse_residual_, &to));
        std::copy_n(c_.data(), own, to);
        check(VecRestoreArrayWrite(coarse_residual_, &to));
        check(PCApply(cycle_, coarse_residual_, correction_));
        const double* from = nullptr;
        check(VecGetArrayRead(correction_, &from));
        std::copy_n(from, own, c_.data());
        check(VecRestoreArrayRead(correction_, &from));
        P_->add_to_fine(c_.data(), x.data());
    }
    /// coarse = P^T A P, in the pattern that it has, if any.
    static void project(Mat A, Mat P, Mat& coarse) {
        check(MatPtAP(A, P, coarse == nullptr ? MAT_INITIAL_MATRIX : MAT_REUSE_MATRIX, PETSC_DEFAULT, &coarse));
    }
    /// P^T A P of the grid below ours, for several processes.
    void project_blocks(Mat P, Mat& coarse) {
        if (third_) {
            third_->take(coarse_->values());
            return changed(coarse);
        }
        third_.emplace(P, coarse_->rows(), coarse_->values(), threads_);
        coarse = wrap(third_->rows(), third_->values());
    }
    /// P^T A P of the grids below that. Each process computes its rows of A P and of P^T (A P) from rows that it asks for, in the
    /// same bits each time.
    void project_row_by_row(std::size_t level, Mat& coarse) {
        restriction_.resize(interpolation_.size());
        half_way_.resize(interpolation_.size());
        Mat &R = restriction_[level], &AP = half_way_[level];
        if (R == nullptr) check(MatTranspose(interpolation_[level], MAT_INITIAL_MATRIX, &R));
        if (coarse == nullptr) MatDestroy(&AP);
        const MatReuse reuse = coarse == nullptr ? MAT_INITIAL_MATRIX : MAT_REUSE_MATRIX;
        check(MatMatMult(below_[level + 1], interpolation_[level], reuse, PETSC_DEFAULT, &AP));
        check(MatMatMult(R, AP, reuse, PETSC_DEFAULT, &coarse));
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
        PetscInt first = 0, end = 0;
        const double* d = nullptr;
        check(VecGetOwnershipRange(diagonal, &first, &end));
        check(VecGetArrayRead(diagonal, &d));
        for (PetscInt i = first; i < end; ++i)
            if (d[i - first] <= empty * largest) check(MatSetValue(coarse, i, i, largest, ADD_VALUES));
        check(VecRestoreArrayRead(diagonal, &d));
        check(VecDestroy(&diagonal));
        changed(coarse);
    }

    /// A matrix in the arrays of blocks.
    [[nodiscard]] Mat wrap(BlockRows& rows, BlockRows::Values& values) const {
        const PetscInt own = BlockRows::modes * rows.own();
        Mat matrix = nullptr;
        if (alone_)
            check(MatCreateSeqAIJWithArrays(comm_, own, own, rows.row_start(0), rows.column(0), values[0].data(),
                                            &matrix));
        else
            check(MatCreateMPIAIJWithSplitArrays(comm_, own, own, PETSC_DETERMINE, PETSC_DETERMINE, rows.row_start(0),
                                                 rows.column(0), values[0].data(), rows.row_start(1), rows.column(1),
                                                 values[1].data(), &matrix));
        check(MatSetBlockSize(matrix, BlockRows::modes));
        return matrix;
    }
    void wrap_coarse() {
        if (below_.empty()) below_.push_back(nullptr);
        check(MatDestroy(&below_.back()));
        below_.back() = wrap(coarse_->rows(), coarse_->values());
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
            std::copy_n(Q.col(c).data() + Prolongation::modes * P_->first_number(),
                        Prolongation::modes * P_->aggregates(), to);
            check(VecRestoreArrayWrite(v, &to));
        }
        check(VecDuplicate(like, &coarse_residual_));
        check(VecDuplicate(like, &correction_));
        check(VecDestroy(&like));
        MatNullSpace space = nullptr;
        check(MatNullSpaceCreate(comm_, PETSC_FALSE, static_cast<PetscInt>(basis.size()), basis.data(), &space));
        check(MatSetNearNullSpace(A, space));
        check(MatNullSpaceDestroy(&space));
        for (Vec& v : basis) check(VecDestroy(&v));

        PC grids = nullptr;
        check(PCCreate(comm_, &grids));
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
        check(PCCreate(comm_, &cycle_));
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
                if (!alone_) { // every process factorises it
                    check(PCSetType(pc, PCREDUNDANT));
                    KSP own = nullptr;
                    check(KSPSetOperators(smoother, below_.front(), below_.front()));
                    check(PCRedundantGetKSP(pc, &own));
                    check(KSPGetPC(own, &pc));
                }
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
        for (std::vector<Mat>* list : {&below_, &restriction_, &half_way_})
            for (Mat& A : *list) MatDestroy(&A);
        restriction_.clear();
        half_way_.clear();
        interpolation_.clear();
        below_.clear();
        VecDestroy(&coarse_residual_);
        VecDestroy(&correction_);
        hubs_.reset();
        third_.reset();
        coarse_.reset();
        P_.reset();
        fine_.reset();
        nodes_.reset();
    }

    NodalUnknowns unknowns_;    ///< of one's own nodes alone once the grids are chosen: there both are numbered alike
    bool nothing_free_ = false; ///< of all processes
    int threads_;
    bool alone_;
    MPI_Comm comm_;
    std::optional<FreeNodes> nodes_;
    std::optional<FineGrid> fine_;
    std::optional<Prolongation> P_;
    std::optional<CoarseMatrix> coarse_;
    std::optional<ThirdMatrix> third_; ///< of several processes alone
    std::optional<Hubs> hubs_;
    std::vector<Mat> below_;         ///< by level, 0 the coarsest, without the finest grid; last that of coarse_
    std::vector<Mat> interpolation_; ///< from level i to i + 1 of these
    std::vector<Mat> restriction_, half_way_; ///< their transposes, and products A P; of several processes alone
    PC cycle_ = nullptr;
    Vec coarse_residual_ = nullptr, correction_ = nullptr;
    Vector b_, x_, other_; ///< (3 n) with copies
    Vector c_;             ///< of aggregates, with copies
};

} // namespace
} // namespace osculate::solve

extern "C" osculate::solve::Multigrid* osculate_make_multigrid(osculate::solve::NodalUnknowns* unknowns, int threads) {
    return new osculate::solve::Gamg(std::move(*unknowns), threads);
}
