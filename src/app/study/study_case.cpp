#include "app/study/study_case.hpp"

#include "app/study/run_folder.hpp"
#include "osculate/app/version.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/output/csv_reader.hpp"
#include "osculate/output/frame_reader.hpp"
#include "osculate/output/output_folder.hpp"
#include "osculate/scene/writer.hpp"
#include "osculate/study/formulas.hpp"
#include "osculate/study/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace osculate::app {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// FNV-1a, 64 bits: tells apart what changed, not what was forged.
std::string hash_of(const std::string& text) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const unsigned char c : text) hash = (hash ^ c) * 1099511628211ull;
    return fmt::format("{:016x}", hash);
}

std::string hash_of(const scene::Scene& scene) {
    std::string text = std::string(version) + "\n" + scene::write_scene(scene);
    for (const auto& [name, body] : scene.bodies) {
        if (const auto* file = std::get_if<scene::FileMesh>(&body.mesh.source)) text += file_content(file->path);
        if (const auto* cad = std::get_if<scene::CadMesh>(&body.mesh.source)) text += file_content(cad->path);
    }
    return hash_of(text);
}

/// Last line of what a run said.
std::string last_words(const fs::path& messages) {
    std::istringstream text(file_content(messages));
    std::string line, last;
    while (std::getline(text, line))
        if (!line.empty()) last = line;
    return last;
}

std::optional<int> exit_code(const fs::path& folder) {
    std::ifstream file(folder / exit_code_file);
    int code = 0;
    if (file >> code) return code;
    return std::nullopt;
}

Json read_json(const fs::path& path) {
    return Json::parse(file_content(path), nullptr, false); // `discarded` where it is none
}

void read_checks(StudyRecord& record, const Json& json) {
    const auto checks = json.find("checks");
    for (std::size_t k = 0; k < study_checks.size() && checks != json.end(); ++k)
        if (const auto at = checks->find(study_checks[k]); at != checks->end()) record.checks[k] = *at;
}

std::string read_expectation(const Json& summary) {
    const auto expectation = summary.find("expectation");
    if (expectation == summary.end()) return "none";
    if (expectation->at("met")) return "met";
    std::string words;
    for (const std::string miss : expectation->at("misses")) words += (words.empty() ? "missed: " : "; ") + miss;
    return words;
}

StudyRecord read_record(const fs::path& folder) {
    StudyRecord record;
    const Json json = read_json(folder / record_file);
    if (!json.is_object()) return record;
    try {
        record.hash = json.at("hash");
        record.status = json.at("status");
        record.reason = json.at("reason");
        record.dofs = json.at("dofs");
        record.accepted = json.at("accepted");
        record.rejected = json.at("rejected");
        record.iterations = json.at("iterations");
        record.same = json.at("same");
        read_checks(record, json);
        record.expectation = json.value("expectation", record.expectation); // records of old have neither
        for (const Json& item : json.at("repeats")) {
            StudyRepeat repeat{item.at("cpu"), item.at("wall"), item.at("memory"), {}};
            for (std::size_t p = 0; p < study_parts.size(); ++p) repeat.parts[p] = item.at(study_parts[p]);
            record.repeats.push_back(repeat);
        }
    } catch (const Json::exception&) {
        return {};
    }
    return record;
}

/// Columns of `names` out of those of a file; one that is missing is NaN.
void fill(scene::Rows& rows, const std::vector<std::string>& names, const scene::Rows& all) {
    rows.names = names;
    for (const std::string& name : names) {
        const auto at = std::ranges::find(all.names, name);
        rows.columns.push_back(at == all.names.end() ? std::vector<double>(all.size(), nan)
                                                     : all.columns[static_cast<std::size_t>(at - all.names.begin())]);
    }
}

const std::vector<double>& column(const scene::Rows& rows, const std::string& name) {
    const auto at = std::ranges::find(rows.names, name);
    return rows.columns.at(static_cast<std::size_t>(at - rows.names.begin()));
}

scene::Rows history_rows(const fs::path& folder) {
    output::NumberTable table = output::read_numbers(folder / "history.csv");
    for (std::string& name : table.names) std::ranges::replace(name, '-', '_');
    return {std::move(table.names), std::move(table.columns)};
}

