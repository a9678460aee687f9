#include "mesh/deck/surfaces.hpp"

#include "mesh/face_cells.hpp"
#include "mesh/sort_few.hpp"
#include "mesh/sort_unique.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace osculate::mesh {

void DeckSurfaces::read(const DeckCard& card) {
    const std::string* name = card.parameter("NAME");
    if (name == nullptr || name->empty()) return reading_.fault(card, "*SURFACE without NAME=name");
    const std::string* type = card.parameter("TYPE");
    const std::string kind = type == nullptr ? "ELEMENT" : in_capitals(*type);
    if (kind == "NODE") return read_nodes(card, *name);
    if (kind == "ELEMENT") return read_faces(card, *name);
    reading_.fault(card, "*SURFACE of type '" + kind + "'; only ELEMENT and NODE are read");
}

void DeckSurfaces::read_faces(const DeckCard& card, const std::string& name) {
    const auto [at, fresh] = mesh_.surface_names.try_emplace(in_capitals(name), name);
    std::vector<RawFace>& faces =
        mesh_.raw.surfaces[at->second]; // a second definition extends the first, as in CalculiX
    for (auto line = reading_.deck.begin(card); line != reading_.deck.end(card); ++line) {
        split_fields(line->text, fields_);
        if (fields_.empty()) continue;
        const std::vector<Index> cells = cells_of_line();
        if (!reading_.generate(4 * cells.size())) return reading_.fault(*line, "surfaces with too many faces");
        if (cells.empty()) {
            if (!reading_.refused) reading_.fault(*line, "no element or element set '" + shown(fields_[0]) + "'");
            continue;
        }
        if ((fields_.size() == 1 || fields_[1].empty()) &&
            std::ranges::any_of(cells, [&](Index c) { return mesh_.is_shell(c); }))
            reading_.fault(*line, "SPOS or SNEG, the side of rigid elements, is expected");
        else if (fields_.size() == 1 || fields_[1].empty())
            add_outside(cells, faces);
        else
            add_face(*line, cells, faces);
    }
    if (fresh) return;
    std::set<std::array<Index, most_nodes_per_face>> taken;
    std::erase_if(faces, [&](const RawFace& face) { return !taken.insert(face.nodes).second; });
}

std::vector<Index> DeckSurfaces::cells_of_line() const {
    std::vector<Index> cells;
    long long id = 0;
    if (to_integer(fields_[0], id)) {
        if (const Index number = element_sets_.numbers().look_up(id); number >= 0) cells.push_back(number);
    } else if (const std::vector<Index>* found = element_sets_.find(fields_[0])) {
        cells = *found;
        sort_unique(cells);
    }
    return cells;
}

void DeckSurfaces::add_face(const DeckLine& line, const std::vector<Index>& cells, std::vector<RawFace>& faces) {
    const std::string label = in_capitals(fields_[1]);
    const int face = label.size() == 2 && label[0] == 'S' ? label[1] - '1' : -1;
    for (const Index c : cells) {
        const RawFace one = label == "SPOS" || label == "SNEG" ? mesh_.front_of(c)
                            : face < 0                         ? RawFace{}
                                                               : mesh_.face_of(c, face);
        if (one.count > 0)
            faces.push_back(one);
        else
            reading_.fault(line, "element " + reading_.deck.instances.shown(mesh_.raw.cells[c].id) + " has no face '" +
                                     shown(fields_[1]) + "'");
    }
}

void DeckSurfaces::add_outside(const std::vector<Index>& cells, std::vector<RawFace>& faces) {
    if (exterior_.empty() && !mesh_.raw.cells.empty()) {
        exterior_.assign(mesh_.raw.cells.size(), {});
        const auto all = faces_side_by_side(mesh_.raw.cells, mesh_.raw.points.size());
        for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
            while (last < all.size() && all[last].corners == all[first].corners) ++last;
            if (last - first == 1) exterior_[all[first].cell].push_back(all[first].face);
        }
    }
    for (const Index c : cells)
        for (const int local : exterior_[c]) {
            const LocalFace& corners = cell_info(mesh_.raw.cells[c].type).faces[static_cast<std::size_t>(local)];
            std::array<Index, 4> wanted{-1, -1, -1, -1};
            for (int i = 0; i < corners.count; ++i) wanted[i] = mesh_.raw.cells[c].nodes[corners.nodes[i]];
            sort_few(wanted.begin(), wanted.end());
            for (int f = 0; f < 6; ++f) {
                const RawFace face = mesh_.face_of(c, f);
                if (face.count == 0) continue;
                std::array<Index, 4> has{-1, -1, -1, -1};
                std::copy(face.nodes.begin(), face.nodes.begin() + corners.count, has.begin());
                sort_few(has.begin(), has.end());
                if (has == wanted) faces.push_back(face);
            }
        }
}

void DeckSurfaces::read_nodes(const DeckCard& card, const std::string& name) {
    std::vector<Index> members;
    for (auto line = reading_.deck.begin(card); line != reading_.deck.end(card); ++line) {
        split_fields(line->text, fields_);
        if (fields_.empty()) continue;
        long long id = 0;
        if (to_integer(fields_[0], id)) {
            if (const Index number = node_sets_.numbers().look_up(id); number >= 0) {
                members.push_back(number);
                continue;
            }
        } else if (const std::vector<Index>* found = node_sets_.find(fields_[0])) {
            if (!reading_.generate(found->size())) return reading_.fault(*line, "surfaces with too many nodes");
            members.insert(members.end(), found->begin(), found->end());
            continue;
        }
        reading_.fault(*line, "no node or node set '" + shown(fields_[0]) + "'");
    }
    sort_unique(members);
    std::vector<Index>& set = node_sets_.named(name);
    set.insert(set.end(), members.begin(), members.end());
}

} // namespace osculate::mesh
