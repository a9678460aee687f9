/// Couplings of a plan.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <map>

namespace osculate::app {

namespace {

/// Whether points lie on one line, which leaves turns about it without effect on them.
bool on_one_line(const std::vector<Vec3>& points) {
    constexpr double thin = 1e-9; // of the length: round-off of positions
    Vec3 mean = Vec3::Zero();
    for (const Vec3& X : points) mean += X / static_cast<double>(points.size());
    Mat3 second = Mat3::Zero();
    for (const Vec3& X : points) second += (X - mean) * (X - mean).transpose();
    const Vec3 squares = Eigen::SelfAdjointEigenSolver<Mat3>(second, Eigen::EigenvaluesOnly).eigenvalues();
    return !(squares(1) > thin * thin * squares(2));
}

/// Sets whose nodes a run holds or drives, and the keys that do.
std::vector<std::pair<std::string, std::string>> held_sets(const scene::Scene& scene) {
    std::vector<std::pair<std::string, std::string>> held;
    for (const auto& [set, support] : scene.supports) held.emplace_back(set, "supports." + set);
    for (const auto& [name, stage] : scene.stages)
        for (const auto& [set, components] : stage.displacement)
            held.emplace_back(set, "stages." + name + ".displacement." + set);
    return held;
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
    std::map<std::pair<std::string, std::string>, bool> told;
    for (const auto& [set, key] : held_sets(draft.scene))
        for (const Index node : draft.set(set).nodes) {
            const auto at = follows.find(node);
            if (at == follows.end() || !told.emplace(std::pair{at->second, set}, true).second) continue;
            draft.faults.push_back(
                fault(key,
                      fmt::format("nodes that follow no coupling: couplings.{0}.fix holds, stages.<stage>.motion.{0} "
                                  "drives them all",
                                  at->second),
                      fmt::format("a node at {} that follows couplings.{}", place(node), at->second)));
        }
}

} // namespace osculate::app
