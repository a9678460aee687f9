#include "osculate/output/checkpoint_file.hpp"

#include "osculate/core/file_content.hpp"
#include "output/checkpoint_memory.hpp"
#include "output/files.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <fmt/format.h>
#include <stdexcept>

namespace osculate::output {

namespace {

constexpr std::string_view format = "osculate checkpoint 1\n";
constexpr std::size_t checksum_length = 17; // 16 digits and a line's end

std::uint64_t checksum(std::string_view bytes) { // CRC-64/XZ
    constexpr std::uint64_t all = ~std::uint64_t{0};
    boost::crc_optimal<64, 0x42F0E1EBA9EA3693ULL, all, all, true, true> crc;
    crc.process_bytes(bytes.data(), bytes.size());
    return crc.checksum();
}

// ---- parts ------------------------------------------------------------------------------------------------------------------

Json to_json(const std::vector<contact::RefittedPatch>& patches) {
    std::vector<Index> number;
    Ragged<Vec3> at;
    for (const contact::RefittedPatch& patch : patches) {
        number.push_back(patch.patch);
        at.add(patch.at);
    }
    return {{"patch", packed(number)}, {"count", packed(at.length)}, {"at", packed_matrices(at.value)}};
}

std::vector<contact::RefittedPatch> refitted_patches(const Json& json) {
    const auto number = unpacked<Index>(json, "patch");
    const auto at = Ragged<Vec3>{unpacked<Index>(json, "count"), unpacked_matrices<Vec3>(json, "at")}.lists("patches");
    if (number.size() != at.size()) incomplete("patches");
    std::vector<contact::RefittedPatch> patches;
    for (std::size_t i = 0; i < at.size(); ++i) patches.push_back({number[i], at[i]});
    return patches;
}

constexpr double time::Ledger::*ledger_numbers[] = {
    &time::Ledger::kinetic,   &time::Ledger::strain,      &time::Ledger::external, &time::Ledger::friction,
    &time::Ledger::damping,   &time::Ledger::algorithmic, &time::Ledger::contact,  &time::Ledger::balance,
    &time::Ledger::interface, &time::Ledger::settling};

Json to_json(const time::Ledger& ledger) {
    std::vector<double> values;
    for (const auto value : ledger_numbers) values.push_back(ledger.*value);
    return {{"values", packed(values)}, {"momenta", packed_matrices(std::vector<Vec3>{ledger.linear, ledger.angular})}};
}

time::Ledger ledger(const Json& json) {
    time::Ledger ledger;
    const auto values = unpacked<double>(json, "values");
    const auto momenta = unpacked_matrices<Vec3>(json, "momenta");
    if (values.size() != std::size(ledger_numbers) || momenta.size() != 2) incomplete("ledger");
    for (std::size_t i = 0; i < values.size(); ++i) ledger.*ledger_numbers[i] = values[i];
    ledger.linear = momenta[0];
    ledger.angular = momenta[1];
    return ledger;
}

// ---- every value once, with its name --------------------------------------------------------------------------------------

/// visit(name, value) of all that a pair carries on, whether it writes or reads.
template <class History, class Visit>
void each_value(History& history,
                const Visit& visit) requires std::is_same_v<std::remove_const_t<History>, model::ContactHistory> {
    visit("lambda", history.lambda);
    visit("status", history.status);
    visit("slides", history.slides);
    visit("facet", history.facet); // the master is made from the patches
}

/// Calls visit(values, count) for every array of numbers of a rigid body's motion.
template <class Motion, class Visit> void each_array(Motion& motion, const Visit& visit) {
    visit(motion.orientation.coeffs().data(), 4);
    for (auto* value : {&motion.rotation, &motion.velocity, &motion.acceleration, &motion.angular_velocity,
                        &motion.angular_rate, &motion.moment})
        visit(value->data(), 3);
}
constexpr std::size_t motion_size = 4 + 6 * 3;

template <class Pair, class Visit>
void each_value(Pair& pair, const Visit& visit) requires std::is_same_v<std::remove_const_t<Pair>, time::FoundPair> {
    visit("slave", pair.slave);
    visit("master", pair.master);
    visit("nodes", pair.nodes);
    visit("facets", pair.facets);
    visit("yielding", pair.yielding);
    visit("edges", pair.edges);
}

template <class Run, class Visit>
void each_value(Run& run, const Visit& visit) requires std::is_same_v<std::remove_const_t<Run>, time::Checkpoint> {
    visit("stage", run.stage);
    visit("stage_start", run.stage_start);
    visit("displacement_start", run.displacement_start);
    visit("reached", run.reached);
    visit("dt", run.dt);
    visit("impact", run.impact);
    visit("time", run.state.time);
    visit("u", run.state.u);
    visit("v", run.state.v);
    visit("a", run.state.a);
    visit("contact", run.state.contact);
    visit("material", run.state.material);
    visit("rigid", run.state.rigid);
    visit("ledger", run.ledger);
    visit("moved", run.moved);
    visit("attempts", run.counts.attempts);
    visit("stabilised_steps", run.counts.stabilised_steps);
    visit("steps_at_round_off", run.counts.steps_at_round_off);
    visit("held_geometry_steps", run.counts.held_geometry_steps);
    visit("factorisations", run.counts.factorisations);
    visit("gmres_iterations", run.counts.gmres_iterations);
    visit("refreshed_patches", run.counts.refreshed_patches);
    visit("paths_followed", run.counts.paths_followed);
    visit("memory", run.memory);
    visit("patches", run.patches);
    visit("found", run.found);
    visit("scope_x", run.scope_x);
    visit("scope_margin", run.scope_margin);
    visit("scope_own", run.scope_own);
    visit("watched", run.watched);
}

struct Writer {
    Json& json;

