#include "app/run/run_recorder.hpp"

#include "app/plan/gaps.hpp"
#include "app/plan/held_loads.hpp"
#include "app/report/plots.hpp"
#include "app/run/process_summary.hpp"
#include "osculate/app/advice.hpp"
#include "osculate/app/report.hpp"
#include "osculate/app/run_report.hpp"
#include "osculate/app/version.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/output/paraview_script.hpp"
#include "osculate/output/post_mortem_file.hpp"
#include "osculate/scene/writer.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <set>
#include <sys/resource.h>
#include <utility>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* failed_folder = "failed"; ///< of the last iterate of a run that gave up
constexpr const char* series_file = "series.pvd";

/// Runs `write`, at the expense of output. A file that cannot be written ends the run as a failure, not as a bug.
template <class F> void on_disk(Timings& timings, F&& write) {
    const ScopedTimer timer(timings, Part::output);
    try {
        write();
    } catch (const std::runtime_error& error) {
        throw RunFailure(error.what());
    }
}

std::vector<output::ProgressStage> planned(const Plan& plan) {
    std::vector<output::ProgressStage> stages;
    for (const time::Stage& stage : plan.stages) stages.push_back({stage.duration, stage.steps});
    return stages;
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

} // namespace

RunRecorder::RunRecorder(const scene::Scene& scene, const Plan& plan, const time::Stepper& stepper, Timings& timings,
                         Settings settings)
    : scene_(scene), plan_(plan), stepper_(stepper), timings_(timings), settings_(std::move(settings)),
      progress_(planned(plan), settings_.quiet ? output::Progress::Style::quiet : output::Progress::style_of(stderr)),
      checks_(plan.model, scene.expect, plan.settles_by_rule) {
    const scene::Output& out = scene.output;
    const fs::path& folder = directory();
    const bool reactions = out.history_reactions && !plan.constrained_sets.empty();
    describe_plan();
    on_disk(timings_, [&] {
        output::OutputFolder& files = *settings_.folder;
        if (!resumed()) {
            files.remove_all_but({});
            files.claim(tables());
            write_text(files.path_of("scene.yaml"), scene::write_scene(scene));
        }
        files.claim({"summary.json"});
        if (out.frame_every > 0) {
            files.claim({series_file});
            frames_ = std::make_unique<output::Frames>(
                settings_.frames_folder.empty() ? folder : settings_.frames_folder,
                output::FrameFields{out.body_fields, out.slave_fields, out.master_fields}, plan.model,
                settings_.threads > 1, resumed() ? settings_.from->frames : std::vector<output::SeriesEntry>{},
                plan.model.share.get());
        }
        if (resumed()) remove_what_is_written_anew(); // after series.pvd has forgotten it
        if (out.frame_every > 0 && out.paraview) {
            files.claim({output::paraview_script_file});
            output::write_paraview_script(folder, plan.model, {out.body_fields, out.slave_fields, out.master_fields});
        }
        for (const PlannedProbe& probe : plan.probes)
            probes_.emplace_back(folder, probe.name, *probe.probe, kept(output::ProbeFile::relative_path(probe.name)));
        history_ = std::make_unique<output::History>(
            folder / "history.csv", plan.model, out.history_pairs,
            reactions ? plan.constrained_sets : std::vector<Index>{},
            std::any_of(plan.stages.begin(), plan.stages.end(),
                        [](const time::Stage& stage) { return stage.dynamics.has_value(); }),
            kept("history.csv"));
        steps_ = std::make_unique<output::CsvTable>(folder / "steps.csv",
                                                    std::vector<std::string>{"attempt", "time", "dt", "verdict",
                                                                             "reason", "body", "node", "value",
                                                                             "lambda", "iterations"},
                                                    kept("steps.csv"));
        if (out.iterations)
            iterations_ = std::make_unique<output::CsvTable>(
                folder / "iterations.csv",
                std::vector<std::string>{"attempt", "iteration", "residual", "status_changes", "open", "stick", "slip",
                                         "facet_changes"},
                kept("iterations.csv"));
        if (settings_.derivatives != nullptr) settings_.derivatives->open(files);
        if (resumed()) recall(*settings_.from);
    });
    checkpoint_step_ = summary_.steps.accepted;
    checkpoint_time_ = std::chrono::steady_clock::now();
    if (!resumed()) write_initial_frame();
    write_summary();
}

