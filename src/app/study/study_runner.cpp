#include "app/study/study_runner.hpp"

#include "app/study/child_process.hpp"
#include "app/study/run_folder.hpp"
#include "osculate/app/load.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/output/progress.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sys/wait.h>

namespace osculate::app {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Whether two runs left the same results.
bool same_results(const fs::path& a, const fs::path& b) {
    std::vector<fs::path> files{"history.csv", "steps.csv"};
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(a / "frames", none))
        files.push_back(fs::path("frames") / entry.path().filename());
    return std::ranges::all_of(files,
                               [&](const fs::path& file) { return file_content(a / file) == file_content(b / file); });
}

class Runner {
public:
    Runner(std::vector<StudyCase>& cases, const StudyRunOptions& options, const std::function<void()>& finished)
        : cases_(cases), options_(options), finished_(finished),
          progress_({}, options.quiet ? output::Progress::Style::quiet : output::Progress::style_of(stderr)) {}

    void run();

private:
    struct Job {
        StudyCase* of;
        std::size_t repeat;
        fs::path folder;
    };
    [[nodiscard]] bool wants(const StudyCase& c, std::size_t repeat) const;
    StudyCase* next();
    void start(StudyCase& c);
    void ended(const Job& job, int status);
    void tell(const StudyCase& c);
    void end_by(int signal);

    std::vector<StudyCase>& cases_;
    const StudyRunOptions& options_;
    const std::function<void()>& finished_;
    const SignalWatch watch_{};
    output::Progress progress_;
    std::map<pid_t, Job> running_;
    std::set<const StudyCase*> failed_; ///< refused or bug: once is enough
    double spent_ = 0;                  ///< wall seconds of runs of this session
    int done_ = 0;
};

bool Runner::wants(const StudyCase& c, std::size_t repeat) const {
    const StudyRecord& r = c.record;
    if (failed_.contains(&c) || r.repeats.size() > repeat || !is_chosen(c, options_)) return false;
    if (r.status.empty()) return true;
    // one that gave up before it could write its summary is not done again
    return r.finished() && !r.repeats.empty() && repeat < static_cast<std::size_t>(options_.repeats);
}

/// The first case with fewest repeats that is not running.
StudyCase* Runner::next() {
    for (std::size_t repeat = 0; repeat < static_cast<std::size_t>(options_.repeats); ++repeat)
        for (StudyCase& c : cases_)
            if (wants(c, repeat) &&
                std::ranges::none_of(running_, [&](const auto& entry) { return entry.second.of == &c; }))
                return &c;
    return nullptr;
}

void Runner::start(StudyCase& c) {
    Job job{&c, c.record.repeats.size(), c.folder};
    if (job.repeat == 0) {
        make_run_folder(c.folder, options_.force);
        write_record(c); // whose hash says what the files to come follow from
    } else {
        job.folder /= repeat_folder(job.repeat + 1);
        make_run_folder(job.folder, options_.force);
    }
    running_.emplace(start_program(run_words(c, c.scene_path, job.folder, options_), job.folder / messages_file), job);
}

void Runner::ended(const Job& job, int status) {
    StudyRecord& record = job.of->record;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const std::string before = record.status;
    const bool readable = (code == 0 || code == 3) && add_repeat(record, job.folder);
    if (readable) {
        spent_ += record.repeats.back().wall;
        if (job.repeat > 0) {
            record.same = record.same && record.status == before && same_results(job.of->folder, job.folder);
            record.status = before;
        }
    } else { // it may have given up before it could say so in a file
        add_failure(record, job.folder, code, WIFSIGNALED(status) ? WTERMSIG(status) : 0);
    }
    if (!record.finished()) failed_.insert(job.of);
    write_record(*job.of);
    if (job.repeat > 0) remove_run_folder(job.folder);
    ++done_;
    job.of->results.clear();
    finished_();
    tell(*job.of);
}

void Runner::tell(const StudyCase& c) {
    int left = 0;
    for (const StudyCase& other : cases_)
        for (std::size_t repeat = 0; repeat < static_cast<std::size_t>(options_.repeats); ++repeat)
            left += wants(other, repeat);
    const StudyRecord& r = c.record;
    const std::string what = r.status == "done" ? fmt::format("{:.1f} s", r.repeats.back().wall) : r.status;
    const auto rest = static_cast<long>(std::ceil(spent_ / done_ * left / options_.jobs));
    progress_.show(fmt::format("run {}/{}, {}: {}, ETA {}:{:02}:{:02}", done_, done_ + left, c.id, what, rest / 3600,
                               rest / 60 % 60, rest % 60));
}

