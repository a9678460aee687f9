#pragma once
/// Derivatives by direct differentiation: runs of a slightly changed model beside the run of a model.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/time/progress.hpp"
#include "osculate/time/stage.hpp"
#include "osculate/time/stepper.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace osculate::time {

struct RunContext;

/// An accepted step, for the runs beside it.
struct BesideStep {
    const model::State &start, &end;
    const Vector& z; ///< unknowns of the equilibrium
    const equilibrium::Statuses& statuses;
    const model::ContactEvaluations& contact; ///< evaluated at z
    double time = 0, dt = 0;                  ///< at its end, s
    bool impact = false;                      ///< it is one of an impact, see StepLimits::inelastic_impacts
    double reference_force = 1;               ///< N
};

/// dz = J^-1 F with the tangent of the run that leads, at the end of its step. False if J is singular.
using LinearSolve = std::function<bool(const Vector& F, Vector& dz)>;

/// What follows a run step by step.
class BesideRun {
public:
    virtual ~BesideRun() = default;
    virtual void begin_stage(std::size_t number) = 0;
    virtual void follow(const BesideStep& step, const LinearSolve& inverse) = 0;
};

/// The run of a model that differs a little from another one. It takes the steps, contact statuses and facets of the other.
class PerturbedRun {
public:
    /// The model, and all else, must outlive it.
    PerturbedRun(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings);
    ~PerturbedRun();

    void begin_stage(std::size_t number);
    /// Opens a step from its own state. @param F  residual of its model at the other's unknowns
    /// @returns why there is none; empty: there is one
    /// @throws RunFailure if its model has other unknowns
    [[nodiscard]] std::string begin_step(const BesideStep& step, Vector& F);
    /// Residual at unknowns z of its own, with which end_step() goes on. @returns like begin_step()
    [[nodiscard]] std::string evaluate(const BesideStep& step, const Vector& z, Vector& F);
    void end_step(const BesideStep& step, const Vector& z);

    [[nodiscard]] const model::State& state() const { return progress_.state; }
    /// Evaluated at state(). @pre begin_stage() was called
    [[nodiscard]] const equilibrium::Equilibrium& equilibrium() const;
    /// Null in statics.
    [[nodiscard]] const Ledger* ledger() const;

private:
    struct StageNow;

    std::vector<Stage> stages_;
    std::unique_ptr<RunContext> context_;
    Progress progress_;
    std::unique_ptr<StageNow> now_; ///< null: no stage has begun
    Field force_;                   ///< (nodes) dead loads of the step, N
};

/// Direct differentiation by a parameter p: the run of a model leads two of changed models, with p - dp and p + dp. At the end
/// of each of its steps, with unknowns z and tangent J, these have
///     z -/+ dz,   dz = J^-1 (F_below(z; state_below) - F_above(z; state_above)) / 2
/// with the residuals and the states at the step's start of their own, so that (q_above - q_below) / 2 dp is the derivative of
/// a quantity q, with an error of order dp^2.
class PerturbedPair final : public BesideRun {
public:
    PerturbedPair(std::unique_ptr<PerturbedRun> below, std::unique_ptr<PerturbedRun> above)
        : below_(std::move(below)), above_(std::move(above)) {}

    void begin_stage(std::size_t number) override;
    void follow(const BesideStep& step, const LinearSolve& inverse) override;

    /// Why it could not follow any more; empty as long as it can. The states are those before then.
    [[nodiscard]] const std::string& lost() const { return lost_; }
    [[nodiscard]] const PerturbedRun& below() const { return *below_; }
    [[nodiscard]] const PerturbedRun& above() const { return *above_; }

private:
    std::unique_ptr<PerturbedRun> below_, above_;
    std::string lost_;
};

} // namespace osculate::time