std::vector<std::string> RunRecorder::tables() const {
    std::vector<std::string> names{"history.csv", "steps.csv"};
    if (scene_.output.iterations) names.emplace_back("iterations.csv");
    for (const PlannedProbe& probe : plan_.probes) names.push_back(output::ProbeFile::relative_path(probe.name));
    return names;
}

std::vector<std::string> RunRecorder::files(const scene::Scene& scene, const Plan& plan) {
    std::vector<std::string> names{"scene.yaml", "history.csv", "steps.csv", "iterations.csv", "summary.json"};
    names.insert(names.end(), {output::post_mortem_file, checkpoint_path, previous_checkpoint_path});
    for (const PlannedProbe& probe : plan.probes) names.push_back(output::ProbeFile::relative_path(probe.name));
    const auto frames = [&](const std::string& folder) {
        names.push_back(folder + series_file);
        for (const model::Body& body : plan.model.bodies) {
            names.push_back(folder + "frames/" + body.name + "_*.vtu");
            if (folder.empty()) // all processes write these together
                names.insert(names.end(),
                             {"frames/" + body.name + "_*.pvtu", "frames/pieces/" + body.name + "_*_*.vtu"});
        }
        for (const auto& pair : plan.model.pairs)
            for (const char* side : {".slave", ".master"})
                names.push_back(folder + "frames/" + pair->name() + side + "_*.vtp");
    };
    const std::vector<std::string> derivatives = Derivatives::files(scene, plan);
    names.insert(names.end(), derivatives.begin(), derivatives.end());
    if (scene.output.failed_iterate) frames(std::string(failed_folder) + "/");
    if (scene.output.frame_every > 0) {
        frames("");
        names.emplace_back(output::paraview_script_file);
    }
    const std::vector<std::string> plots = plot_files(scene);
    names.insert(names.end(), plots.begin(), plots.end());
    if (scene.output.report) names.emplace_back("report.html");
    return names;
}

void RunRecorder::remove_what_is_written_anew() {
    const std::vector<std::string> rows = tables();
    std::set<std::string> kept(rows.begin(), rows.end());
    kept.insert({"scene.yaml", "summary.json", checkpoint_path, previous_checkpoint_path});
    if (frames_) kept.insert(series_file);
    for (const output::SeriesEntry& frame : settings_.from->frames) {
        kept.insert(frame.file);
        std::ranges::copy_if(settings_.folder->files(), std::inserter(kept, kept.end()),
                             [&](const std::string& file) { return output::Frames::is_piece_of(file, frame.file); });
    }
    settings_.folder->claim(rows);
    settings_.folder->remove_all_but(kept);
}

void RunRecorder::describe_plan() {
    summary_.folder = directory();
    summary_.version = version;
    summary_.scene = scene_.name;
    summary_.status = "running";
    summary_.dofs = degrees_of_freedom(plan_);
    summary_.threads = settings_.threads;
    for (const model::Body& body : plan_.model.bodies)
        summary_.bodies.push_back({body.name, body.nodes(), body.mesh.element_count()});
    for (const auto& pair : plan_.model.pairs) {
        const scene::Pair& spec = *scene::find(scene_.contact, pair->name());
        static const char* const surfaces[] = {"automatic", "facets", "rpim", "blend"}; // in the order of the variant
        summary_.pairs.push_back(
            {pair->name(), pair->size(), pair->surface().facet_count(), surfaces[spec.master.surface.index()]});
    }
    summary_.processes = processes_of(plan_.model);
    for (const PlanItem& item : plan_.items)
        if (item.present) summary_.plan.push_back(item.part);
}

