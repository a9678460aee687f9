#include "deck/supports.hpp"

#include "deck/words.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <set>

namespace osculate::deck {

std::string DeckSupports::write() {
    std::map<Index, Holdings> by_point;
    std::set<std::pair<Index, std::size_t>> given; // points and components, by the step under way
    const auto add = [&](const DeckValues& values, int step) {
        std::size_t without = 0, of_rigid = 0;
        for (const Index p : values.points) {
            if (sets_.body_of(p) < 0) {
                ++without;
                continue;
            }
            if (sets_.is_rigid(p)) {
                ++of_rigid;
                continue;
            }
            for (int d = values.first; d <= values.last; ++d) {
                std::vector<Holding>& list = by_point[p][static_cast<std::size_t>(d)];
                if (!list.empty() && list.back().step == step) list.pop_back(); // the last of a step counts
                list.push_back({step, values.value, values.amplitude, false});
                given.insert({p, static_cast<std::size_t>(d)});
            }
        }
        if (of_rigid > 0)
            model_.lose(values.place, fmt::format("*BOUNDARY on {} nodes of rigid bodies", of_rigid),
                        "rigid bodies are held and moved at their reference points");
        if (without > 0)
            model_.left_out.push_back({values.place, fmt::format("*BOUNDARY on {} nodes", without),
                                       "no element has them", values.value != 0});
    };
    for (const DeckValues& values : model_.held) add(values, values.value == 0 ? -1 : 0);
    for (std::size_t s = 0; s < model_.steps.size(); ++s) {
        const DeckStep& step = model_.steps[s];
        given.clear();
        for (const DeckValues& values : step.held) add(values, static_cast<int>(s));
        if (!step.forget_held) continue;
        for (auto& [p, holdings] : by_point)
            for (std::size_t d = 0; d < holdings.size(); ++d)
                if (!holdings[d].empty() && !holdings[d].back().released && !given.contains({p, d}))
                    holdings[d].push_back({static_cast<int>(s), 0, "", true});
    }
    struct Group {
        int body;
        std::size_t axes; ///< 0: those of the deck
        bool on_axis;     ///< of these axes
        Holdings holdings;
        auto operator<=>(const Group&) const = default;
    };
    std::map<Group, std::vector<Index>> groups;
    for (auto& [p, holdings] : by_point) {
        const auto turned = model_.transform_of.find(p);
        const std::size_t axes = turned == model_.transform_of.end() || holds_all(holdings) ? 0 : turned->second + 1;
        const bool on_axis = axes > 0 && model_.on_axis(p);
        if (on_axis) hold_across(holdings, p);
        groups[{sets_.body_of(p), axes, on_axis, holdings}].push_back(p);
    }
    std::string text;
    for (const auto& [group, points] : groups)
        for (const std::string& set : sets_.of_points(static_cast<std::size_t>(group.body), points, "held"))
            text += write_support(set, group.holdings, axes_of(group.axes, group.on_axis));
    return text;
}

void DeckSupports::hold_across(Holdings& holdings, Index p) {
    for (const std::size_t d : {0, 1}) {
        const std::vector<Holding>& list = holdings[d];
        if (list.empty()) continue;
        if (std::ranges::any_of(list, [](const Holding& h) { return h.value != 0; }))
            model_.lose(model_.mesh.raw.file, fmt::format("*BOUNDARY on a node on the axis of its *TRANSFORM, {}", p),
                        "no direction there is radial");
        else if (holdings[1 - d].empty())
            holdings[1 - d] = list;
    }
}

bool DeckSupports::holds_all(const Holdings& holdings) {
    return std::ranges::all_of(holdings, [](const std::vector<Holding>& list) {
        return !list.empty() && list.front().step <= 0 &&
               std::ranges::all_of(list, [](const Holding& h) { return h.value == 0 && !h.released; });
    });
}

std::string DeckSupports::axes_of(std::size_t transform, bool on_axis) const {
    if (transform == 0) return "";
    const auto& [cylinder, points] = model_.transforms[transform - 1];
    const auto vector = [](const Vec3& v) {
        return "[" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "]";
    };
    if (on_axis) {
        const Vec3 axis = (points[1] - points[0]).normalized();
        Eigen::Index least = 0;
        axis.cwiseAbs().minCoeff(&least);
        const Vec3 across = axis.cross(Vec3::Unit(least)).normalized();
        return "axes: [" + vector(across) + ", " + vector(axis.cross(across)) + "]";
    }
    if (!cylinder) return "axes: [" + vector(points[0]) + ", " + vector(points[1]) + "]";
    return "cylinder: {point: " + vector(length_ * points[0]) + ", axis: " + vector(points[1] - points[0]) + "}";
}

std::string DeckSupports::write_support(const std::string& set, const Holdings& holdings, const std::string& axes) {
    std::string fixed;
    for (std::size_t d = 0; d < 3; ++d) {
        const std::vector<Holding>& list = holdings[d];
        if (list.empty()) continue;
        // a support is for the whole run, or until it is released for ever
        const bool zero =
            std::all_of(list.begin(), list.end(), [](const Holding& h) { return h.value == 0; }) &&
            std::none_of(list.begin(), std::prev(list.end()), [](const Holding& h) { return h.released; });
        if (zero && list.front().step <= 0) {
            fixed += (fixed.empty() ? "" : ", ") + std::string(1, "xyz"[d]);
            if (list.back().released) release(set, list.back(), d);
            continue;
        }
        for (std::size_t k = 0; k < list.size(); ++k) {
            const Holding& h = list[k];
            const auto s = static_cast<std::size_t>(std::max(h.step, 0));
            if (k + 1 < list.size() && list[k + 1].step == static_cast<int>(s)) continue; // held, then driven at once
            if (h.released) {
                release(set, h, d);
                continue;
            }
            stages_[s].displacement[set] += (stages_[s].displacement[set].empty() ? "" : ", ") +
                                            std::string(1, "xyz"[d]) + ": " +
                                            course(length_ * h.value, model_.amplitude(h.amplitude));
        }
    }
    if (fixed.empty() && axes.empty()) return "";
    return "  " + set + ": {" + (fixed.empty() ? "" : "fix: [" + fixed + "]") +
           (fixed.empty() || axes.empty() ? "" : ", ") + axes + "}\n";
}

void DeckSupports::release(const std::string& set, const Holding& holding, std::size_t d) {
    std::string& components = stages_[static_cast<std::size_t>(holding.step)].release[set];
    components += (components.empty() ? "" : ", ") + std::string(1, "xyz"[d]);
}

} // namespace osculate::deck
