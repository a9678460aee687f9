#include "osculate/mesh/repair.hpp"

#include "mesh/coincident_points.hpp"
#include "mesh/sort_few.hpp"
#include "mesh/split_non_manifold.hpp"
#include "osculate/mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace osculate::mesh {
namespace {

constexpr std::size_t listed = 20; // faults of a kind

/// Below this part of its extent cubed a cell has no volume: round-off of coordinates leaves less.
constexpr double no_volume = 1e-12;

/// Faults of one kind.
class Kind {
public:
    Kind(MeshFaults& all, const RawMesh& raw, std::string advice) : all_(all), raw_(raw), advice_(std::move(advice)) {}

    void add(const std::string& what) {
        if (++count_ <= listed) all_.faults.push_back(raw_.file + ": " + what);
    }
    void finish(const char* plural) {
        if (count_ > listed)
            all_.faults.push_back(raw_.file + ": and " + std::to_string(count_ - listed) + " more " + plural);
        if (count_ > 0 && !advice_.empty()) all_.faults.back() += advice_;
    }

private:
    MeshFaults& all_;
    const RawMesh& raw_;
    std::string advice_;
    std::size_t count_ = 0;
};

std::string mends(Repair r) {
    return " (repair: [" + repair_words()[static_cast<std::size_t>(r)] + "] mends this)";
}

std::string name_of(const RawMesh& raw, const RawCell& cell) {
    return raw.cell_word + (" " + raw.instances.shown(cell.id));
}

std::string name_of(const RawMesh& raw, Index point) {
    return raw.point_word + (" " + raw.instances.shown(raw.point_ids[point]));
}

/// Ids of what a note is about, the first few.
class Noted {
public:
    void add(const std::string& name) {
        constexpr std::size_t shown = 5;
        if (++count_ <= shown) names_ += (names_.empty() ? "" : ", ") + name;
        if (count_ == shown + 1) names_ += ", ...";
    }
    void finish(MeshFaults& all, const RawMesh& raw, const std::string& what) const {
        if (count_ > 0) all.notes.push_back(raw.file + ": " + std::to_string(count_) + " " + what + ": " + names_);
    }

private:
    std::size_t count_ = 0;
    std::string names_;
};

std::span<const Index> nodes_of(const RawCell& cell) {
    return {cell.nodes.data(), static_cast<std::size_t>(cell.count())};
}

double extent(const RawMesh& raw, const RawCell& cell) {
    Eigen::AlignedBox3d box;
    for (const Index node : cell) box.extend(raw.points[node]);
    return box.diagonal().norm();
}

/// The same cell seen in a mirror.
void turn_over(RawCell& cell) {
    const auto before = cell.nodes;
    const NodeOrder& mirrored = cell_info(cell.type).mirrored;
    for (std::size_t i = 0; i < static_cast<std::size_t>(cell.count()); ++i)
        cell.nodes[i] = before[static_cast<std::size_t>(mirrored[i])];
}

bool has_node_twice(const RawCell& cell) {
    auto nodes = cell.nodes;
    sort_few(nodes.begin(), nodes.begin() + cell.count());
    return std::adjacent_find(nodes.begin(), nodes.begin() + cell.count()) != nodes.begin() + cell.count();
}

/// A hexahedron with two parallel edges of one face each run together is a wedge.
bool becomes_wedge(RawCell& cell) {
    if (cell.type != CellType::hex8) return false;
    // Edges 01 and 45 in each of the places that they can be turned to, with the others in the order of a wedge.
    static constexpr int turned[12][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {1, 2, 3, 0, 5, 6, 7, 4}, {2, 3, 0, 1, 6, 7, 4, 5},
                                          {3, 0, 1, 2, 7, 4, 5, 6}, {0, 4, 5, 1, 3, 7, 6, 2}, {4, 5, 1, 0, 7, 6, 2, 3},
                                          {5, 1, 0, 4, 6, 2, 3, 7}, {1, 0, 4, 5, 2, 3, 7, 6}, {0, 3, 7, 4, 1, 2, 6, 5},
                                          {3, 7, 4, 0, 2, 6, 5, 1}, {7, 4, 0, 3, 6, 5, 1, 2}, {4, 0, 3, 7, 5, 1, 2, 6}};
    for (const auto& t : turned) {
        const auto at = [&](int i) { return cell.nodes[t[i]]; };
        if (at(0) != at(1) || at(4) != at(5)) continue;
        RawCell wedge;
        wedge.id = cell.id;
        wedge.type = CellType::wedge6;
        std::ranges::copy(std::array{at(0), at(2), at(3), at(4), at(6), at(7)}, wedge.nodes.begin());
        if (has_node_twice(wedge)) continue;
        cell = wedge;
        return true;
    }
    return false;
}

void check_positions(const RawMesh& raw, MeshFaults& all) {
    Kind kind(all, raw, "");
    for (std::size_t p = 0; p < raw.points.size(); ++p)
        if (!raw.points[p].allFinite()) kind.add(name_of(raw, static_cast<Index>(p)) + ": its position is not finite");
    kind.finish("positions");
}

void merge_coincident(RawMesh& raw, bool wanted, MeshFaults& all) {
    std::vector<char> used(raw.points.size(), 0);
    for (const RawCell& cell : raw.cells)
        for (const Index node : cell) used[node] = 1;
    const std::vector<Index> first = first_at_place(raw.points, used, coincidence);
    Noted noted;
    bool any = false;
    for (std::size_t p = 0; p < first.size(); ++p)
        if (first[p] != static_cast<Index>(p)) {
            any = true;
            noted.add(raw.instances.shown(raw.point_ids[p]) + " at " + raw.instances.shown(raw.point_ids[first[p]]));
        }
    noted.finish(all, raw,
                 std::string(raw.point_word) + (wanted ? "s merged with another at the same place"
                                                       : "s at the same place as another, not merged (repair: "
                                                         "[coincident_nodes] does)"));
    if (!any || !wanted) return;
    const auto merge = [&](Index& node) {
        if (node >= 0) node = first[node];
    };
    for (RawCell& cell : raw.cells) std::for_each(cell.nodes.begin(), cell.nodes.end(), merge);
    for (auto& [name, set] : raw.node_sets) std::for_each(set.begin(), set.end(), merge);
    for (auto& [name, faces] : raw.surfaces)
        for (RawFace& face : faces) std::for_each(face.nodes.begin(), face.nodes.end(), merge);
    for (std::size_t p = 0; p < first.size(); ++p)
        if (first[p] != static_cast<Index>(p)) raw.elsewhere[p] = 1; // nothing that was forgotten
}

/// Cells that are flat, inside out or tangled, in one pass.
void check_shapes(RawMesh& raw, const Repairs& repairs, MeshFaults& all) {
    MeshFaults degenerate_faults, inverted_faults, tangled_faults;
    Kind degenerate(degenerate_faults, raw, mends(Repair::degenerate)),
        inverted(inverted_faults, raw, mends(Repair::inverted)), tangled(tangled_faults, raw, "");
    Noted dropped, wedges, turned;
    std::size_t kept = 0;
    for (RawCell& cell : raw.cells) {
        const std::string word = raw.cell_word;
        const auto keep = [&] { raw.cells[kept++] = cell; };
        if (!std::all_of(cell.begin(), cell.end(), [&](Index n) { return raw.points[n].allFinite(); })) {
            keep();
            continue;
        }
        double volume = cell_volume(cell.type, nodes_of(cell), raw.points);
        const double length = extent(raw, cell);
        bool twice = has_node_twice(cell);
        if (twice && repairs[Repair::degenerate] && becomes_wedge(cell)) {
            wedges.add(raw.instances.shown(cell.id));
            twice = false;
            volume = cell_volume(cell.type, nodes_of(cell), raw.points);
        }
        const bool flat = !(std::abs(volume) > no_volume * length * length * length);
        if (twice || flat) {
            if (repairs[Repair::degenerate] && flat) {
                dropped.add(raw.instances.shown(cell.id));
                continue;
            }
            degenerate.add(name_of(raw, cell) +
                           (flat ? " is flat: it has no volume" : " is degenerate: it has a node twice"));
            keep();
            continue;
        }
        // Many programs write the triangle (0, 1, 2) of a wedge facing inward, against VTK's definition: the same solid.
        if (volume < 0 && is_wedge(cell.type)) {
            turn_over(cell);
            volume = -volume;
        }
        if (volume < 0 && repairs[Repair::inverted]) {
            turn_over(cell);
            turned.add(raw.instances.shown(cell.id));
            volume = -volume;
        }
        if (volume < 0)
            inverted.add(name_of(raw, cell) + " is inverted: its volume is negative");
        else if (const int bad = bad_corner(cell.type, nodes_of(cell), raw.points); bad >= 0)
            tangled.add(name_of(raw, cell) + " is tangled: its Jacobian is not positive at " +
                        name_of(raw, cell.nodes[bad]));
        keep();
    }
    raw.cells.resize(kept);
    degenerate.finish("degenerate");
    inverted.finish("inverted");
    tangled.finish("tangled");
    for (MeshFaults* some : {&degenerate_faults, &inverted_faults, &tangled_faults})
        all.faults.insert(all.faults.end(), some->faults.begin(), some->faults.end());
    dropped.finish(all, raw, std::string(raw.cell_word) + "s without volume left out");
    wedges.finish(all, raw, "hexahedra with two collapsed edges turned into wedges");
    turned.finish(all, raw, std::string("inverted ") + raw.cell_word + "s turned over");
}

/// Cells of the same nodes; the first stays. Returns whether any is left.
bool check_duplicates(RawMesh& raw, bool wanted, MeshFaults& all) {
    const auto sorted = [](const RawCell& cell) {
        auto nodes = cell.nodes;
        sort_few(nodes.begin(), nodes.begin() + cell.count());
        return nodes;
    };
    std::vector<std::pair<std::uint64_t, Index>> keys(raw.cells.size());
    for (std::size_t c = 0; c < raw.cells.size(); ++c) {
        std::uint64_t hash = 14695981039346656037ull;
        for (const Index node : sorted(raw.cells[c]))
            hash = (hash ^ static_cast<std::uint32_t>(node)) * 1099511628211ull;
        keys[c] = {hash, static_cast<Index>(c)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Index> original(raw.cells.size(), -1);
    for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
        while (last < keys.size() && keys[last].first == keys[first].first) ++last;
        for (std::size_t k = first + 1; k < last; ++k)
            for (std::size_t l = first; l < k; ++l)
                if (const Index a = keys[l].second, b = keys[k].second;
                    original[a] < 0 && sorted(raw.cells[a]) == sorted(raw.cells[b])) {
                    original[b] = a;
                    break;
                }
    }
    Kind kind(all, raw, mends(Repair::duplicate));
    Noted dropped;
    std::size_t kept = 0;
    bool left = false;
    for (std::size_t c = 0; c < raw.cells.size(); ++c) {
        if (original[c] >= 0 && wanted) {
            dropped.add(raw.instances.shown(raw.cells[c].id));
            continue;
        }
        if (original[c] >= 0) {
            left = true;
            kind.add(name_of(raw, raw.cells[c]) + " has the nodes of " +
                     name_of(raw, raw.cells[static_cast<std::size_t>(original[c])]));
        }
        if (wanted)
            raw.cells[kept++] = raw.cells[c];
        else
            ++kept;
    }
    raw.cells.resize(kept);
    kind.finish("duplicates");
    dropped.finish(all, raw, std::string("duplicate ") + raw.cell_word + "s left out");
    return left;
}

void check_dangling(RawMesh& raw, bool wanted, MeshFaults& all) {
    std::vector<char> used = raw.elsewhere;
    used.resize(raw.points.size(), 0);
    for (const RawCell& cell : raw.cells)
        for (const Index node : cell) used[node] = 1;
    Kind kind(all, raw, mends(Repair::dangling_nodes));
    Noted dropped;
    for (std::size_t p = 0; p < used.size(); ++p)
        if (!used[p]) {
            if (wanted)
                dropped.add(raw.instances.shown(raw.point_ids[p]));
            else
                kind.add(name_of(raw, static_cast<Index>(p)) + " belongs to nothing");
        }
    kind.finish("dangling nodes");
    dropped.finish(all, raw, std::string("dangling ") + raw.point_word + "s left out");
}

/// Neighbours that do not match: the body would be open between them. Returns whether all do.
bool check_neighbours(const RawMesh& raw, const NonManifold& found, MeshFaults& all) {
    Kind mixed(all, raw, " (mesh the body with elements of one kind, all with midside nodes or all without)"),
        apart(all, raw, " (repair: [coincident_nodes] mends this where they are at the same place)");
    for (const auto& [a, b] : found.unlike_faces) {
        const RawCell &one = raw.cells[a.cell], &other = raw.cells[b.cell];
        const std::string both = name_of(raw, one) + " and " + name_of(raw, other) + " share a face";
        const bool in_one = !cell_info(one.type).edges.empty(), in_other = !cell_info(other.type).edges.empty();
        if (in_one != in_other)
            mixed.add(both + ", which has midside nodes in " + name_of(raw, in_one ? one : other) + " alone");
        else
            apart.add(both + ", but not its midside nodes");
    }
    mixed.finish("such faces");
    apart.finish("such faces");
    return found.unlike_faces.empty();
}

/// @param split, keep  which of the two repairs is wanted; both: split
void check_manifold(RawMesh& raw, bool split, bool keep, MeshFaults& all) {
    const NonManifold found = find_non_manifold(raw);
    if (!check_neighbours(raw, found, all)) return; // what follows is of little use on an open body
    Kind kind(all, raw, mends(Repair::non_manifold) + ", [keep_non_manifold] leaves it"), lasting(all, raw, "");
    for (const FaceOfCell& face : found.crowded_faces)
        lasting.add(name_of(raw, raw.cells[face.cell]) + " has a face that two other " + raw.cell_word +
                    "s have, too: they overlap");
    lasting.finish("such faces");
    if ((split || keep) && found.crowded_faces.empty()) {
        Noted noted;
        for (const Index p : found.touching_points) noted.add(raw.instances.shown(raw.point_ids[p]));
        if (!split)
            return noted.finish(all, raw,
                                std::string(raw.point_word) + "s at which alone parts of the body are joined");
        split_non_manifold(raw, found);
        noted.finish(all, raw, std::string(raw.point_word) + "s doubled where parts of the body only touch");
        for (const auto& [a, b] : find_non_manifold(raw).crowded_edges)
            lasting.add("more than two exterior facets meet at the edge between " + name_of(raw, a) + " and " +
                        name_of(raw, b));
        return lasting.finish("such edges");
    }
    for (const auto& [a, b] : found.crowded_edges)
        kind.add("more than two exterior facets meet at the edge between " + name_of(raw, a) + " and " +
                 name_of(raw, b));
    for (const Index p : found.touching_points)
        if (std::none_of(found.crowded_edges.begin(), found.crowded_edges.end(),
                         [&](const auto& edge) { return edge.first == p || edge.second == p; }))
            kind.add("the surface touches itself at " + name_of(raw, p));
    kind.finish("such places");
}

} // namespace

const std::vector<std::string>& repair_words() {
    static const std::vector<std::string> words{"inverted",         "degenerate",       "duplicate",
                                                "dangling_nodes",   "coincident_nodes", "non_manifold",
                                                "keep_non_manifold"};
    return words;
}

MeshFaults find_and_mend(RawMesh& raw, const Repairs& repairs) {
    MeshFaults all;
    raw.elsewhere.resize(raw.points.size(), 0);
    check_positions(raw, all);
    if (!all.faults.empty()) return all;
    merge_coincident(raw, repairs[Repair::coincident_nodes], all);
    check_dangling(raw, repairs[Repair::dangling_nodes], all);
    check_shapes(raw, repairs, all);
    const bool duplicates = check_duplicates(raw, repairs[Repair::duplicate], all);
    // faces of a cell that has a node twice are none, and it is a fault already
    if (!duplicates && std::ranges::none_of(raw.cells, has_node_twice))
        check_manifold(raw, repairs[Repair::non_manifold], repairs[Repair::keep_non_manifold], all);
    return all;
}

} // namespace osculate::mesh