void RunRecorder::write_initial_frame() {
    if (!frames_) return;
    const scene::Output& out = scene_.output;
    model::ContactEvaluations contact;
    const bool shows_contact = !out.slave_fields.empty() || !out.master_fields.empty();
    const bool reads_it =
        settings_.frames_folder.empty() ||
        std::ranges::any_of(out.body_fields, [](const std::string& name) { return name.starts_with("contact_"); });
    if (shows_contact && reads_it)
        for (model::ContactEvaluation& evaluation :
             contact = model::contact_evaluations(model::pairs_of(stepper_.state().contact)))
            (void)initial_gaps(evaluation, plan_.model.X, timings_, settings_.threads);
    on_disk(timings_, [&] {
        settings_.folder->claim(frames_->files(0));
        frames_->write({plan_.model, stepper_.state(), contact, output::Reactions()}, 0);
    });
}

void RunRecorder::attempted(const time::Attempt& a, const std::vector<equilibrium::IterationRecord>& iterations) {
    ++(a.verdict == time::Verdict::accept ? summary_.steps.accepted : summary_.steps.rejected);
    summary_.iterations += a.iterations;
    on_disk(timings_, [&] {
        const output::Cell node = a.node < 0 ? output::Cell{std::string()} : output::Cell{long{a.node}};
        steps_->row({long{a.attempt}, a.time, a.dt, name(a.verdict), name(a.reason), a.body, node, a.value, a.lambda,
                     long{a.iterations}});
        if (!iterations_) return;
        for (const equilibrium::IterationRecord& i : iterations)
            iterations_->row({long{a.attempt}, long{i.iteration}, i.residual, long{i.status_changes}, long{i.open},
                              long{i.stick}, long{i.slip}, long{i.facet_changes}});
    });
}

void RunRecorder::accepted(const time::AcceptedStep& step) {
    checks_.accepted(step);
    const linear::Constraints& constraints = step.equilibrium.constraints();
    on_disk(timings_, [&] {
        const int every = scene_.output.frame_every;
        const bool last = step.state.time >= stepper_.end_time() * (1 - 1e-12);
        const bool frame = frames_ && (summary_.steps.accepted % every == 0 || last);
        const output::Snapshot snapshot(plan_.model, step.state, step.equilibrium.contact(),
                                        {constraints, step.equilibrium.unbalanced()}, {}, step.dt, step.audit);
        history_->row(snapshot, constraints, step.dt, step.iterations, step.ledger);
        if (frame) {
            settings_.folder->claim(frames_->files(summary_.steps.accepted));
            frames_->write(snapshot, summary_.steps.accepted);
        }
        const std::vector<std::size_t> due = probes_due(last);
        for (const std::size_t p : due) probes_[p].write(snapshot);
        if (settings_.derivatives != nullptr) settings_.derivatives->accepted(step, due);
    });
    update_processes(summary_.processes, step.equilibrium, plan_.model);
    write_summary();
    if (settings_.quiet) return;
    long contacts = 0;
    for (const model::ContactHistory& history : step.state.contact)
        contacts += std::ranges::count_if(history.status, contact::is_closed);
    progress_.update({summary_.steps.accepted, step.state.time, step.dt, step.iterations, contacts});
}

std::vector<std::size_t> RunRecorder::probes_due(bool last) const {
    std::vector<std::size_t> due;
    for (std::size_t p = 0; p < probes_.size(); ++p)
        if (last || summary_.steps.accepted % plan_.probes[p].every == 0) due.push_back(p);
    return due;
}

