#include "osculate/core/without_traps.hpp"
#include "osculate/output/post_mortem_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace osculate::output {

namespace {

constexpr std::size_t most_iterations = 10; ///< printed: the last ones
constexpr std::size_t most_attempts = 6;

std::string point(const Vec3& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z());
}

std::string left_out(std::size_t all, std::size_t shown) {
    return all > shown ? fmt::format(" (the last {} of {})", shown, all) : "";
}

/// "  label    text", lines after the first indented alike.
void say(std::string& text, const std::string& label, const std::string& line) {
    text += fmt::format("  {:<10}  {}\n", label, line);
}

void say_step(std::string& text, const time::PostMortem& f) {
    say(text, "step", fmt::format("stage '{}', a step of {:.6g} s to {:.9g} s; {}", f.stage, f.dt, f.time, f.limit));
    say(text, "last good", fmt::format("{:.9g} s; everything up to there is kept", f.last_time));
    const std::size_t shown = std::min(f.attempts.size(), most_attempts);
    for (std::size_t i = f.attempts.size() - shown; i < f.attempts.size(); ++i) {
        const time::Attempt& a = f.attempts[i];
        say(text, i + shown == f.attempts.size() ? "attempts" : "",
            fmt::format("{}: dt {:.6g} s, {} iterations, {}{}", a.attempt, a.dt, a.iterations,
                        a.cause.empty() ? name(a.reason) : a.cause.substr(0, a.cause.find(';')),
                        i + shown == f.attempts.size() ? left_out(f.attempts.size(), shown) : ""));
    }
}

void say_place(std::string& text, const time::PostMortem& f) {
    if (f.element)
        say(text, "element",
            fmt::format("{} of body '{}', det F = {:.4g}", f.element->element, f.element->body, f.element->J));
    if (f.node >= 0)
        say(text, "where",
            fmt::format("node {} of body '{}', from {} m now at {} m", f.node, f.body, point(f.X), point(f.x)));
    else if (!f.body.empty() && !f.element)
        say(text, "where", fmt::format("body '{}'", f.body));
    if (f.contact) {
        const time::ContactPlace& c = *f.contact;
        if (c.master_facet < 0)
            say(text, "contact",
                fmt::format("pair '{}', {}; nothing of body '{}' faces the node", c.pair, time::name(c.status),
                            c.master_body));
        else
            say(text, "contact",
                fmt::format("pair '{}', {}, gap {:.4g} m over facet {} of the master, nodes {} of body '{}'", c.pair,
                            time::name(c.status), c.gap, c.master_facet, fmt::join(c.facet_nodes, ", "),
                            c.master_body));
    }
}

void say_solve(std::string& text, const time::PostMortem& f) {
    if (f.iterations.empty()) return;
    say(text, "residual",
        fmt::format("{:.4g} of {:.4g} N, in '{}'{}", f.residual, f.reference_force, f.rung,
                    f.node >= 0 ? fmt::format("; out of balance at that node {} N", point(f.out_of_balance)) : ""));
    const std::size_t shown = std::min(f.iterations.size(), most_iterations);
    for (std::size_t i = f.iterations.size() - shown; i < f.iterations.size(); ++i) {
        const equilibrium::IterationRecord& one = f.iterations[i];
        say(text, i + shown == f.iterations.size() ? "iterations" : "",
            fmt::format("{:3}  {:9.3g}  open {}, stick {}, slip {}; {} changed{}", one.iteration, one.residual,
                        one.open, one.stick, one.slip, one.status_changes,
                        i + shown == f.iterations.size() ? left_out(f.iterations.size(), shown) : ""));
    }
    for (std::size_t i = 0; i < f.changes.size(); ++i) {
        const time::StatusChanges& one = f.changes[i];
        std::string sequence;
        for (const contact::Status status : one.sequence)
            sequence += (sequence.empty() ? "" : "-") + time::name(status);
        say(text, i == 0 ? "statuses" : "",
            fmt::format("{} at node {} of body '{}' in pair '{}'", sequence, one.node, one.body, one.pair));
    }
    if (const auto more = f.changing - static_cast<Index>(f.changes.size()); more > 0)
        say(text, "", fmt::format("and {} nodes more", more));
}

std::string held(const time::BodyHold& b) {
    if (b.free_by_supports == 0) return "held by its supports";
    if (b.free_with_contact == 0)
        return fmt::format("held by supports and contact together, {} motions by contact alone", b.free_by_supports);
    return fmt::format("free {}", fmt::join(b.free_motions, ", "));
}

void say_bodies(std::string& text, const time::PostMortem& f) {
    for (std::size_t i = 0; i < f.bodies.size(); ++i) {
        const time::BodyHold& b = f.bodies[i];
        std::string line = fmt::format("'{}' {}", b.body, held(b));
        if (b.in_pair) {
            line += fmt::format("; touches at {} slave nodes", b.touching);
            if (b.touching > b.pressed && f.cause == time::Cause::unsupported_body)
                line += fmt::format(", {} of which contact would have to pull", b.touching - b.pressed);
            line += fmt::format("; last good: at {}", b.touched);
            if (!b.nearest_pair.empty()) line += fmt::format(", smallest gap {:.4g} m", b.nearest_gap);
        }
        say(text, i == 0 ? "bodies" : "", line);
    }
}

void say_advice(std::string& text, const time::PostMortem& f) {
    if (!f.no_remedy.empty()) say(text, "try", "no remedy is known: " + f.no_remedy);
    for (std::size_t i = 0; i < f.advice.size(); ++i) {
        const time::Advice& one = f.advice[i];
        say(text, i == 0 && f.no_remedy.empty() ? "try" : "", fmt::format("{}: {}", one.key, one.text));
        std::string options;
        for (const std::string& change : one.set) options += " --set '" + change + "'";
        if (!options.empty()) say(text, "", " " + options);
    }
}

} // namespace

std::string in_words(const time::PostMortem& f) {
    const WithoutTraps nan; // values of failed solves may have to be printed
    std::string text = fmt::format("post-mortem\n");
    say(text, "cause", fmt::format("{}: {}", name(f.cause), time::in_words(f.cause)));
    say_step(text, f);
    say_place(text, f);
    say_solve(text, f);
    say_bodies(text, f);
    say_advice(text, f);
    return text;
}

} // namespace osculate::output
