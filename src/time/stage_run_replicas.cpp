#include "time/stage_run.hpp"

namespace osculate::time {

void StageRun::keep_stage_once() const {
    if (!context_.model.share) return;
    Replicas replicas;
    model::add_replicas(context_.model, replicas);
    constraints_.add_replicas(replicas);
    replicas.add(progress_.displacement_start);
    for (const model::ContactHistory& history : progress_.state.contact) history.master->add_replicas(replicas);
    replicas.keep_once(context_.model.share->ranks());
}

void StageRun::keep_attempt_once(const StepAttempt& attempt) const {
    if (!context_.model.share) return;
    Replicas replicas;
    for (const Field* field : {&progress_.state.u, &progress_.state.v, &progress_.state.a}) replicas.add(*field);
    if (attempt.ladder.stabilisation.start) replicas.add(*attempt.ladder.stabilisation.start);
    equilibrium().add_replicas(replicas);
    replicas.keep_once(context_.model.share->ranks());
}

} // namespace osculate::time
