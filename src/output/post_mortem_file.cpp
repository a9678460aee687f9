#include "osculate/output/post_mortem_file.hpp"

#include "output/json_file.hpp"

#include <fstream>
#include <limits>
#include <stdexcept>

namespace osculate::output {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson written(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

double real(const OrderedJson& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Vec3 vector(const OrderedJson& json) {
    return {real(json.at(0)), real(json.at(1)), real(json.at(2))};
}

/// Enumerations by name.
template <class Value> Value known(const std::optional<Value>& value, const OrderedJson& json) {
    if (!value) throw std::runtime_error("'" + json.get<std::string>() + "' is not known");
    return *value;
}

template <class Value, std::size_t n> Value one_of(const Value (&values)[n], const OrderedJson& json) {
    for (const Value value : values)
        if (name(value) == json.get<std::string>()) return value;
    return known(std::optional<Value>(), json);
}

constexpr time::Verdict verdicts[] = {time::Verdict::accept, time::Verdict::retry, time::Verdict::give_up};

OrderedJson written(const time::Attempt& a) {
    return {{"attempt", a.attempt},
            {"time", a.time},
            {"dt", a.dt},
            {"verdict", name(a.verdict)},
            {"reason", name(a.reason)},
            {"body", a.body},
            {"node", a.node},
            {"value", a.value},
            {"lambda", a.lambda},
            {"iterations", a.iterations},
            {"cause", a.cause}};
}

time::Attempt attempt(const OrderedJson& j) {
    time::Attempt a;
    a.attempt = j.at("attempt");
    a.time = real(j.at("time"));
    a.dt = real(j.at("dt"));
    a.verdict = one_of(verdicts, j.at("verdict"));
    a.reason = one_of(time::reasons, j.at("reason"));
    a.body = j.at("body");
    a.node = j.at("node");
    a.value = real(j.at("value"));
    a.lambda = real(j.at("lambda"));
    a.iterations = j.at("iterations");
    a.cause = j.at("cause");
    return a;
}

OrderedJson written(const equilibrium::IterationRecord& i) {
    return {
        {"iteration", i.iteration}, {"residual", i.residual}, {"status_changes", i.status_changes}, {"open", i.open},
        {"stick", i.stick},         {"slip", i.slip},         {"facet_changes", i.facet_changes}};
}

equilibrium::IterationRecord iteration(const OrderedJson& j) {
    return {j.at("iteration"), real(j.at("residual")), j.at("status_changes"), j.at("open"),
            j.at("stick"),     j.at("slip"),           j.at("facet_changes")};
}

OrderedJson written(const time::StatusChanges& c) {
    OrderedJson sequence = OrderedJson::array();
    for (const contact::Status status : c.sequence) sequence.push_back(time::name(status));
    return {{"pair", c.pair}, {"body", c.body}, {"node", c.node}, {"statuses", sequence}};
}

time::StatusChanges changes(const OrderedJson& j) {
    time::StatusChanges c{j.at("pair"), j.at("body"), j.at("node"), {}};
    for (const OrderedJson& status : j.at("statuses")) c.sequence.push_back(known(time::status_of(status), status));
    return c;
}

OrderedJson written(const time::BodyHold& b) {
    return {{"body", b.body},
            {"free_by_supports", b.free_by_supports},
            {"free_with_contact", b.free_with_contact},
            {"free_motions", b.free_motions},
            {"in_pair", b.in_pair},
            {"touching", b.touching},
            {"pressed", b.pressed},
            {"touched", b.touched},
            {"nearest_pair", b.nearest_pair},
            {"nearest_gap", b.nearest_gap},
            {"facet", b.facet}};
}

time::BodyHold hold(const OrderedJson& j) {
    time::BodyHold b;
    b.body = j.at("body");
    b.free_by_supports = j.at("free_by_supports");
    b.free_with_contact = j.at("free_with_contact");
    b.free_motions = j.at("free_motions").get<std::vector<std::string>>();
    b.in_pair = j.at("in_pair");
    b.touching = j.at("touching");
    b.pressed = j.at("pressed");
    b.touched = j.at("touched");
    b.nearest_pair = j.at("nearest_pair");
    b.nearest_gap = real(j.at("nearest_gap"));
    b.facet = real(j.at("facet"));
    return b;
}

template <class List> OrderedJson listed(const List& list) {
    OrderedJson all = OrderedJson::array();
    for (const auto& one : list) all.push_back(written(one));
    return all;
}

time::PostMortem parsed(const OrderedJson& j) {
    time::PostMortem f;
    f.cause = known(time::cause_of(j.at("cause")), j.at("cause"));
    f.message = j.at("message");
    f.stage = j.at("stage");
    f.time = real(j.at("time"));
    f.last_time = real(j.at("last_time"));
    f.dt = real(j.at("dt"));
    f.smallest_dt = real(j.at("smallest_dt"));
    f.limit = j.at("limit");
    for (const OrderedJson& one : j.at("attempts")) f.attempts.push_back(attempt(one));
    f.body = j.at("body");
    f.node = j.at("node");
    f.X = vector(j.at("X"));
    f.x = vector(j.at("x"));
    if (const OrderedJson& c = j.at("contact"); !c.is_null()) {
        time::ContactPlace& place = f.contact.emplace();
        place.pair = c.at("pair");
        place.master_body = c.at("master_body");
        place.master_facet = c.at("master_facet");
        place.facet_nodes = c.at("facet_nodes").get<std::vector<Index>>();
        place.status = known(time::status_of(c.at("status")), c.at("status"));
        place.gap = real(c.at("gap"));
    }
    if (const OrderedJson& e = j.at("element"); !e.is_null())
        f.element = time::ElementPlace{e.at("body"), e.at("element"), real(e.at("J"))};
    f.residual = real(j.at("residual"));
    f.reference_force = real(j.at("reference_force"));
    f.out_of_balance = vector(j.at("out_of_balance"));
    f.rung = j.at("rung");
    for (const OrderedJson& one : j.at("iterations")) f.iterations.push_back(iteration(one));
    f.changing = j.at("nodes_that_changed_status");
    for (const OrderedJson& one : j.at("status_changes")) f.changes.push_back(changes(one));
    for (const OrderedJson& one : j.at("bodies")) f.bodies.push_back(hold(one));
    for (const OrderedJson& one : j.at("advice"))
        f.advice.push_back({one.at("key"), one.at("text"), one.value("set", std::vector<std::string>())});
    f.no_remedy = j.value("no_remedy", "");
    return f;
}

} // namespace

void write_post_mortem(const std::filesystem::path& path, const time::PostMortem& f) {
    OrderedJson j;
    j["cause"] = name(f.cause);
    j["in_words"] = time::in_words(f.cause);
    j["message"] = f.message;
    j["stage"] = f.stage;
    j["time"] = f.time;
    j["last_time"] = f.last_time;
    j["dt"] = f.dt;
    j["smallest_dt"] = f.smallest_dt;
    j["limit"] = f.limit;
    j["attempts"] = listed(f.attempts);
    j["body"] = f.body;
    j["node"] = f.node;
    j["X"] = written(f.X);
    j["x"] = written(f.x);
    j["contact"] = nullptr;
    if (f.contact)
        j["contact"] = {{"pair", f.contact->pair},
                        {"master_body", f.contact->master_body},
                        {"master_facet", f.contact->master_facet},
                        {"facet_nodes", f.contact->facet_nodes},
                        {"status", time::name(f.contact->status)},
                        {"gap", f.contact->gap}};
    j["element"] = nullptr;
    if (f.element) j["element"] = {{"body", f.element->body}, {"element", f.element->element}, {"J", f.element->J}};
    j["residual"] = f.residual;
    j["reference_force"] = f.reference_force;
    j["out_of_balance"] = written(f.out_of_balance);
    j["rung"] = f.rung;
    j["iterations"] = listed(f.iterations);
    j["nodes_that_changed_status"] = f.changing;
    j["status_changes"] = listed(f.changes);
    j["bodies"] = listed(f.bodies);
    j["advice"] = OrderedJson::array();
    for (const time::Advice& one : f.advice)
        j["advice"].push_back({{"key", one.key}, {"text", one.text}, {"set", one.set}});
    j["no_remedy"] = f.no_remedy;
    write_json_atomic(path, j);
}

time::PostMortem read_post_mortem(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    try {
        return parsed(OrderedJson::parse(file));
    } catch (const std::exception& error) { // of the library, or of a name
        throw std::runtime_error(path.string() + " is no post-mortem: " + error.what());
    }
}

} // namespace osculate::output
