#pragma once
/// Progress of a run, for the waiting user.

#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

namespace osculate::output {

/// An accepted step.
struct ProgressStep {
    long step = 0;
    double time = 0, dt = 0; ///< s, of the scene
    int iterations = 0;      ///< Newton iterations of the step
    long contacts = 0;       ///< slave nodes in contact
};

/// A stage, as planned.
struct ProgressStage {
    double duration = 1; ///< s
    int steps = 1;
};

/// Wall time that a run has still to go. Planned steps are taken to cost as much as those of the second half of the run so far: what was
/// special about its beginning counts no more.
class Eta {
public:
    explicit Eta(std::vector<ProgressStage> stages);
    /// @param time     of the scene, s; not less than in the calls before
    /// @param elapsed  wall time since the start, s
    /// @returns  s; NaN: not known yet
    [[nodiscard]] double rest(double time, double elapsed);
    [[nodiscard]] double end() const; ///< time of the scene, s

private:
    struct Reached {
        double steps = 0, elapsed = 0; ///< planned steps; wall time, s
    };
    [[nodiscard]] double planned_until(double time) const;

    std::vector<ProgressStage> stages_;
    std::vector<Reached> reached_; ///< ascending
};

/// The line shown for a step: "t 3.5/31 s, step 4, dt 1 s, Newton 2, contacts 221, ETA 0:00:53".
/// @param end   of the scene, s
/// @param rest  wall time to go, s; NaN: not known
[[nodiscard]] std::string progress_line(const ProgressStep& step, double end, double rest);

/// One updated line on a terminal, one line per step otherwise, nothing if quiet.
class Progress {
public:
    enum class Style { quiet, plain, live };

    /// live for a terminal, otherwise plain
    [[nodiscard]] static Style style_of(std::FILE* stream);

    explicit Progress(std::vector<ProgressStage> stages, Style style = style_of(stderr), std::FILE* stream = stderr);
    ~Progress() { finish(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(const ProgressStep& step);
    /// Shows any line instead of the last one.
    void show(std::string line);

    /// Ends the live line, so that other text may follow; the next update starts a new one.
    void finish();

private:
    using clock = std::chrono::steady_clock;
    Eta eta_;
    Style style_;
    std::FILE* stream_;
    clock::time_point begun_ = clock::now();
    bool open_ = false; ///< the cursor is on a live line
};

} // namespace osculate::output
