/// Couplings of a plan.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "osculate/core/dense_algebra.hpp"

#include <array>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string>

namespace osculate::app {

namespace {

/// Whether points lie on one line, which leaves turns about it without effect on them.
bool on_one_line(const std::vector<Vec3>& points) {
    constexpr double thin = 1e-9; // of the length: round-off of positions
    Vec3 mean = Vec3::Zero();
    for (const Vec3& X : points) mean += X / static_cast<double>(points.size());
    Mat3 second = Mat3::Zero();
    for (const Vec3& X : points) second += (X - mean) * (X - mean).transpose();
    const Vec3 squares = principal_axes(second).values;
    return !(squares(1) > thin * thin * squares(2));
}

/// Directions along which a support holds a node, where these are its axes.
std::vector<Vec3> held_directions(const scene::Support& support, const Mat3& axes) {
    std::vector<Vec3> held;
    for (int k = 0; k < 3; ++k)
        if (support.fixed[static_cast<std::size_t>(k)]) held.emplace_back(axes.col(k));
    return held;
}

/// Marks the components that a coupling's `fix` lacks to hold a node along a unit vector d through any motion.
/// @param arm  from the reference point to the node
void find_missing(const std::array<bool, 6>& fixed, const Vec3& arm, const Vec3& d, std::array<bool, 6>& missing) {
    constexpr double round_off = 1e-9; // of unit vectors and arms
    int free_turns = 0;
    Vec3 axis = Vec3::Zero(); // of the last of them
    for (int k = 0; k < 3; ++k) {
        if (!fixed[static_cast<std::size_t>(k)] && std::abs(d(k)) > round_off)
            missing[static_cast<std::size_t>(k)] = true;
        if (fixed[static_cast<std::size_t>(k + 3)]) continue;
        ++free_turns;
        axis = Vec3::Unit(k);
    }
    const auto along = [&](const Vec3& v, const Vec3& e) { return v.cross(e).norm() <= round_off * v.norm(); };
    // turns about one axis move no node along it, and none that is on it; those about two lead anywhere
    if (free_turns == 0 || arm.isZero(0) || (free_turns == 1 && (along(d, axis) || along(arm, axis)))) return;
    for (int k = 0; k < 3; ++k)
        if (!fixed[static_cast<std::size_t>(k + 3)] && !along(d, Vec3::Unit(k)))
            missing[static_cast<std::size_t>(k + 3)] = true;
}

} // namespace

namespace {
void add_spread(Draft& draft, const std::string& name, const scene::Coupling& spec) {
    const model::Model& m = draft.plan.model;
    const model::Set& set = draft.set(spec.set);
    const std::string key = "couplings." + name;
    if (std::ranges::any_of(m.bodies[static_cast<std::size_t>(set.body)].kernels,
                            [](const auto& kernel) { return kernel->finite_strain(); }))
        draft.faults.push_back(fault(key + ".kind",
                                     "rigid for a set of a body of finite strain: shares of a load are those of the "
                                     "undeformed body",
                                     "distributing"));
    if (draft.scene.bodies[static_cast<std::size_t>(set.body)].second.slice)
        draft.faults.push_back(fault(key + ".set",
                                     "a set of a body that is no slice: nothing there carries moments out of "
                                     "its plane",
                                     "one of bodies." + m.bodies[static_cast<std::size_t>(set.body)].name));
    const Vec3 point = spec.reference_point.value_or(Vec3::Zero()) - m.origin;
    const LoadSpread spread(draft.faces(set), set.nodes, m.X.values(), spec.reference_point ? &point : nullptr);
    if (!spread.is_spatial())
        draft.faults.push_back(fault(key + ".set",
                                     "nodes that are not all on one line: nothing carries the moment about it",
                                     fmt::format("{} on one line", set.nodes.size())));
    draft.spreads.emplace(name, spread);
}
} // namespace

void add_couplings(Draft& draft) {
    model::Model& m = draft.plan.model;
    const auto place = [&](Index node) {
        const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
        return fmt::format("[{:.6g}, {:.6g}, {:.6g}] m", X[0], X[1], X[2]);
    };
    std::map<Index, std::string> follows; // node -> coupling
    for (const auto& [name, spec] : draft.scene.couplings) {
        if (spec.kind == scene::CouplingKind::distributing) {
            add_spread(draft, name, spec);
            continue;
        }
        const std::string key = "couplings." + name;
        const model::Set& set = draft.set(spec.set);
        model::RigidBody coupling;
        coupling.name = name;
        coupling.coupling = true;
        coupling.body = set.body;
        coupling.nodes = set.nodes;
        std::ranges::sort(coupling.nodes);
        std::vector<Vec3> points;
        for (const Index node : coupling.nodes) points.push_back(m.X[static_cast<std::size_t>(node)]);
        Vec3 mean = Vec3::Zero();
        for (const Vec3& X : points) mean += X / static_cast<double>(points.size());
        coupling.centre = spec.reference_point ? *spec.reference_point - m.origin : mean;
        coupling.radius = 0;
        for (const Vec3& X : points) coupling.radius = std::max(coupling.radius, (X - coupling.centre).norm());
        if (!(coupling.radius > 0)) coupling.radius = 1;
        if (const bool turns = !spec.fixed[3] || !spec.fixed[4] || !spec.fixed[5]; turns && on_one_line(points))
            draft.faults.push_back(
                fault(key + ".set",
                      "nodes that are not all on one line, or `fix: [rx, ry, rz]`: nothing holds the turns about it",
                      fmt::format("{} node{} {}", points.size(), points.size() == 1 ? "" : "s",
                                  points.size() == 1 ? "alone" : "on one line")));
        for (const Index node : coupling.nodes)
            if (const auto [other, fresh] = follows.emplace(node, name); !fresh) {
                draft.faults.push_back(
                    fault(key + ".set", "nodes that follow no other coupling: a node has one motion only",
                          fmt::format("a node at {} that follows couplings.{} too", place(node), other->second)));
                break;
            }
        coupling.reference = m.nodes();
        auto& X = m.X.values();
        X.insert(X.end(), 2, coupling.centre);
        m.rigid.push_back(std::move(coupling));
    }
    if (follows.empty()) return;
    // refuses the first node of each coupling in a set for which expected(node, coupling) has words
    const auto refuse = [&](const std::string& set, const std::string& key, const auto& expected) {
        std::set<std::string> told;
        for (const Index node : draft.set(set).nodes) {
            const auto at = follows.find(node);
            if (at == follows.end() || told.contains(at->second)) continue;
            const std::string words = expected(node, at->second);
            if (words.empty()) continue;
            told.insert(at->second);
            draft.faults.push_back(
                fault(key, words, fmt::format("a node at {} that follows couplings.{}", place(node), at->second)));
        }
    };
    for (const auto& [set, support] : draft.scene.supports)
        refuse(set, "supports." + set, [&, &support = support](Index node, const std::string& name) -> std::string {
            const model::RigidBody& coupling = draft.rigid(name);
            const Vec3 arm = m.X[static_cast<std::size_t>(node)] - coupling.centre;
            std::array<bool, 6> missing{};
            for (const Vec3& d : held_directions(support, axes_at(draft, &support, node)))
                find_missing(scene::find(draft.scene.couplings, name)->fixed, arm, d, missing);
            std::vector<std::string> names;
            for (std::size_t k = 0; k < 6; ++k)
                if (missing[k]) names.emplace_back(std::array{"x", "y", "z", "rx", "ry", "rz"}[k]);
            if (names.empty()) return {};
            return fmt::format(
                "nodes that follow no coupling, or one that keeps them there: add {} to couplings.{}.fix",
                fmt::join(names, ", "), name);
        });
    for (const auto& [stage_name, stage] : draft.scene.stages)
        for (const auto& [set, components] : stage.displacement)
            refuse(set, "stages." + stage_name + ".displacement." + set, [&](Index, const std::string& name) {
                return fmt::format("nodes that follow no coupling: couplings.{0}.fix holds, "
                                   "stages.<stage>.motion.{0} drives them all",
                                   name);
            });
}

} // namespace osculate::app