    void operator()(const char* name, const Field& value) const { json[name] = packed_matrices(value.values()); }
    void operator()(const char* name, const std::vector<Vec3>& value) const { json[name] = packed_matrices(value); }
    void operator()(const char* name, const std::vector<double>& value) const {
        if (!value.empty()) json[name] = packed(value);
    }
    void operator()(const char* name, const std::vector<char>& value) const {
        if (!value.empty()) json[name] = packed(value);
    }
    void operator()(const char* name, const std::vector<contact::Status>& value) const { json[name] = packed(value); }
    void operator()(const char* name, const std::vector<Index>& value) const { json[name] = packed(value); }
    void operator()(const char* name, const std::vector<model::ContactHistory>& pairs) const {
        json[name] = Json::array();
        for (const model::ContactHistory& history : pairs) {
            Json one;
            each_value(history, Writer{one});
            json[name].push_back(std::move(one));
        }
    }
    void operator()(const char* name, const std::vector<time::FoundPair>& pairs) const {
        json[name] = Json::array();
        for (const time::FoundPair& pair : pairs) {
            Json one;
            each_value(pair, Writer{one});
            json[name].push_back(std::move(one));
        }
    }
    void operator()(const char* name, const std::vector<model::RigidMotion>& motions) const {
        std::vector<double> flat;
        for (const model::RigidMotion& motion : motions)
            each_array(motion,
                       [&](const double* values, int count) { flat.insert(flat.end(), values, values + count); });
        (*this)(name, flat);
    }
    void operator()(const char* name, const std::vector<std::vector<contact::RefittedPatch>>& pairs) const {
        json[name] = Json::array();
        for (const auto& patches : pairs) json[name].push_back(to_json(patches));
    }
    void operator()(const char* name, const time::Ledger& value) const { json[name] = to_json(value); }
    void operator()(const char* name, const equilibrium::EquilibriumMemory& value) const {
        json[name] = output::to_json(value);
    }
    template <class T>
    requires std::is_arithmetic_v<T>
    void operator()(const char* name, const T& value) const { json[name] = value; }
};

struct Reader {
    const Json& json;

