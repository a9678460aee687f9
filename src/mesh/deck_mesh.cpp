#include "osculate/mesh/deck_mesh.hpp"

#include "mesh/face_cells.hpp"
#include "mesh/sort_few.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <span>

namespace osculate::mesh {
namespace {

constexpr std::size_t listed = 20; // faults
constexpr long long largest_id = 2'000'000'000;
constexpr std::size_t most_generated = 50'000'000; // members that ranges, sets of sets and surfaces add up to

struct ElementType {
    std::string_view name;
    CellType cell;
    std::array<int, 10> nodes; ///< place of every node of ours among the deck's
};
// A wedge of a deck has its first triangle facing inward, ours outward.
constexpr ElementType element_types[] = {
    {"C3D8", CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},         {"C3D8R", CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
    {"C3D8I", CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},        {"C3D4", CellType::tet4, {0, 1, 2, 3}},
    {"C3D10", CellType::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}, {"C3D6", CellType::wedge6, {0, 2, 1, 3, 5, 4}},
};

// Faces S1 to S6 by local nodes of ours.
constexpr CornerFace hex_faces[] = {{{0, 1, 2, 3}, 4}, {{4, 7, 6, 5}, 4}, {{0, 4, 5, 1}, 4},
                                    {{1, 5, 6, 2}, 4}, {{2, 6, 7, 3}, 4}, {{3, 7, 4, 0}, 4}};
constexpr CornerFace wedge_faces[] = {
    {{0, 1, 2, -1}, 3}, {{3, 4, 5, -1}, 3}, {{0, 2, 5, 3}, 4}, {{2, 1, 4, 5}, 4}, {{1, 0, 3, 4}, 4}};
constexpr CornerFace tet_faces[] = {{{0, 1, 2, -1}, 3}, {{0, 3, 1, -1}, 3}, {{1, 3, 2, -1}, 3}, {{2, 3, 0, -1}, 3}};

std::span<const CornerFace> deck_faces(CellType type) {
    switch (type) {
    case CellType::hex8: return hex_faces;
    case CellType::wedge6: return wedge_faces;
    case CellType::tet4:
    case CellType::tet10: return tet_faces;
    }
    return {};
}

Index find_id(const std::vector<std::pair<long long, Index>>& order, long long id) {
    const auto at = std::lower_bound(order.begin(), order.end(), std::pair(id, std::numeric_limits<Index>::min()));
    return at != order.end() && at->first == id ? at->second : -1;
}

class Reader {
public:
    explicit Reader(const Deck& deck) : deck_(deck) {}

    DeckMesh read() {
        mesh_.raw.file = deck_.files.empty() ? "" : deck_.files.front();
        for (const DeckCard& card : deck_.cards) {
            if (card.keyword == "PART" || card.keyword == "INSTANCE" || card.keyword == "ASSEMBLY") {
                fault(deck_.place(card), "*" + card.keyword +
                                             ": parts and assemblies are not read; write the deck flat, without them "
                                             "(Abaqus/CAE: noPartsInputFile=ON of the model)");
                break;
            }
            if (card.keyword == "SYSTEM") fault(deck_.place(card), "*SYSTEM: nodes in other axes are not read");
            if (card.keyword == "NODE") nodes(card);
        }
        index(mesh_.point_order, point_dense_, "node");
        mesh_.raw.elsewhere.assign(mesh_.raw.points.size(), 0);
        for (const DeckCard& card : deck_.cards)
            if (card.keyword == "ELEMENT") elements(card);
        index(mesh_.cell_order, cell_dense_, "element");
        for (const DeckCard& card : deck_.cards) {
            if (card.keyword == "NODE") add_node_set(card);
            if (card.keyword == "ELEMENT") add_element_set(card);
            if (card.keyword == "NSET")
                set(card, "NSET", node_sets_, point_dense_, mesh_.point_order, mesh_.node_set_names);
            if (card.keyword == "ELSET")
                set(card, "ELSET", element_sets_, cell_dense_, mesh_.cell_order, mesh_.element_set_names);
        }
        for (const DeckCard& card : deck_.cards)
            if (card.keyword == "SURFACE") surface(card);
        if (count_ > listed) faults_.push_back("and " + std::to_string(count_ - listed) + " more");
        if (!faults_.empty()) throw MeshError(std::move(faults_));
        for (auto& [key, members] : node_sets_) {
            sort_unique(members);
            mesh_.raw.node_sets[mesh_.node_set_names[key]] = std::move(members);
        }
        for (auto& [key, members] : element_sets_) {
            sort_unique(members);
            mesh_.raw.parts[mesh_.element_set_names[key]] = std::move(members);
        }
        return std::move(mesh_);
    }

private:
    void fault(const std::string& place, const std::string& what) {
        if (++count_ <= listed) faults_.push_back(place + ": " + what);
    }

    static void sort_unique(std::vector<Index>& values) {
        std::sort(values.begin(), values.end());
        values.erase(std::unique(values.begin(), values.end()), values.end());
    }

    void nodes(const DeckCard& card) {
        if (const std::string* system = card.parameter("SYSTEM"); system != nullptr && in_capitals(*system) != "R")
            fault(deck_.place(card), "*NODE, SYSTEM=" + *system + ": only rectangular coordinates are read");
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            long long id = 0;
            Vec3 x = Vec3::Zero();
            bool good = fields_.size() >= 2 && to_integer(fields_[0], id) && id > 0 && id <= largest_id;
            for (std::size_t d = 0; d < 3 && d + 1 < fields_.size(); ++d)
                good = good && (fields_[d + 1].empty() || to_number(fields_[d + 1], x[static_cast<Index>(d)]));
            if (!good) {
                fault(deck_.place(*line),
                      "a node is its number and its coordinates, found '" + shown(line->text) + "'");
                continue;
            }
            mesh_.point_order.emplace_back(id, static_cast<Index>(mesh_.raw.points.size()));
            mesh_.raw.points.push_back(x);
            mesh_.raw.point_ids.push_back(id);
        }
    }

    void elements(const DeckCard& card) {
        const std::string* given = card.parameter("TYPE");
        const std::string name = given == nullptr ? "" : in_capitals(*given);
        const ElementType* type = nullptr;
        for (const ElementType& one : element_types)
            if (one.name == name) type = &one;
        if (type == nullptr) {
            std::string known;
            for (const ElementType& one : element_types) known += (known.empty() ? "" : ", ") + std::string(one.name);
            fault(deck_.place(card), "*ELEMENT of type '" + name + "'; only " + known + " are read");
            refused_ = true;
            return;
        }
        auto kind = std::find(mesh_.types.begin(), mesh_.types.end(), name);
        if (kind == mesh_.types.end()) kind = mesh_.types.insert(kind, name);
        const auto kind_number = static_cast<char>(kind - mesh_.types.begin());
        const auto count = static_cast<std::size_t>(nodes_per_cell(type->cell));
        std::vector<long long> numbers;
        for (auto line = deck_.begin(card); line != deck_.end(card);) {
            // An element goes on over as many lines as it takes.
            const DeckLine& first = *line;
            numbers.clear();
            bool good = true;
            while (good && numbers.size() <= count && line != deck_.end(card)) {
                split_fields(line->text, fields_);
                for (const std::string_view field : fields_) {
                    long long value = 0;
                    good = good && to_integer(field, value);
                    numbers.push_back(value);
                }
                ++line;
            }
            if (!good || numbers.size() != count + 1 || numbers[0] <= 0 || numbers[0] > largest_id) {
                fault(deck_.place(first), "an element of type " + name + " is its number and " + std::to_string(count) +
                                              " nodes, found '" + shown(first.text) + "'");
                continue;
            }
            RawCell cell;
            cell.id = numbers[0];
            cell.type = type->cell;
            bool all = true;
            for (std::size_t i = 0; i < count && all; ++i) {
                const long long id = numbers[static_cast<std::size_t>(type->nodes[i]) + 1];
                cell.nodes[i] = look_up(point_dense_, mesh_.point_order, id);
                all = cell.nodes[i] >= 0;
                if (!all)
                    fault(deck_.place(first), "element " + std::to_string(cell.id) + " has node " + std::to_string(id) +
                                                  ", which does not exist");
            }
            if (!all) continue;
            mesh_.cell_order.emplace_back(cell.id, static_cast<Index>(mesh_.raw.cells.size()));
            mesh_.raw.cells.push_back(cell);
            mesh_.type.push_back(kind_number);
        }
    }

    /// Sorts by number, so that a number that comes twice shows; and a table for numbers that are nearly without gaps.
    void index(std::vector<std::pair<long long, Index>>& order, std::vector<Index>& dense, const char* word) {
        if (order.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 10)) {
            fault(mesh_.raw.file, std::string("too many ") + word + "s");
            order.clear();
        }
        if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
        for (std::size_t k = 1; k < order.size(); ++k)
            if (order[k].first == order[k - 1].first)
                fault(mesh_.raw.file, std::string(word) + " " + std::to_string(order[k].first) + " is defined twice");
        if (order.empty() || order.back().first > 4 * static_cast<long long>(order.size()) + 1000) return;
        dense.assign(static_cast<std::size_t>(order.back().first) + 1, -1);
        for (const auto& [id, number] : order) dense[static_cast<std::size_t>(id)] = number;
    }