void Runner::end_by(int signal) {
    for (const auto& [child, job] : running_) kill(child, SIGTERM);
    for (const auto& [child, job] : running_) waitpid(child, nullptr, 0);
    progress_.finish();
    std::fputs("stopped; the same command goes on from here\n", stderr);
    watch_.end_by(signal);
}

void Runner::run() {
    while (true) {
        while (running_.size() < static_cast<std::size_t>(options_.jobs)) {
            StudyCase* c = next();
            if (c == nullptr) break;
            start(*c);
        }
        if (running_.empty()) break;
        if (const int signal = watch_.wait(); signal != 0) end_by(signal);
        std::vector<std::pair<Job, int>> over;
        for (auto at = running_.begin(); at != running_.end();) {
            int status = 0;
            if (waitpid(at->first, &status, WNOHANG) != at->first) {
                ++at;
                continue;
            }
            over.emplace_back(at->second, status);
            at = running_.erase(at);
        }
        for (const auto& [job, status] : over) ended(job, status);
    }
    progress_.finish();
}

/// Faults of every jobs-th case from `first` on, as JSON.
Json faults_of(const scene::Study& study, const std::vector<const StudyCase*>& cases, std::size_t first,
               std::size_t stride) {
    Json list = Json::array();
    for (std::size_t i = first; i < cases.size(); i += stride) {
        const StudyCase& c = *cases[i];
        try {
            Timings unused;
            (void)load(c.scene_path, c.overrides, 1, unused);
        } catch (const SceneError& error) {
            for (const Fault& fault : error.faults()) {
                const Fault f = scene::placed(fault, study, c.combination);
                list.push_back({f.file, f.line, f.column, f.key, f.expected, f.found, f.nearest});
            }
        }
    }
    return list;
}

} // namespace

std::vector<std::string> run_words(const StudyCase& c, const std::string& scene_path, const fs::path& folder,
                                   const StudyRunOptions& options) {
    std::vector<std::string> words{
        "run", scene_path, "-o", folder.string(), "--quiet", "--threads", std::to_string(options.threads)};
    if (options.force) words.emplace_back("--force");
    for (const scene::Override& change : c.overrides)
        words.insert(words.end(), {"--set", change.key + "=" + change.value});
    return words;
}

bool is_chosen(const StudyCase& c, const StudyRunOptions& options) {
    for (std::size_t a = 0; a < options.only.size(); ++a)
        if (!options.only[a].empty() && std::ranges::count(options.only[a], c.combination[a]) == 0) return false;
    return true;
}

void check_cases(const scene::Study& study, const std::vector<StudyCase>& cases, const StudyRunOptions& options) {
    std::vector<const StudyCase*> waiting;
    for (const StudyCase& c : cases)
        if (c.record.status.empty() && is_chosen(c, options)) waiting.push_back(&c);
    std::vector<std::pair<pid_t, std::FILE*>> children;
    const auto stride = static_cast<std::size_t>(options.jobs);
    for (std::size_t k = 0; k < stride && k < waiting.size(); ++k) {
        std::FILE* file = std::tmpfile();
        if (file == nullptr) throw std::runtime_error("cannot make a temporary file");
        children.emplace_back(start_copy([&, file] {
                                  const std::string text = faults_of(study, waiting, k, stride).dump();
                                  std::fwrite(text.data(), 1, text.size(), file);
                                  std::fflush(file);
                                  return 0;
                              }),
                              file);
    }
    std::vector<Fault> faults;
    std::set<std::string> known;
    for (const auto& [child, file] : children) {
        int status = 0;
        waitpid(child, &status, 0);
        std::string text;
        std::rewind(file);
        for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
        std::fclose(file);
        const Json list = Json::parse(text, nullptr, false);
        if (!list.is_array()) continue; // a bug or no memory: the run itself will say so
        for (const Json& f : list) {
            Fault fault{f[0], f[1], f[2], f[3], f[4], f[5], f[6]};
            if (known.insert(fault.message()).second) faults.push_back(std::move(fault));
        }
    }
    if (!faults.empty()) throw SceneError(std::move(faults));
}

void run_cases(std::vector<StudyCase>& cases, const StudyRunOptions& options, const std::function<void()>& finished) {
    Runner(cases, options, finished).run();
}

} // namespace osculate::app