    void operator()(const char* name, Field& value) const { value = unpacked_matrices<Vec3>(json, name); }
    void operator()(const char* name, std::vector<Vec3>& value) const { value = unpacked_matrices<Vec3>(json, name); }
    void operator()(const char* name, std::vector<double>& value) const { // left out where there is nothing
        if (json.contains(name)) value = unpacked<double>(json, name);
    }
    void operator()(const char* name, std::vector<char>& value) const {
        if (json.contains(name)) value = unpacked<char>(json, name);
    }
    void operator()(const char* name, std::vector<contact::Status>& value) const {
        value = unpacked<contact::Status>(json, name);
    }
    void operator()(const char* name, std::vector<Index>& value) const { value = unpacked<Index>(json, name); }
    void operator()(const char* name, std::vector<model::ContactHistory>& pairs) const {
        for (const Json& one : member(json, name)) each_value(pairs.emplace_back(), Reader{one});
    }
    void operator()(const char* name, std::vector<time::FoundPair>& pairs) const {
        for (const Json& one : member(json, name)) each_value(pairs.emplace_back(), Reader{one});
    }
    void operator()(const char* name, std::vector<model::RigidMotion>& motions) const {
        std::vector<double> flat;
        (*this)(name, flat);
        if (flat.size() % motion_size != 0) incomplete(name);
        motions.resize(flat.size() / motion_size);
        const double* from = flat.data();
        for (model::RigidMotion& motion : motions)
            each_array(motion, [&](double* values, int count) {
                std::copy_n(from, count, values);
                from += count;
            });
    }
    void operator()(const char* name, std::vector<std::vector<contact::RefittedPatch>>& pairs) const {
        for (const Json& one : member(json, name)) pairs.push_back(refitted_patches(one));
    }
    void operator()(const char* name, time::Ledger& value) const { value = ledger(member(json, name)); }
    void operator()(const char* name, equilibrium::EquilibriumMemory& value) const {
        value = equilibrium_memory(member(json, name));
    }
    void operator()(const char* name, bool& value) const {
        if (!member(json, name).is_boolean()) incomplete(name);
        value = json[name].get<bool>();
    }
    template <class T>
    requires std::is_arithmetic_v<T>
    void operator()(const char* name, T& value) const { value = number<T>(json, name); }
};

Json to_json(const time::Checkpoint& run) {
    Json json;
    each_value(run, Writer{json});
    return json;
}

time::Checkpoint checkpoint(const Json& json) {
    time::Checkpoint run;
    each_value(run, Reader{json});
    return run;
}

/// Ends the reading of CBOR that is nested deeper than any checkpoint: its reader calls itself once a level.
struct DepthCheck : nlohmann::json_sax<Json> {
    static constexpr int deepest = 8;
    int depth = 0;
    bool deeper() { return ++depth <= deepest; }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return deeper(); }
    bool key(string_t&) override { return true; }
    bool end_object() override { return --depth >= 0; }
    bool start_array(std::size_t) override { return deeper(); }
    bool end_array() override { return --depth >= 0; }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }
};

Json read_cbor(std::string_view bytes) {
    DepthCheck check;
    Json json = Json::value_t::discarded;
    if (Json::sax_parse(bytes.begin(), bytes.end(), &check, Json::input_format_t::cbor))
        json = Json::from_cbor(bytes.begin(), bytes.end(), true, false);
    if (!json.is_object()) throw std::runtime_error("it is damaged");
    return json;
}

} // namespace

std::uint64_t fingerprint(const model::Model& model) {
    boost::crc_optimal<64, 0x42F0E1EBA9EA3693ULL, 0, 0, true, true> crc;
    for (const Vec3& X : model.X) crc.process_bytes(X.data(), 3 * sizeof(double));
    for (const model::Body& body : model.bodies)
        for (const mesh::ElementBlock& block : body.mesh.blocks)
            crc.process_bytes(block.connectivity.data(), block.connectivity.size() * sizeof(Index));
    return crc.checksum();
}

