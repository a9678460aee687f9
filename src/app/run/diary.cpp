#include "osculate/app/diary.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/without_traps.hpp"
#include "osculate/output/post_mortem_file.hpp"
#include "osculate/scene/nearest.hpp"
#include "osculate/time/attempt.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

namespace osculate::app {

namespace fs = std::filesystem;
using time::Attempt;
using time::Reason;
using time::reasons;
using time::Verdict;

namespace {

const std::string head_of_diary = "attempt,time,dt,verdict,reason,body,node,value,lambda,iterations";
constexpr std::size_t columns_of_diary = 10;
constexpr Verdict verdicts[] = {Verdict::accept, Verdict::retry, Verdict::give_up};

struct Cell {
    std::string text;
    int column = 1; ///< of its first character
};

/// Cells of one line (RFC 4180). An open quotation ends with the line.
std::vector<Cell> split(const std::string& line) {
    std::vector<Cell> cells(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool doubled = quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"';
        if (doubled)
            cells.back().text += line[i++];
        else if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            cells.push_back({"", static_cast<int>(i) + 2});
        else
            cells.back().text += line[i];
    }
    return cells;
}

/// Reads the cells of one line in their order; the first that is wrong becomes a fault and those after it are left out.
class LineReader {
public:
    LineReader(const std::string& file, int line, const std::string& text)
        : file_(file), line_(line), cells_(split(text)) {
        if (cells_.size() != columns_of_diary)
            fail(1, "", fmt::format("{} cells: {}", columns_of_diary, head_of_diary),
                 fmt::format("{} in '{}'", cells_.size(), text));
    }
    [[nodiscard]] const std::vector<Fault>& faults() const { return faults_; }

    [[nodiscard]] std::string text() { return faults_.empty() ? cells_[next_++].text : ""; }
    template <class Number, class Condition>
    [[nodiscard]] Number number(const char* key, const char* expected, Condition admissible) {
        Number value{};
        if (!faults_.empty()) return value;
        const Cell& cell = cells_[next_++];
        const char* const end = cell.text.data() + cell.text.size();
        const auto [read, error] = std::from_chars(cell.text.data(), end, value);
        if (error != std::errc() || read != end || !admissible(value))
            fail(cell.column, key, expected, "'" + cell.text + "'");
        return value;
    }
    template <class Choice, std::size_t n> [[nodiscard]] Choice choice(const char* key, const Choice (&choices)[n]) {
        if (!faults_.empty()) return choices[0];
        const Cell& cell = cells_[next_++];
        std::vector<std::string> names;
        for (const Choice one : choices) {
            names.push_back(name(one));
            if (names.back() == cell.text) return one;
        }
        fail(cell.column, key, fmt::format("one of {}", fmt::join(names, ", ")), "'" + cell.text + "'");
        faults_.back().nearest = scene::nearest(cell.text, names);
        return choices[0];
    }
    [[nodiscard]] bool next_is_empty() const { return faults_.empty() && cells_[next_].text.empty(); }

private:
    void fail(int column, const std::string& key, const std::string& expected, const std::string& found) {
        faults_.push_back({file_, line_, column, key, expected, found, ""});
    }

    const std::string& file_;
    int line_;
    std::vector<Cell> cells_;
    std::size_t next_ = 0;
    std::vector<Fault> faults_;
};

Attempt read_attempt(LineReader& line) {
    const auto any = [](double) { return true; };
    const auto finite = [](double value) { return std::isfinite(value); };
    const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
    const auto count = [](Index value) { return value >= 0; };
    Attempt a;
    a.attempt = line.number<Index>("attempt", "a whole number >= 0", count);
    a.time = line.number<double>("time", "a time in s", finite);
    a.dt = line.number<double>("dt", "a time in s, > 0", positive);
    a.verdict = line.choice("verdict", verdicts);
    a.reason = line.choice("reason", reasons);
    a.body = line.text();
    if (line.next_is_empty())
        (void)line.text();
    else
        a.node = line.number<Index>("node", "a whole number >= 0, or nothing", count);
    a.value = line.number<double>("value", "a number", any); // of a solve that failed it may be nan
    a.lambda = line.number<double>("lambda", "a number", any);
    a.iterations = line.number<Index>("iterations", "a whole number >= 0", count);
    return a;
}

[[noreturn]] void refuse(const fs::path& where, int line, const std::string& expected, const std::string& found) {
    throw SceneError({{where.string(), line, 1, "", expected, found, ""}});
}

/// @param cut_off  whether a last line without its end is left out; otherwise it is a fault
std::vector<Attempt> read_steps(const fs::path& folder, bool cut_off) {
    if (!fs::is_directory(folder))
        refuse(folder, 0, "the folder of a run", fs::exists(folder) ? "a file" : "nothing of that name");
    const fs::path path = folder / "steps.csv";
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        refuse(folder, 0, "the folder of a run, which holds steps.csv",
               fs::exists(path) ? "one that cannot be read" : "none in it");

    const std::string file = path.string();
    std::vector<Attempt> attempts;
    std::vector<Fault> faults;
    std::string text;
    int number = 0;
    while (std::getline(stream, text)) {
        ++number;
        if (stream.eof() && cut_off) break;
        if (stream.eof())
            refuse(path, number, "a line end", "'" + text + "', where the file stops: it has been cut off");
        if (text.ends_with('\r')) text.pop_back(); // saved by a spreadsheet
        if (number == 1) {
            if (text != head_of_diary) refuse(path, 1, "the column names " + head_of_diary, "'" + text + "'");
            continue;
        }
        LineReader line(file, number, text);
        attempts.push_back(read_attempt(line));
        faults.insert(faults.end(), line.faults().begin(), line.faults().end());
    }
    if (number == 0 && !cut_off) refuse(path, 1, "the column names " + head_of_diary, "an empty file");
    if (!faults.empty()) throw SceneError(faults);
    return attempts;
}

using Row = std::vector<std::string>;

/// Columns as wide as their widest cell, numbers to the right.
/// @param left  columns of words
std::string table(const std::vector<Row>& rows, const std::vector<std::size_t>& left) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const bool words = std::ranges::count(left, c) > 0;
            line += (c > 0 ? "  " : "") +
                    (words ? fmt::format("{:<{}}", row[c], widths[c]) : fmt::format("{:>{}}", row[c], widths[c]));
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
    return text;
}

std::string brief(double value) {
    return fmt::format("{:.6g}", value);
}

std::string where(const Attempt& a) {
    if (a.node < 0) return a.body.empty() ? "-" : fmt::format("body '{}'", a.body);
    return fmt::format("node {} of body '{}'", a.node, a.body);
}

std::string attempts_table(const std::vector<Attempt>& attempts) {
    std::vector<Row> rows{{"attempt", "time", "dt", "verdict", "reason", "where", "value", "lambda", "iterations"}};
    for (const Attempt& a : attempts)
        rows.push_back({std::to_string(a.attempt), fmt::format("{:.9g}", a.time), brief(a.dt), name(a.verdict),
                        a.reason == Reason::none ? "-" : name(a.reason), where(a), fmt::format("{:.3g}", a.value),
                        fmt::format("{:.3g}", a.lambda), std::to_string(a.iterations)});
    return table(rows, {3, 4, 5});
}

std::string percentage(long part, long whole) {
    return whole > 0 ? fmt::format(" ({:.0f} %)", 100. * static_cast<double>(part) / static_cast<double>(whole)) : "";
}

/// What the rejections for one reason have in common.
struct Rejections {
    long attempts = 0, iterations = 0;
    const Attempt* smallest = nullptr; ///< the first of those with the smallest dt
    std::map<std::string, long> places;

