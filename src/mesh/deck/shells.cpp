#include "mesh/deck/shells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

namespace osculate::mesh {

int DeckShells::nodes_of(std::string_view type) {
    return type == "R3D3" ? 3 : type == "R3D4" ? 4 : 0;
}

RawCell DeckShells::begin(const DeckLine& line, const std::vector<Index>& points) {
    const auto cell = static_cast<Index>(mesh_.raw.cells.size());
    shells_.push_back({cell, &line, points});
    mesh_.shells.resize(static_cast<std::size_t>(cell), 0);
    mesh_.shells.push_back(1);
    RawCell made;
    made.type = points.size() == 3 ? CellType::wedge6 : CellType::hex8;
    // until finish() both sides are the front: sets of its nodes are those of the deck
    for (std::size_t i = 0; i < 2 * points.size(); ++i) made.nodes[i] = points[i % points.size()];
    return made;
}

void DeckShells::find_sides(const DeckSets& element_sets) {
    std::map<Index, std::size_t> shell_of;
    for (std::size_t s = 0; s < shells_.size(); ++s) shell_of[shells_[s].cell] = s;
    std::vector<std::string_view> fields;
    for (const DeckCard& card : reading_.deck.cards) {
        if (card.keyword != "SURFACE") continue;
        for (auto line = reading_.deck.begin(card); line != reading_.deck.end(card); ++line) {
            split_fields(line->text, fields);
            if (fields.size() < 2) continue;
            const std::string side = in_capitals(fields[1]);
            if (side != "SPOS" && side != "SNEG") continue;
            const auto take = [&](Index cell) {
                const auto at = shell_of.find(cell);
                if (at == shell_of.end()) return;
                (side == "SPOS" ? shells_[at->second].front : shells_[at->second].back) = true;
            };
            long long id = 0;
            if (to_integer(fields[0], id))
                take(element_sets.numbers().look_up(id));
            else if (const std::vector<Index>* cells = element_sets.find(fields[0]))
                for (const Index cell : *cells) take(cell);
        }
    }
    for (Shell& shell : shells_) {
        if (shell.front && shell.back)
            reading_.fault(*shell.line, "both sides of rigid element " +
                                            reading_.deck.instances.shown(mesh_.raw.cells[shell.cell].id) +
                                            " are surfaces; a rigid tool has one outside");
        if (shell.back && !shell.front) std::reverse(shell.points.begin(), shell.points.end());
    }
}

/// By points of the front; -1 elsewhere.
std::vector<Index> DeckShells::backs() {
    const auto& points = mesh_.raw.points;
    std::map<Index, Vec3> normals;
    std::map<Index, double> edges;
    for (const Shell& shell : shells_) {
        const std::size_t n = shell.points.size();
        const auto x = [&](std::size_t i) { return points[static_cast<std::size_t>(shell.points[i % n])]; };
        const Vec3 area = n == 3 ? Vec3((x(1) - x(0)).cross(x(2) - x(0))) : Vec3((x(2) - x(0)).cross(x(3) - x(1)));
        for (std::size_t i = 0; i < n; ++i) {
            normals.try_emplace(shell.points[i], Vec3::Zero()).first->second += area.normalized();
            for (const std::size_t end : {i, i + 1}) {
                const auto at = edges.try_emplace(shell.points[end % n], std::numeric_limits<double>::max()).first;
                at->second = std::min(at->second, (x(i + 1) - x(i)).norm());
            }
        }
    }
    std::vector<Index> made(points.size(), -1);
    for (const auto& [point, normal] : normals) {
        const Vec3 x = mesh_.raw.points[static_cast<std::size_t>(point)];
        made[static_cast<std::size_t>(point)] = static_cast<Index>(mesh_.raw.points.size());
        mesh_.raw.points.emplace_back(x - thickness * edges.at(point) * normal.normalized());
        mesh_.raw.point_ids.push_back(mesh_.raw.point_ids[static_cast<std::size_t>(point)]);
        mesh_.raw.elsewhere.push_back(0);
    }
    return made;
}

void DeckShells::finish(const DeckSets& element_sets) {
    if (shells_.empty()) return;
    find_sides(element_sets);
    const std::vector<Index> back = backs();
    for (const Shell& shell : shells_) {
        std::vector<Index> all;
        for (const Index point : shell.points) all.push_back(back[static_cast<std::size_t>(point)]);
        all.insert(all.end(), shell.points.begin(), shell.points.end());
        RawCell& cell = mesh_.raw.cells[static_cast<std::size_t>(shell.cell)];
        const CellInfo& info = cell_info(cell.type);
        for (std::size_t i = 0; i < all.size(); ++i) cell.nodes[i] = all[static_cast<std::size_t>(info.from_deck[i])];
    }
}

} // namespace osculate::mesh