std::string encode(const CheckpointFile& file) {
    Json frames = Json::array(), tables = Json::array();
    for (const SeriesEntry& entry : file.frames) frames.push_back({entry.time, entry.part, entry.file});
    for (const auto& [path, bytes] : file.tables) tables.push_back({path, bytes});
    const Json json{{"version", file.version},
                    {"scene", file.scene},
                    {"meshes", file.meshes},
                    {"run", to_json(file.run)},
                    {"frames", frames},
                    {"tables", tables},
                    {"accepted", file.steps.accepted},
                    {"rejected", file.steps.rejected},
                    {"iterations", file.iterations},
                    {"total_seconds", file.total_seconds},
                    {"cpu_seconds", file.cpu_seconds},
                    {"seconds", packed(file.seconds)},
                    {"checks", packed(file.checks)}};
    std::string body;
    Json::to_cbor(json, body);
    return sealed(body);
}

std::string sealed(std::string_view cbor) {
    return fmt::format("{}{:016x}\n", format, checksum(cbor)).append(cbor);
}

CheckpointFile decode(std::string_view bytes) {
    const std::string_view name = format.substr(0, format.find_last_of(' ') + 1);
    if (!bytes.starts_with(name)) throw std::runtime_error("it is not a checkpoint of osculate");
    if (!bytes.starts_with(format)) throw std::runtime_error("it is of another format, by another version of osculate");
    bytes.remove_prefix(format.size());
    if (bytes.size() < checksum_length) throw std::runtime_error("it is cut off");
    const std::string_view sum = bytes.substr(0, checksum_length);
    bytes.remove_prefix(checksum_length);
    if (sum != fmt::format("{:016x}\n", checksum(bytes)))
        throw std::runtime_error("it is damaged: its checksum does not fit");
    const Json json = read_cbor(bytes);
    CheckpointFile file;
    file.version = text(json, "version");
    file.scene = text(json, "scene");
    file.meshes = number<std::uint64_t>(json, "meshes");
    file.run = checkpoint(member(json, "run"));
    for (const Json& entry : member(json, "frames")) {
        if (!entry.is_array() || entry.size() != 3 || !entry[0].is_number() || !entry[1].is_string() ||
            !entry[2].is_string())
            incomplete("frames");
        file.frames.push_back({entry[0].get<double>(), entry[1].get<std::string>(), entry[2].get<std::string>()});
    }
    for (const Json& entry : member(json, "tables")) {
        if (!entry.is_array() || entry.size() != 2 || !entry[0].is_string() || !entry[1].is_number_unsigned())
            incomplete("tables");
        file.tables.emplace_back(entry[0].get<std::string>(), entry[1].get<std::uintmax_t>());
    }
    file.steps.accepted = number<long>(json, "accepted");
    file.steps.rejected = number<long>(json, "rejected");
    file.iterations = number<long>(json, "iterations");
    file.total_seconds = number<double>(json, "total_seconds");
    file.cpu_seconds = number<double>(json, "cpu_seconds");
    file.seconds = unpacked<double>(json, "seconds");
    file.checks = unpacked<double>(json, "checks");
    return file;
}

void write_checkpoint(const std::filesystem::path& path, const CheckpointFile& checkpoint) {
    const std::string content = encode(checkpoint);
    std::filesystem::path previous = path;
    previous += ".previous";
    std::error_code none;
    // a second name for the one of before, so that there is a whole one at any moment
    std::filesystem::remove(previous, none);
    std::filesystem::create_hard_link(path, previous, none);
    write_atomic(path, content, true);
}

CheckpointFile read_checkpoint(const std::filesystem::path& path) {
    std::error_code failed;
    const std::string bytes = file_content(path, failed);
    if (failed) throw std::runtime_error("cannot read " + path.string() + ": " + failed.message());
    try {
        return decode(bytes);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("cannot go on from " + path.string() + ": " + error.what());
    }
}

} // namespace osculate::output
