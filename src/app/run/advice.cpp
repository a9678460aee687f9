/// What to change after a failure. Every piece names a key of the scene, and where a value can be told, `--set` takes it.

#include "osculate/app/advice.hpp"

#include "app/run/adviser.hpp"
#include "osculate/core/without_traps.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace osculate::app {

using time::Cause;
using time::PostMortem;

std::string Adviser::number(double value) {
    return fmt::format("{:g}", value);
}

std::string Adviser::rounded(double value) {
    return fmt::format("{:.2g}", value);
}

void Adviser::advise() {
    switch (found_.cause) {
    case Cause::unsupported_body: unsupported(); break;
    case Cause::singular_tangent: contradiction(); break;
    case Cause::linear_system:
        add("solver.linear_solver", "iterative instead of multigrid, if there is enough memory to factorise the bodies",
            {"solver.linear_solver=iterative"});
        break;
    case Cause::diverged: diverged(); break;
    case Cause::status_cycle: cycle(); break;
    case Cause::iterations_exhausted: iterations(); break;
    case Cause::stalled:
    case Cause::no_descent:
    case Cause::not_evaluable: stall(); break;
    case Cause::not_finite: not_finite(); break;
    case Cause::inside_out: inside_out(); break;
    case Cause::interpenetration:
    case Cause::collision: too_deep(); break;
    case Cause::unseen_contact: unseen(); break;
    case Cause::far_contact: far(); break;
    case Cause::time_error: time_error(); break;
    case Cause::energy: energy(); break;
    case Cause::load_not_finite: break;
    }
}

void Adviser::add(std::string key, std::string text, std::vector<std::string> set) {
    found_.advice.push_back({std::move(key), std::move(text), std::move(set)});
}

void Adviser::change(const std::string& key, const std::string& value, std::string text) {
    add(key, std::move(text), {key + "=" + value});
}

std::string Adviser::in_stage(const std::string& key) const {
    return stage_ + "." + key;
}

const model::ContactPair* Adviser::pair(const std::string& name) const {
    for (const model::ContactHistory& one : failed_.last.contact)
        if (one.pair->name() == name) return one.pair.get();
    return nullptr;
}

std::string Adviser::key_of(const model::ContactPair& pair) const {
    return is_own(pair.name()) ? "contact." + pair.name() : "contact.general";
}

std::string Adviser::surface_key(const model::ContactPair& pair) const {
    return key_of(pair) + (is_own(pair.name()) ? ".master.surface" : ".surface");
}

bool Adviser::is_own(const std::string& name) const {
    return std::ranges::any_of(failed_.model.pairs, [&](const auto& one) { return one->name() == name; });
}

double Adviser::whole_step() const {
    return failed_.stage.duration / failed_.stage.steps;
}

void Adviser::smaller_steps(const std::string& why) {
    const double smallest = found_.smallest_dt / whole_step();
    if (at_smallest())
        change("solver.smallest_step", number(smallest / 100),
               number(smallest / 100) + " instead of " + number(smallest) +
                   ", so that the step may be cut further: " + why);
    const int steps = 4 * failed_.stage.steps;
    change(in_stage("steps"), std::to_string(steps),
           std::to_string(steps) + " instead of " + number(failed_.stage.steps) + ", so that every step asks for less");
}

bool Adviser::at_smallest() const {
    return found_.dt <= found_.smallest_dt * (1 + time::same_step);
}

void Adviser::steps_smaller_by(double share, double least, const std::string& why) {
    const double smallest = found_.smallest_dt / whole_step(), wanted = found_.dt / whole_step() * share / margin;
    if (!at_smallest() || !(wanted > least)) return;
    change("solver.smallest_step", rounded(wanted),
           rounded(wanted) + " instead of " + number(smallest) + ", so that the step may be cut further: " + why);
}

std::string Adviser::listed(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

void Adviser::not_finite() {
    add(stage_, "loads and motions of an ordinary size: forces or displacements overflow");
    smaller_steps("a number overflowed within the step");
}

void Adviser::inside_out() {
    if (!found_.element) return;
    constexpr double crushed = 0.1; // of its volume is left: it is the motion that does it, step by step
    const bool gradually = volume_left() < crushed;
    if (!gradually) smaller_steps("elements can take only a little compression in one step");
    add(stage_, "a smaller load or motion on body '" + found_.element->body + "', " +
                    (gradually ? "in which an element has almost no volume left at the last good time already"
                               : "if the body cannot bear this one at all"));
    if (!gradually)
        add("bodies." + found_.element->body + ".material",
            "neo_hookean, if it is saint_venant_kirchhoff, which loses its stiffness under strong compression");
    add("bodies." + found_.element->body + ".mesh", "a mesh without thin or skewed elements there");
}

double Adviser::volume_left() const {
    const model::Model& model = failed_.model;
    Field f(model.X.size());
    return model.nonlinear ? model.nonlinear->add_force(model.X, failed_.last.at_rest(), f, 1).J : 1;
}

void Adviser::time_error() {
    const std::string key = in_stage("control.error_tolerance");
    change(key, rounded(margin * failed_.decision.value) + " m",
           "above " + number(failed_.decision.value) + " m instead of " + number(failed_.stage.limits.error_tolerance) +
               " m");
    constexpr double least = 1e-3; // the error is there in every step
    steps_smaller_by(std::cbrt(failed_.stage.limits.error_tolerance / failed_.decision.value), least,
                     "the error falls with the third power of the step");
}

void Adviser::energy() {
    const std::string key = in_stage("control.energy_tolerance");
    change(key, rounded(margin * failed_.decision.value),
           "above " + number(failed_.decision.value) + " instead of " + number(failed_.stage.limits.energy_tolerance));
    if (massless())
        change(in_stage("analysis.dynamic.contact_mass"), "kept",
               "kept: contact nodes with mass lose energy when they touch, and contact adds less when it opens");
    constexpr double least = 1e-4;
    steps_smaller_by(failed_.stage.limits.energy_tolerance / failed_.decision.value, least,
                     "with smaller steps, contact adds less energy when it opens");
}

bool Adviser::massless() const {
    const linear::BlockMatrix& M = failed_.model.mass(failed_.stage.dynamics->lumped_mass);
    if (M.empty()) return false;
    const Field diagonal = M.diagonal();
    const auto none = [&](Index node) { // nodes of skins have no mass of their own, and no row
        return model::material_node(failed_.model, node) == node && diagonal[static_cast<std::size_t>(node)].x() == 0;
    };
    return std::ranges::any_of(failed_.last.contact, [&](const model::ContactHistory& one) {
        return std::ranges::any_of(one.pair->slaves().node, none);
    });
}

namespace {

/// Of a load or a motion without a value.
void advise_on_load(PostMortem& found) {
    const auto& [course, elapsed, duration] = *found.missing_load;
    std::string key = course; // components of a body force have no key of their own
    for (const char* vector : {"body_force.", "nodal_force.", "force.", "moment."})
        if (key.starts_with(vector)) key = key.substr(0, key.rfind('.'));
    found.advice.push_back({"stages." + found.stage + "." + key,
                            "give it a finite value at every time from 0 to " + Adviser::number(duration) +
                                " s after the stage's start; at " + Adviser::number(elapsed) +
                                " s it has none. Move a pole of the expression out of the stage, or use a table"});
}

} // namespace

PostMortem advised(PostMortem found, const time::FailedIterate* iterate) {
    const WithoutTraps nan; // values of failed solves are compared
    if (iterate != nullptr)
        Adviser(found, iterate->attempt).advise();
    else if (found.missing_load)
        advise_on_load(found);
    return found;
}

} // namespace osculate::app