    static Index look_up(const std::vector<Index>& dense, const std::vector<std::pair<long long, Index>>& order,
                         long long id) {
        if (dense.empty()) return find_id(order, id);
        return id >= 0 && id < static_cast<long long>(dense.size()) ? dense[static_cast<std::size_t>(id)] : -1;
    }

    using Sets = std::map<std::string, std::vector<Index>>;

    std::vector<Index>& set_named(const std::string& name, Sets& sets, std::map<std::string, std::string>& names) {
        const std::string key = in_capitals(name);
        names.try_emplace(key, name);
        return sets[key];
    }

    void add_node_set(const DeckCard& card) {
        const std::string* name = card.parameter("NSET");
        if (name == nullptr || name->empty()) return;
        std::vector<Index>& members = set_named(*name, node_sets_, mesh_.node_set_names);
        add_first_numbers(card, members, point_dense_, mesh_.point_order, 1);
    }

    void add_element_set(const DeckCard& card) {
        const std::string* name = card.parameter("ELSET");
        if (name == nullptr || name->empty()) return;
        std::vector<Index>& members = set_named(*name, element_sets_, mesh_.element_set_names);
        const std::string* given = card.parameter("TYPE");
        std::size_t fields = 1;
        for (const ElementType& one : element_types)
            if (given != nullptr && one.name == in_capitals(*given))
                fields = static_cast<std::size_t>(nodes_per_cell(one.cell)) + 1;
        add_first_numbers(card, members, cell_dense_, mesh_.cell_order, fields);
    }

