#pragma once
/// Progress of a run, for the waiting user.

#include <chrono>
#include <cstdio>
#include <string>

namespace osculate::output {

/// An accepted step.
struct ProgressStep {
    long step = 0;
    double time = 0, dt = 0; ///< s, of the scene
    int iterations = 0;      ///< Newton iterations of the step
    long contacts = 0;       ///< slave nodes in contact
};

/// The line shown for a step: "t 3.5/31 s, step 4, dt 1 s, Newton 2, contacts 221, ETA 0:00:53".
/// @param start, end  time of the scene at the start of the run and at its end, s
/// @param elapsed     wall time since then, s; the ETA takes the rest of the scene to cost as much per second of its time
[[nodiscard]] std::string progress_line(const ProgressStep& step, double start, double end, double elapsed);

/// One updated line on a terminal, one line per step otherwise, nothing if quiet.
class Progress {
public:
    enum class Style { quiet, plain, live };

    /// live for a terminal, otherwise plain
    [[nodiscard]] static Style style_of(std::FILE* stream);

    /// @param start, end  time of the scene at the start of the run and at its end, s
    Progress(double start, double end, Style style = style_of(stderr), std::FILE* stream = stderr);
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
    double start_, end_;
    Style style_;
    std::FILE* stream_;
    clock::time_point begun_ = clock::now();
    bool open_ = false; ///< the cursor is on a live line
};

} // namespace osculate::output