void RunRecorder::between_steps(const std::function<time::Checkpoint()>& checkpoint) {
    int signal = settings_.interruption != nullptr ? settings_.interruption->signal() : 0;
    const Share* share = plan_.model.share.get();
    if (share != nullptr) signal = static_cast<int>(share->ranks().largest(signal)); // it may reach one process alone
    if (settings_.derivatives != nullptr) {                                          // their runs are in no checkpoint
        if (signal != 0) throw Interrupted(signal, stepper_.state().time);
        return;
    }
    const CheckpointEvery& every = settings_.checkpoint_every;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - checkpoint_time_;
    if (signal == 0 && (every.steps == 0 || summary_.steps.accepted - checkpoint_step_ < every.steps) &&
        (every.seconds == 0 || passed.count() < every.seconds))
        return;
    if (share == nullptr || share->ranks().rank() == 0) on_disk(timings_, [&] { write_checkpoint(checkpoint()); });
    checkpoint_step_ = summary_.steps.accepted;
    checkpoint_time_ = std::chrono::steady_clock::now();
    if (signal != 0) throw Interrupted(signal, stepper_.state().time, directory());
}

void RunRecorder::write_checkpoint(const time::Checkpoint& checkpoint) {
    output::CheckpointFile file;
    file.version = version;
    file.scene = scene::write_scene(scene_);
    if (!fingerprint_) fingerprint_ = output::fingerprint(plan_.model);
    file.meshes = *fingerprint_;
    file.run = checkpoint;
    if (frames_) file.frames = frames_->written();
    for (const output::CsvTable* table :
         std::initializer_list<const output::CsvTable*>{&history_->table(), steps_.get(), iterations_.get()})
        if (table != nullptr) {
            table->sync();
            file.tables.emplace_back(table->path().filename().string(), table->size());
        }
    for (std::size_t p = 0; p < probes_.size(); ++p) {
        probes_[p].table().sync();
        file.tables.emplace_back(output::ProbeFile::relative_path(plan_.probes[p].name), probes_[p].table().size());
    }
    file.steps = summary_.steps;
    file.iterations = summary_.iterations;
    const Spent spent = spent_so_far();
    file.total_seconds = spent.total;
    file.cpu_seconds = spent.cpu;
    for (std::size_t part = 0; part < static_cast<std::size_t>(Part::count); ++part)
        file.seconds.push_back(timings_[static_cast<Part>(part)]);
    file.checks = checks_.memory();
    settings_.folder->claim({checkpoint_path, previous_checkpoint_path});
    output::write_checkpoint(directory() / checkpoint_path, file);
}

std::optional<std::uintmax_t> RunRecorder::kept(const std::string& table) const {
    if (!resumed()) return std::nullopt;
    for (const auto& [path, bytes] : settings_.from->tables)
        if (path == table) return bytes;
    throw std::runtime_error("the checkpoint knows no " + table);
}

void RunRecorder::recall(const output::CheckpointFile& from) {
    summary_.steps.accepted = from.steps.accepted;
    summary_.steps.rejected = from.steps.rejected;
    summary_.iterations = from.iterations;
    seconds_before_ = from.total_seconds;
    cpu_seconds_before_ = from.cpu_seconds;
    for (std::size_t part = 0; part < std::min(from.seconds.size(), static_cast<std::size_t>(Part::count)); ++part)
        timings_.add(static_cast<Part>(part), from.seconds[part]);
    checks_.recall(from.checks);
}

RunRecorder::Spent RunRecorder::spent_so_far() const {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - settings_.begin;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return {seconds_before_ + elapsed.count(), cpu_seconds_before_ + seconds(usage.ru_utime) + seconds(usage.ru_stime),
            peak_memory_bytes()};
}

void RunRecorder::gave_up(const time::PostMortem& examined, const time::FailedIterate* iterate) {
    const time::PostMortem found = advised(examined, iterate);
    post_mortem_ = output::in_words(found);
    try {
        on_disk(timings_, [&] {
            output::write_post_mortem(settings_.folder->path_of(output::post_mortem_file), found);
            if (iterate != nullptr && scene_.output.failed_iterate) write_failed(*iterate);
        });
    } catch (const RunFailure&) { // a full disk: the first failure is the one to tell
    }
}

