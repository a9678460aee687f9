#include "osculate/output/progress.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace osculate::output {

namespace {

/// Characters of a line on the terminal behind `stream`; one that wraps could not be overwritten.
std::size_t terminal_width(std::FILE* stream) {
    winsize size{};
    const bool known = ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return known ? size.ws_col - 1U : 79U;
}

std::string clock_text(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

} // namespace

Eta::Eta(std::vector<ProgressStage> stages) : stages_(std::move(stages)) {}

double Eta::end() const {
    double time = 0;
    for (const ProgressStage& stage : stages_) time += stage.duration;
    return time;
}

double Eta::planned_until(double time) const {
    double steps = 0;
    for (const ProgressStage& stage : stages_) {
        steps += std::clamp(time / stage.duration, 0.0, 1.0) * stage.steps;
        time -= stage.duration;
    }
    return steps;
}

double Eta::rest(double time, double elapsed) {
    const double now = planned_until(time), all = planned_until(end());
    const bool first = reached_.empty();
    reached_.push_back({now, elapsed});
    const double half = 0.5 * (reached_.front().steps + now);
    const Reached& from = *std::prev(std::ranges::upper_bound(reached_, half, {}, &Reached::steps));
    if (first || !(now > from.steps) || !(elapsed >= from.elapsed)) return now >= all ? 0 : std::nan("");
    return (elapsed - from.elapsed) / (now - from.steps) * std::max(0.0, all - now);
}

std::string progress_line(const ProgressStep& step, double end, double rest) {
    std::string line = fmt::format("t {:.6g}/{:.6g} s, step {}, dt {:.3g} s, Newton {}, contacts {}", step.time, end,
                                   step.step, step.dt, step.iterations, step.contacts);
    constexpr double longest = 1e9; // s; beyond it, and at the very start, an estimate says nothing
    if (std::isfinite(rest) && rest >= 0 && rest < longest) line += ", ETA " + clock_text(rest);
    return line;
}

Progress::Style Progress::style_of(std::FILE* stream) {
    return isatty(fileno(stream)) == 1 ? Style::live : Style::plain;
}

Progress::Progress(std::vector<ProgressStage> stages, Style style, std::FILE* stream)
    : eta_(std::move(stages)), style_(style), stream_(stream) {}

void Progress::update(const ProgressStep& step) {
    if (style_ == Style::quiet) return;
    const double elapsed = std::chrono::duration<double>(clock::now() - begun_).count();
    show(progress_line(step, eta_.end(), eta_.rest(step.time, elapsed)));
}

void Progress::show(std::string line) {
    if (style_ == Style::quiet) return;
    if (style_ == Style::live) {
        line.resize(std::min(line.size(), terminal_width(stream_)));
        line = "\r" + line + "\x1b[K"; // erases what a longer line before left behind
        open_ = true;
    } else {
        line += '\n';
    }
    std::fputs(line.c_str(), stream_); // a reader gone away is no reason to end a run: failure is ignored
    std::fflush(stream_);
}

void Progress::finish() {
    if (!open_) return;
    std::fputc('\n', stream_);
    std::fflush(stream_);
    open_ = false;
}

} // namespace osculate::output
