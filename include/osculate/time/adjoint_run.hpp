#pragma once
/// Derivatives of one quantity by many numbers of a scene, by the adjoint of a run.

#include "osculate/time/perturbed_run.hpp"

namespace osculate::time {

/// A linear function of what a run ends with. Global components.
struct FinalQuantity {
    equilibrium::Weights
        weights; ///< of displacements (nodes), 1/m, and of contact forces (couplings), 1/N, times the quantity's unit
    Field reactions; ///< of the forces of supports (nodes), 1/N; empty: none
};

/// A run's steps have residuals F_n(z_n; z_{n-1}, p) = 0: contact of a step remembers displacements at its start, of which slips
/// are measured, and where stick is elastic also forces. For a quantity q(z_N), the steps are gone through backwards:
///     J_n^T w_n = dq/dz_n - (dF_{n+1}/dz_n)^T w_{n+1}
///     dq/dp = - sum_n w_n . dF_n/dp
/// so that one solution a step serves all numbers p. In statics w shrinks by a factor in each step back where bodies slide: steps that add
/// nothing that counts are left out, and systems of steps that may add little are solved to the error of the others. dF_n/dp is a
/// difference of residuals of two changed models, with p - dp and p + dp, at the unknowns of the run; its error is of order dp^2.
/// In dynamics a state has velocities and accelerations, too, which are affine in the displacements, and all stages are dynamic.
/// Bodies have a symmetric stiffness and no memory but that of temperatures. How patches are fitted anew is taken as given.
class AdjointRun final : public BesideRun {
public:
    /// @param model  of the run; it and all else must outlive this object
    AdjointRun(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings);
    ~AdjointRun() override;

    /// A number that the quantity depends on: the model with p - dp and with p + dp. Before the run begins.
    void add(std::unique_ptr<PerturbedRun> below, std::unique_ptr<PerturbedRun> above, double dp);

    void begin_stage(std::size_t number) override;
    void follow(const BesideStep& step, const LinearSolve& inverse) override;

    /// Why there are no derivatives; empty: there are.
    [[nodiscard]] const std::string& lost() const { return lost_; }
    /// First coupling of each pair of the last stage, and their number.
    [[nodiscard]] const std::vector<Index>& first_coupling() const { return first_coupling_; }
    /// (quantities) (numbers) derivatives of quantities at the end of the run, by the SI unit of each number. Empty if a tangent is
    /// singular.
    [[nodiscard]] std::vector<std::vector<double>> gradients(const std::vector<FinalQuantity>& quantities);

private:
    struct Number;
    struct Step;
    struct StageNow;

    /// Evaluates the residual of a step. False if it has none.
    [[nodiscard]] bool open(const Step& step, StageNow& now);

    std::vector<Stage> stages_;
    std::unique_ptr<RunContext> context_;
    Progress progress_;            ///< what stages begin from; its state is that of the run
    std::vector<Progress> begins_; ///< (stages) without states
    std::vector<Number> numbers_;
    std::vector<Step> steps_;
    std::vector<Index> first_coupling_;
    std::string lost_;
};

} // namespace osculate::time