void RunRecorder::write_failed(const time::FailedIterate& iterate) {
    const auto with = [](std::vector<std::string> fields, std::initializer_list<const char*> more) {
        for (const char* field : more)
            if (std::ranges::count(fields, field) == 0) fields.emplace_back(field);
        return fields;
    };
    const scene::Output& out = scene_.output;
    const std::string in = std::string(failed_folder) + "/";
    settings_.folder->claim({in + series_file});
    output::Frames frames(directory() / failed_folder,
                          {with(out.body_fields, {"displacement", "out_of_balance"}),
                           with(out.slave_fields, {"gap", "status", "contact_force"}), out.master_fields},
                          plan_.model);
    const std::vector<Vec3>& unbalanced = iterate.equilibrium.unbalanced();
    const std::vector<Vec3> reactions = output::nodal_reactions(iterate.equilibrium.constraints(), unbalanced);
    std::vector<Vec3> rest = unbalanced;
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= reactions[i];
    const long number = summary_.steps.accepted + 1;
    std::vector<std::string> names = frames.files(number);
    for (std::string& name : names) name.insert(0, in);
    settings_.folder->claim(names);
    frames.write({plan_.model, iterate.state, iterate.equilibrium.contact(), reactions, std::move(rest)}, number);
}

void RunRecorder::wait_for_frames() {
    if (frames_) on_disk(timings_, [&] { frames_->finish(); });
}

void RunRecorder::finish(const std::string& status, const std::string& failure) {
    progress_.finish();
    summary_.status = status;
    summary_.failure = failure;
    if (status != "interrupted") summary_.expectation = checks_.judge(failure); // it may still come to what is expected
    count_up();
    // a run that is killed as it draws is not done: the summary says so last, but for the report, which reads it
    if (status != "interrupted") draw_plots();
    on_disk(timings_, [&] { output::write_summary(directory() / "summary.json", summary_); });
    if (status != "interrupted") report();
    if (!summary_.expectation) return;
    const std::vector<std::string>& misses = summary_.expectation->misses;
    if (!misses.empty())
        fmt::print(stderr, "not as expected: {}\n", fmt::join(misses, "; "));
    else if (!settings_.quiet)
        fmt::print(stderr, "as expected\n");
}

void RunRecorder::draw_plots() {
    for (const std::string& warning : summary_.warnings) fmt::print(stderr, "warning: {}\n", warning);
    if (const std::string note = write_plots(scene_, *settings_.folder); !note.empty())
        fmt::print(stderr, "{}\n", note);
}

void RunRecorder::report() {
    if (!scene_.output.report) return;
    try {
        for (const std::string& note : write_report(*settings_.folder).notes) fmt::print(stderr, "report: {}\n", note);
    } catch (const std::exception& error) { // a run is no worse for a report that cannot be written
        fmt::print(stderr, "report: {}\n", error.what());
    }
}

void RunRecorder::write_summary() {
    count_up();
    on_disk(timings_, [&] { output::write_summary(directory() / "summary.json", summary_); });
}

void RunRecorder::count_up() {
    const Spent spent = spent_so_far();
    summary_.total_seconds = spent.total;
    summary_.cpu_seconds = spent.cpu;
    summary_.peak_memory_bytes = spent.peak_bytes;
    summary_.factorisations = stepper_.counts().factorisations;
    summary_.gmres_iterations = stepper_.counts().gmres_iterations;
    summary_.steps.stabilised = stepper_.counts().stabilised_steps;
    summary_.steps.at_round_off = stepper_.counts().steps_at_round_off;
    summary_.steps.held_geometry = stepper_.counts().held_geometry_steps;
    summary_.timings = timings_;
    summary_.checks = checks_.checks();
    if (plan_.stepper.audit || !scene_.solver.audit) {
        summary_.audit = checks_.audit();
        summary_.audit->on = plan_.stepper.audit;
    }
    summary_.warnings = checks_.warnings();
    for (const std::string& key : held_loads(scene_, plan_))
        summary_.warnings.push_back(key + ": " + why_held_load_is_odd);
    if (settings_.derivatives == nullptr) return;
    for (std::string& warning : settings_.derivatives->warnings()) summary_.warnings.push_back(std::move(warning));
}

} // namespace osculate::app