scene::Rows frame_rows(const fs::path& folder, const std::string& part) {
    const auto path = output::last_frame(folder, part);
    if (!path) throw std::runtime_error("no frame of " + part + " in " + folder.string());
    const output::Frame frame = output::read_frame(*path);
    scene::Rows rows;
    const auto add = [&](const std::string& name, auto&& value) {
        rows.names.push_back(name);
        std::vector<double>& values = rows.columns.emplace_back();
        for (std::size_t i = 0; i < frame.points.size(); ++i) values.push_back(value(i));
    };
    const auto array = [&](const char* name, const std::vector<std::string>& components) {
        const output::Array* a = frame.find(name);
        if (a == nullptr) return;
        for (std::size_t c = 0; c < components.size(); ++c)
            add(components[c], [&](std::size_t i) { return a->values[i * components.size() + c]; });
    };
    for (int k = 0; k < 3; ++k) add(std::string(1, "XYZ"[k]), [&](std::size_t i) { return frame.points[i][k]; });
    array("displacement", {"ux", "uy", "uz"});
    for (std::size_t k = 0; k < 3; ++k)
        add(std::string(1, "xyz"[k]), [&](std::size_t i) { return rows.columns[k][i] + rows.columns[3 + k][i]; });
    array("gap", {"gap"});
    array("contact_force", {"force_x", "force_y", "force_z"});
    array("normal_stress", {"normal_stress"});
    array("slip", {"slip_x", "slip_y", "slip_z"});
    array("status", {"status"});
    array("normal", {"normal_x", "normal_y", "normal_z"});
    array("area", {"area"});
    array("stress", {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_zx"});
    array("von_mises", {"von_mises"});
    array("reaction", {"reaction_x", "reaction_y", "reaction_z"});
    add("time", [&](std::size_t) { return frame.time; });
    return rows;
}

QuantityResult measure(const scene::StudyQuantity& q, const StudyCase& c) {
    study::QuantityRows rows;
    scene::Rows all;
    if (q.source == scene::RowSource::contact) all = frame_rows(c.folder, q.part + ".slave");
    if (q.source == scene::RowSource::body) all = frame_rows(c.folder, q.part);
    if (q.source == scene::RowSource::history) {
        all = history_rows(c.folder);
        rows.weights = column(all, "dt");
    }
    if (q.area) rows.weights = column(all, "area");
    fill(rows.rows, scene::visible_columns(q, c.scene, c.numbers.names), all);
    const study::Measured measured = study::measure(q, rows, c.numbers, study_functions());
    return {measured.value, nan, nan, measured.is_error};
}

/// The case with most degrees of freedom, then steps, among those that differ from `c` along the refined axis only.
const StudyCase* finest(const scene::Study& study, const std::vector<StudyCase>& cases, const StudyCase& c) {
    const StudyCase* best = nullptr;
    for (const StudyCase& other : cases) {
        if (other.record.status != "done") continue;
        bool same = true;
        for (std::size_t a = 0; a < study.axes.size(); ++a)
            same = same && (static_cast<int>(a) == study.refine || other.combination[a] == c.combination[a]);
        if (!same) continue;
        const auto size = [](const StudyCase& x) { return std::pair(x.record.dofs, x.record.accepted); };
        if (best == nullptr || size(other) > size(*best)) best = &other;
    }
    return best;
}

} // namespace

double StudyRecord::median(double StudyRepeat::*value) const {
    std::vector<double> values;
    for (const StudyRepeat& repeat : repeats) values.push_back(repeat.*value);
    return values.empty() ? nan : study::median(std::move(values));
}

double StudyRecord::median_part(std::size_t part) const {
    std::vector<double> values;
    for (const StudyRepeat& repeat : repeats) values.push_back(repeat.parts[part]);
    return values.empty() ? nan : study::median(std::move(values));
}

std::vector<double> StudyRecord::numbers() const {
    std::vector<double> values{dofs, accepted, rejected, iterations};
    for (const auto value : {&StudyRepeat::cpu, &StudyRepeat::wall, &StudyRepeat::memory})
        values.push_back(median(value));
    values.insert(values.end(), checks.begin(), checks.end());
    return values;
}

const scene::NamedFunctions& study_functions() {
    static const scene::NamedFunctions functions = [] {
        scene::NamedFunctions list;
        for (const study::NamedSolution& f : study::formulas()) list.push_back({f.name, f.count, f.value});
        return list;
    }();
    return functions;
}

std::vector<StudyCase> make_cases(const scene::Study& study, const fs::path& folder,
                                  const std::vector<scene::Override>& command_line) {
    std::vector<StudyCase> cases;
    for (const scene::Combination& combination : study.combinations()) {
        StudyCase c{combination, study.id(combination), study.scene_of(combination), {}, {}, {}, {}, {}, {}};
        c.folder = folder / "runs" / c.id;
        c.overrides = study.overrides_of(combination, command_line);
        c.scene = scene::read_scene(c.scene_path, c.overrides);
        const std::string hash = hash_of(c.scene);
        c.record = read_record(c.folder);
        if (c.record.hash != hash || (!c.record.finished() && !c.record.status.empty())) c.record = {};
        // a run that ended as the study itself was killed
        if (c.record.hash == hash && c.record.status.empty() && !add_repeat(c.record, c.folder))
            if (const auto code = exit_code(c.folder)) add_failure(c.record, c.folder, *code);
        c.record.hash = hash;
        cases.push_back(std::move(c));
    }
    return cases;
}

void write_record(const StudyCase& c) {
    const StudyRecord& r = c.record;
    Json repeats = Json::array();
    for (const StudyRepeat& repeat : r.repeats) {
        Json item{{"cpu", repeat.cpu}, {"wall", repeat.wall}, {"memory", repeat.memory}};
        for (std::size_t p = 0; p < study_parts.size(); ++p) item[study_parts[p]] = repeat.parts[p];
        repeats.push_back(item);
    }
    Json checks = Json::object();
    for (std::size_t k = 0; k < study_checks.size(); ++k)
        if (!std::isnan(r.checks[k])) checks[study_checks[k]] = r.checks[k];
    const Json json{
        {"hash", r.hash},         {"status", r.status},           {"reason", r.reason},         {"dofs", r.dofs},
        {"accepted", r.accepted}, {"rejected", r.rejected},       {"iterations", r.iterations}, {"same", r.same},
        {"checks", checks},       {"expectation", r.expectation}, {"repeats", repeats}};
    fs::create_directories(c.folder);
    const fs::path path = c.folder / record_file, part = c.folder / (std::string(record_file) + ".part");
    {
        std::ofstream file(part, std::ios::binary);
        file << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
        if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
    }
    fs::rename(part, path);
}

bool add_repeat(StudyRecord& record, const fs::path& folder) {
    const Json json = read_json(folder / "summary.json");
    if (!json.is_object()) return false;
    try {
        const std::string status = json.at("status");
        if (status != "done" && status != "gave_up") return false;
        record.status = status;
        record.reason = json.value("failure", "");
        record.dofs = json.at("dofs");
        record.accepted = json.at("steps").at("accepted");
        record.rejected = json.at("steps").at("rejected");
        record.iterations = json.at("iterations");
        read_checks(record, json);
        record.expectation = read_expectation(json);
        const Json& seconds = json.at("seconds");
        StudyRepeat repeat{seconds.at("cpu"), seconds.at("total"), json.at("peak_memory_bytes"), {}};
        for (std::size_t p = 0; p < study_parts.size(); ++p) repeat.parts[p] = seconds.at(study_parts[p]);
        record.repeats.push_back(repeat);
    } catch (const Json::exception&) {
        return false;
    }
    return true;
}

void add_failure(StudyRecord& record, const fs::path& folder, int code, int signal) {
    const std::string words = last_words(folder / messages_file);
    record.status = code == 3 ? "gave_up" : code == 2 ? "refused" : "bug";
    record.reason = words;
    if (signal != 0)
        record.reason = fmt::format("killed by signal {}", signal);
    else if (record.status == "bug")
        record.reason = fmt::format("exit code {}: {}", code, words);
}

void announce(const StudyCase& c, bool force) {
    // that of a run which may be going on is left alone
    if (read_record(c.folder).hash != c.record.hash || !output::OutputFolder::has_manifest(c.folder))
        make_run_folder(c.folder, force);
    if (!c.record.finished()) write_record(c);
}

void measure(const scene::Study& study, std::vector<StudyCase>& cases) {
    for (StudyCase& c : cases) {
        const StudyRecord& r = c.record;
        const bool known = r.finished();
        c.numbers = scene::numbers_of(study, c.combination, study_functions(),
                                      known ? r.numbers() : std::vector<double>(scene::run_numbers().size(), nan));
        if (!known || !c.results.empty()) continue;
        for (const scene::StudyQuantity& q : study.quantities) {
            // files of a run that gave up end before their time
            const bool whole = r.status == "done" || q.source == scene::RowSource::summary;
            try {
                c.results.push_back(whole ? measure(q, c) : QuantityResult{});
            } catch (const std::runtime_error& error) { // files that someone took away
                c.results.emplace_back();
                c.record.reason = error.what();
            }
        }
    }
    for (StudyCase& c : cases) {
        if (!c.completed()) continue;
        for (std::size_t k = 0; k < c.results.size(); ++k) {
            const scene::StudyQuantity& q = study.quantities[k];
            QuantityResult& result = c.results[k];
            if (result.is_error) {
                result.error = result.value;
            } else if (q.finest()) {
                const StudyCase* best = finest(study, cases, c);
                result.reference = best ? best->results[k].value : nan;
                result.error = best == &c ? nan : study::error_of(q, result.value, result.reference);
            } else if (!q.reference.empty()) {
                result.reference = study::evaluate(q.reference, c.numbers, study_functions());
                result.error = study::error_of(q, result.value, result.reference);
            }
        }
    }
}

} // namespace osculate::app