    /// Every record of so many fields begins with a number.
    void add_first_numbers(const DeckCard& card, std::vector<Index>& members, const std::vector<Index>& dense,
                           const std::vector<std::pair<long long, Index>>& order, std::size_t fields) {
        std::size_t seen = 0;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            if (seen == 0) {
                long long id = 0;
                const std::string_view text = line->text;
                if (!to_integer(trimmed(text.substr(0, text.find(','))), id)) continue;
                if (const Index number = look_up(dense, order, id); number >= 0) members.push_back(number);
            }
            if (fields == 1) continue; // a line each
            split_fields(line->text, fields_);
            seen += fields_.size();
            if (seen >= fields) seen = 0;
        }
    }

    void set(const DeckCard& card, const char* parameter, Sets& sets, const std::vector<Index>& dense,
             const std::vector<std::pair<long long, Index>>& order, std::map<std::string, std::string>& names) {
        const std::string* name = card.parameter(parameter);
        if (name == nullptr || name->empty())
            return fault(deck_.place(card), "*" + card.keyword + " without " + parameter + "=name");
        std::vector<Index> members;
        const bool generate = card.parameter("GENERATE") != nullptr;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            if (generate) {
                add_range(*line, members, dense, order);
                continue;
            }
            for (const std::string_view field : fields_) {
                if (field.empty()) continue;
                long long id = 0;
                if (to_integer(field, id)) {
                    const Index number = look_up(dense, order, id);
                    if (number >= 0)
                        members.push_back(number);
                    else if (!refused_)
                        fault(deck_.place(*line),
                              std::string(parameter == std::string_view("NSET") ? "node " : "element ") +
                                  std::to_string(id) + " does not exist");
                    continue;
                }
                const auto found = sets.find(in_capitals(field));
                if (found != sets.end() && (total_ += found->second.size()) <= most_generated)
                    members.insert(members.end(), found->second.begin(), found->second.end());
                else if (found != sets.end())
                    return fault(deck_.place(*line), "sets of sets with too many members");
                else
                    fault(deck_.place(*line), "no set is called '" + shown(field) + "' before this line");
            }
        }
        std::vector<Index>& to = set_named(*name, sets, names);
        to.insert(to.end(), members.begin(), members.end());
        if (to.size() > 1000 && to.size() > 4 * order.size()) sort_unique(to);
    }

    void add_range(const DeckLine& line, std::vector<Index>& members, const std::vector<Index>& dense,
                   const std::vector<std::pair<long long, Index>>& order) {
        long long first = 0, last = 0, by = 1;
        if (fields_.size() < 2 || fields_.size() > 3 || !to_integer(fields_[0], first) ||
            !to_integer(fields_[1], last) ||
            (fields_.size() == 3 && !fields_[2].empty() && !to_integer(fields_[2], by)) || by <= 0 || first <= 0 ||
            last < first || last > largest_id)
            return fault(deck_.place(line), "GENERATE takes first, last, step, found '" + shown(line.text) + "'");
        if ((last - first) / by > static_cast<long long>(order.size())) { // mostly gaps: over those that exist
            auto at = std::lower_bound(order.begin(), order.end(), std::pair(first, std::numeric_limits<Index>::min()));
            if ((total_ += order.size()) > most_generated)
                return fault(deck_.place(line), "sets with too many members");
            for (; at != order.end() && at->first <= last; ++at)
                if ((at->first - first) % by == 0) members.push_back(at->second);
            return;
        }
        if ((total_ += static_cast<std::size_t>((last - first) / by + 1)) > most_generated)
            return fault(deck_.place(line), "sets with too many members");
        for (long long id = first; id <= last; id += by)
            if (const Index number = look_up(dense, order, id); number >= 0) members.push_back(number);
    }

    void surface(const DeckCard& card) {
        const std::string* name = card.parameter("NAME");
        if (name == nullptr || name->empty()) return fault(deck_.place(card), "*SURFACE without NAME=name");
        const std::string* type = card.parameter("TYPE");
        const std::string kind = type == nullptr ? "ELEMENT" : in_capitals(*type);
        if (kind == "NODE") return node_surface(card, *name);
        if (kind != "ELEMENT")
            return fault(deck_.place(card), "*SURFACE of type '" + kind + "'; only ELEMENT and NODE are read");
        const auto [at, fresh] = mesh_.surface_names.try_emplace(in_capitals(*name), *name);
        std::vector<RawFace>& faces = mesh_.raw.surfaces[at->second];
        if (!fresh) return fault(deck_.place(card), "surface '" + *name + "' is defined twice");
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            if (fields_.empty()) continue;
            std::vector<Index> cells;
            long long id = 0;
            if (to_integer(fields_[0], id)) {
                if (const Index number = look_up(cell_dense_, mesh_.cell_order, id); number >= 0)
                    cells.push_back(number);
            } else if (const auto found = element_sets_.find(in_capitals(fields_[0])); found != element_sets_.end()) {
                cells = found->second;
                sort_unique(cells);
            }
            if ((total_ += 4 * cells.size()) > most_generated)
                return fault(deck_.place(*line), "surfaces with too many faces");
            if (cells.empty()) {
                if (refused_) continue;
                fault(deck_.place(*line), "no element or element set '" + shown(fields_[0]) + "'");
                continue;
            }
            if (fields_.size() == 1 || fields_[1].empty()) {
                outside(cells, faces);
                continue;
            }
            const std::string label = in_capitals(fields_[1]);
            const int face = label.size() == 2 && label[0] == 'S' ? label[1] - '1' : -1;
            for (const Index c : cells) {
                const RawFace one = face < 0 ? RawFace{} : deck_face(mesh_.raw.cells[c], face);
                if (one.count > 0)
                    faces.push_back(one);
                else
                    fault(deck_.place(*line), "element " + std::to_string(mesh_.raw.cells[c].id) + " has no face '" +
                                                  shown(fields_[1]) + "'");
            }
        }
    }

    /// Faces of these cells that no cell of the deck has on the other side.
    void outside(const std::vector<Index>& cells, std::vector<RawFace>& faces) {
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
                const CornerFace& corners = cell_corner_faces(mesh_.raw.cells[c].type)[local];
                std::array<Index, 4> wanted{-1, -1, -1, -1};
                for (int i = 0; i < corners.count; ++i) wanted[i] = mesh_.raw.cells[c].nodes[corners.nodes[i]];
                sort_few(wanted.begin(), wanted.end());
                for (int f = 0; f < 6; ++f) {
                    const RawFace face = deck_face(mesh_.raw.cells[c], f);
                    if (face.count == 0) continue;
                    std::array<Index, 4> has{-1, -1, -1, -1};
                    std::copy(face.nodes.begin(), face.nodes.begin() + corners.count, has.begin());
                    sort_few(has.begin(), has.end());
                    if (has == wanted) faces.push_back(face);
                }
            }
    }

    void node_surface(const DeckCard& card, const std::string& name) {
        std::vector<Index> members;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            if (fields_.empty()) continue;
            long long id = 0;
            if (to_integer(fields_[0], id)) {
                if (const Index number = look_up(point_dense_, mesh_.point_order, id); number >= 0) {
                    members.push_back(number);
                    continue;
                }
            } else if (const auto found = node_sets_.find(in_capitals(fields_[0])); found != node_sets_.end()) {
                if ((total_ += found->second.size()) > most_generated)
                    return fault(deck_.place(*line), "surfaces with too many nodes");
                members.insert(members.end(), found->second.begin(), found->second.end());
                continue;
            }
            fault(deck_.place(*line), "no node or node set '" + shown(fields_[0]) + "'");
        }
        sort_unique(members);
        std::vector<Index>& set = set_named(name, node_sets_, mesh_.node_set_names);
        set.insert(set.end(), members.begin(), members.end());
    }

    static std::string shown(std::string_view text) {
        constexpr std::size_t most = 60;
        return std::string(text.substr(0, most)) + (text.size() > most ? "..." : "");
    }

    const Deck& deck_;
    DeckMesh mesh_;
    Sets node_sets_, element_sets_;
    std::vector<Index> point_dense_, cell_dense_;
    std::vector<std::string_view> fields_;
    std::vector<std::vector<int>> exterior_;
    std::vector<std::string> faults_;
    std::size_t count_ = 0, total_ = 0;
    bool refused_ = false; ///< elements of another type: what refers to them is no other fault
};

} // namespace

Index DeckMesh::cell(long long id) const {
    return find_id(cell_order, id);
}

Index DeckMesh::point(long long id) const {
    return find_id(point_order, id);
}

RawFace deck_face(const RawCell& cell, int face) {
    const auto faces = deck_faces(cell.type);
    RawFace found;
    if (face < 0 || face >= static_cast<int>(faces.size())) return found;
    const CornerFace& corners = faces[face];
    found.count = corners.count;
    for (int i = 0; i < corners.count; ++i) found.nodes[i] = cell.nodes[corners.nodes[i]];
    if (cell.type != CellType::tet10) return found;
    constexpr int mid[4][4] = {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}};
    found.count = 6;
    for (int i = 0; i < 3; ++i) found.nodes[3 + i] = cell.nodes[mid[corners.nodes[i]][corners.nodes[(i + 1) % 3]]];
    return found;
}

DeckMesh read_deck_mesh(const Deck& deck) {
    return Reader(deck).read();
}

DeckMesh read_deck_mesh(const std::filesystem::path& path) {
    return read_deck_mesh(read_deck(path));
}

} // namespace osculate::mesh
