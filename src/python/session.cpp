#include "python/session.hpp"

#include "osculate/app/advice.hpp"
#include "osculate/output/history.hpp"
#include "osculate/output/post_mortem_file.hpp"

#include <algorithm>
#include <utility>

namespace osculate::python {

namespace {

app::LoadedScene compiled(scene::Scene scene, int threads) {
    Timings unused;
    app::LoadedScene loaded{std::move(scene), {}, {}};
    loaded.plan = app::compile(loaded.scene, threads, unused);
    return loaded;
}

app::LoadedScene compiled(const std::string& path, const std::vector<scene::Override>& overrides, int threads) {
    Timings unused;
    return app::load(path, overrides, threads, unused);
}

} // namespace

Session::Session(const std::string& path, const std::vector<scene::Override>& overrides, int threads)
    : Session(compiled(path, overrides, threads), threads) {}

Session::Session(scene::Scene scene, int threads) : Session(compiled(std::move(scene), threads), threads) {}

Session::Session(app::LoadedScene loaded, int threads)
    : threads_(threads), loaded_(std::move(loaded)),
      stepper_(loaded_.plan.model, loaded_.plan.stages, loaded_.plan.stepper, timings_) {
    const app::Plan& plan = loaded_.plan;
    reactions_ = loaded_.scene.output.history_reactions && !plan.constrained_sets.empty();
    if (reactions_) sets_ = plan.constrained_sets;
    reactions_ = reactions_ || !plan.model.rigid.empty();
    ledger_ = std::ranges::any_of(plan.stages, [](const time::Stage& stage) { return stage.dynamics.has_value(); });
    columns_ = output::History::columns(plan.model, loaded_.scene.output.history_pairs, sets_, ledger_);
}

Session::~Session() {
    close();
}

void Session::write(app::RunOptions options) {
    options.heed_signals = false;
    files_ = std::move(options);
}

void Session::go_on() {
    std::unique_lock lock(mutex_);
    if (phase_ == Phase::ended || phase_ == Phase::running) return;
    // after the last step nothing is evaluated any more: it can be looked at for good
    const bool last = phase_ == Phase::step && state().time >= stepper_.end_time() * (1 - 1e-12);
    if (last)
        keep_last();
    else
        snapshot_.reset();
    equilibrium_ = nullptr;
    pausing_ = false;
    const bool first = phase_ == Phase::created;
    phase_ = Phase::running;
    if (first) thread_ = std::thread([this] { work(); });
    lock.unlock();
    changed_.notify_all();
}

bool Session::wait(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, longest, [&] { return phase_ != Phase::running; });
}

void Session::pause() {
    const std::scoped_lock lock(mutex_);
    pausing_ = true;
}

void Session::close() {
    {
        const std::scoped_lock lock(mutex_);
        keep_last();
        closing_ = true;
        if (!thread_.joinable()) phase_ = Phase::ended;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Session::keep_last() {
    if (equilibrium_ == nullptr || phase_ != Phase::step) return;
    last_ = equilibrium_->contact();
    std::vector<Vec3> reactions = output::nodal_reactions(equilibrium_->constraints(), equilibrium_->unbalanced());
    has_reactions_ = true;
    snapshot_.emplace(model(), state(), last_, std::move(reactions), std::vector<Vec3>{}, step_.dt);
    equilibrium_ = nullptr;
}

const output::Snapshot* Session::snapshot(bool reactions) {
    if (!snapshot_ || phase_ == Phase::running) return nullptr;
    if (reactions && !has_reactions_) { // of the step it waits in
        has_reactions_ = true;
        snapshot_.emplace(model(), state(), equilibrium_->contact(),
                          output::nodal_reactions(equilibrium_->constraints(), equilibrium_->unbalanced()),
                          std::vector<Vec3>{}, step_.dt);
    }
    return &*snapshot_;
}

void Session::work() {
    std::exception_ptr failure;
    bool completed = false;
    try {
        if (files_)
            app::run(loaded_, stepper_, timings_, *files_, this);
        else
            stepper_.run(*this);
        completed = true;
    } catch (const app::Stopped&) {
    } catch (const app::GaveUp&) {
        failure = std::current_exception();
    } catch (const RunFailure& error) {
        failure = post_mortem_.empty() ? std::current_exception()
                                       : std::make_exception_ptr(app::GaveUp(error.what(), post_mortem_));
    } catch (...) {
        failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    failure_ = failure;
    completed_ = completed;
    phase_ = Phase::ended;
    changed_.notify_all();
}

void Session::wait_at(Phase phase) {
    std::unique_lock lock(mutex_);
    phase_ = phase;
    changed_.notify_all();
    changed_.wait(lock, [&] { return phase_ == Phase::running || closing_; });
    if (closing_) throw app::Stopped("stopped at " + std::to_string(step_.time) + " s");
}

void Session::attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>&) {
    if (attempt.verdict == time::Verdict::accept) return;
    ++rejected_;
    bool waits = false;
    {
        const std::scoped_lock lock(mutex_);
        waits = pausing_ || closing_;
    }
    if (waits && attempt.verdict != time::Verdict::give_up) wait_at(Phase::attempt);
}

void Session::accepted(const time::AcceptedStep& step) {
    const linear::Constraints& constraints = step.equilibrium.constraints();
    std::vector<Vec3> reactions;
    if (reactions_) reactions = output::nodal_reactions(constraints, step.equilibrium.unbalanced());
    has_reactions_ = reactions_;
    snapshot_.emplace(model(), step.state, step.equilibrium.contact(), std::move(reactions), std::vector<Vec3>{},
                      step.dt);
    history_.push_back(output::History::cells(*snapshot_, constraints, step.dt, step.iterations,
                                              loaded_.scene.output.history_pairs, sets_, ledger_, step.ledger));
    step_ = {step_.number + 1, step.state.time, step.dt, step.iterations, step.stage.name};
    equilibrium_ = &step.equilibrium;
    wait_at(Phase::step);
}

void Session::gave_up(const time::PostMortem& found, const time::FailedIterate* iterate) {
    post_mortem_ = output::in_words(app::advised(found, iterate));
}

} // namespace osculate::python
