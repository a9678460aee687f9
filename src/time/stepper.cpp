#include "osculate/time/stepper.hpp"

#include "osculate/core/error.hpp"
#include "osculate/time/post_mortem.hpp"
#include "time/run_context.hpp"
#include "time/stage_run.hpp"
#include "time/stage_state.hpp"

namespace osculate::time {

Stepper::Stepper(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings)
    : stages_(std::move(stages)), context_(new RunContext{model, options, timings}) {
    progress_ = at_rest(model);
    Vec3 low = model.X[0], high = low;
    for (const Vec3& X : model.X) {
        low = low.cwiseMin(X);
        high = high.cwiseMax(X);
    }
    context_->characteristic_length = (high - low).norm();
    context_->largest_stiffness = model::largest_stiffness(model);
    if (!options.audit) return;
    const ScopedTimer timer(timings, Part::audit);
    context_->audit = std::make_unique<Audit>(model);
}

Stepper::~Stepper() = default;

double Stepper::end_time() const {
    double time = 0;
    for (const Stage& stage : stages_) time += stage.duration;
    return time;
}

void Stepper::run(StepObserver& observer) {
    const std::unique_ptr<const Checkpoint> from = std::move(resumed_);
    for (std::size_t s = from ? from->stage : 0; s < stages_.size(); ++s) {
        const Stage& stage = stages_[s];
        const Checkpoint* within = from && s == from->stage ? from.get() : nullptr;
        progress_.stage = s;
        if (within == nullptr) progress_.stage_start = progress_.state.time;
        try {
            StageRun(*context_, stage, progress_, observer, within).run();
        } catch (const LoadNotFinite& failure) {
            observer.gave_up(examine(failure, context_->model, stage, progress_.stage_start, progress_.state.time),
                             nullptr);
            throw;
        }
    }
}

void Stepper::lead(std::vector<BesideRun*> beside) {
    context_->beside = std::move(beside);
}

void Stepper::resume(Checkpoint checkpoint) {
    const model::Model& model = context_->model;
    if (const std::string what = misfit(checkpoint, model, stages_.size()); !what.empty())
        throw RunFailure("the checkpoint does not fit the scene: " + what);
    restore_pairs(checkpoint, model);
    Progress progress = checkpoint;
    for (std::size_t p = 0; p < progress.state.contact.size(); ++p) {
        const model::ContactPair& pair = *progress.state.contact[p].pair;
        auto& master = progress.state.contact[p].master = pair.master();
        if (!checkpoint.patches[p].empty()) master = master->refitted(checkpoint.patches[p]);
        if (!master) throw RunFailure("the checkpoint does not fit the scene: patches of pair '" + pair.name() + "'");
    }
    progress_ = std::move(progress);
    resumed_ = std::make_unique<Checkpoint>(std::move(checkpoint));
}

} // namespace osculate::time