    void add(const Attempt& a) {
        ++attempts;
        iterations += a.iterations;
        if (smallest == nullptr || a.dt < smallest->dt) smallest = &a;
        ++places[where(a)];
    }
    [[nodiscard]] std::string most_often() const {
        const auto most = std::ranges::max_element(places, {}, [](const auto& place) { return place.second; });
        return most->first == "-" ? "-" : fmt::format("{} ({} of {})", most->first, most->second, attempts);
    }
};

std::string rejections_table(const std::vector<Attempt>& attempts) {
    std::map<Reason, Rejections> by_reason;
    for (const Attempt& a : attempts)
        if (a.verdict != Verdict::accept) by_reason[a.reason].add(a);
    if (by_reason.empty()) return "no attempt was rejected\n";
    std::vector<Row> rows{{"rejected for", "attempts", "iterations lost", "smallest dt", "to time", "most often at"}};
    for (const auto& [reason, all] : by_reason)
        rows.push_back({name(reason), std::to_string(all.attempts), std::to_string(all.iterations),
                        brief(all.smallest->dt), fmt::format("{:.9g}", all.smallest->time), all.most_often()});
    return table(rows, {0, 5});
}

std::string totals(const std::vector<Attempt>& attempts) {
    long accepted = 0, iterations = 0, lost = 0;
    double end = 0, smallest = 0, largest = 0;
    for (const Attempt& a : attempts) {
        iterations += a.iterations;
        if (a.verdict != Verdict::accept) {
            lost += a.iterations;
            continue;
        }
        smallest = accepted == 0 ? a.dt : std::min(smallest, a.dt);
        largest = std::max(largest, a.dt);
        end = a.time;
        ++accepted;
    }
    const long all = static_cast<long>(attempts.size());
    std::string text =
        fmt::format("attempts: {}, accepted {}, rejected {}; iterations: {}, lost in rejected attempts {}{}\n", all,
                    accepted, all - accepted, iterations, lost, percentage(lost, iterations));
    if (accepted > 0)
        text +=
            fmt::format("accepted up to {:.9g} s, in steps of {} s to {} s\n", end, brief(smallest), brief(largest));
    if (const Attempt& last = attempts.back(); last.verdict == Verdict::give_up)
        text += fmt::format("gave up on the step of {} s to {:.9g} s, for {}{}\n", brief(last.dt), last.time,
                            name(last.reason), where(last) == "-" ? "" : " at " + where(last));
    return text;
}

/// What post_mortem.json says; nothing where there is none.
std::string post_mortem(const fs::path& folder) {
    const fs::path path = folder / output::post_mortem_file;
    if (!fs::exists(path)) return "";
    try {
        return '\n' + output::in_words(output::read_post_mortem(path));
    } catch (const std::runtime_error& error) {
        refuse(path, 0, "the post-mortem of a run", error.what());
    }
}

} // namespace

std::string diary(const fs::path& folder) {
    const WithoutTraps nan; // values of failed solves may have to be printed
    const std::vector<Attempt> attempts = read_steps(folder, false);
    const std::string end = post_mortem(folder);
    if (attempts.empty()) return end.empty() ? "no attempt yet\n" : "no attempt was made\n" + end;
    return attempts_table(attempts) + '\n' + totals(attempts) + rejections_table(attempts) + end;
}

std::vector<Attempt> attempts_so_far(const fs::path& folder) {
    return read_steps(folder, true);
}

std::string summary_of(const std::vector<Attempt>& attempts) {
    return attempts.empty() ? "no attempt yet\n" : totals(attempts) + rejections_table(attempts);
}

} // namespace osculate::app
