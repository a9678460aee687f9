#include "osculate/mesh/mesh_file.hpp"

#include "mesh/sort_few.hpp"
#include "mesh/sort_unique.hpp"
#include "osculate/mesh/deck_mesh.hpp"
#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/vtk_reader.hpp"
#include "osculate/mesh/vtu_reader.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <set>
#include <utility>

namespace osculate::mesh {
namespace {

struct Format {
    std::vector<std::string> endings;
    RawMesh (*read)(const std::filesystem::path&);
};

const std::vector<Format>& formats() {
    static const std::vector<Format> all{
        {{".vtu"}, read_vtu_cells},
        {{".vtk"}, read_vtk_cells},
        {{".e", ".ex2", ".exo", ".exii", ".g"}, read_exodus_cells},
        {{".msh"}, [](const std::filesystem::path& path) { return read_gmsh(path.string()); }},
        {{".inp"}, [](const std::filesystem::path& path) { return read_deck_mesh(path).raw; }},
    };
    return all;
}

Index root_of(std::vector<Index>& parent, Index i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

std::string names_of(const std::map<std::string, std::vector<Index>>& parts) {
    constexpr std::size_t shown = 20;
    std::string text;
    std::size_t count = 0;
    for (const auto& [name, cells] : parts)
        if (++count <= shown) text += (text.empty() ? "" : ", ") + name;
    if (count > shown) text += " and " + std::to_string(count - shown) + " more";
    return text.empty() ? "none" : text;
}

const std::vector<Index>& cells_of_part(const RawMesh& raw, const std::string& name) {
    const auto found = raw.parts.find(name);
    if (found == raw.parts.end())
        throw MeshError(raw.file, "no part is called '" + name + "'; parts with volume: " + names_of(raw.parts));
    return found->second;
}

/// The part that is asked for, with all points of the file.
RawMesh select(const RawMesh& raw, const MeshFileOptions& options) {
    RawMesh part = raw;
    for (std::size_t s = 0; s < options.sections.size(); ++s)
        for (const Index c : cells_of_part(raw, options.sections[s])) part.cells[c].section = static_cast<int>(s) + 1;
    std::vector<Index> cells(raw.cells.size());
    std::iota(cells.begin(), cells.end(), 0);
    if (!options.part.empty()) {
        cells = cells_of_part(raw, options.part);
        sort_unique(cells);
    }
    if (options.piece > 0) {
        const std::vector<int> numbers = pieces_of(raw, cells);
        const int pieces = *std::max_element(numbers.begin(), numbers.end());
        std::vector<Index> picked;
        for (std::size_t k = 0; k < cells.size(); ++k)
            if (numbers[k] == options.piece) picked.push_back(cells[k]);
        cells = std::move(picked);
        if (cells.empty())
            throw MeshError(raw.file, "no piece " + std::to_string(options.piece) + ": the number of pieces is " +
                                          std::to_string(pieces));
    }
    if (cells.size() == raw.cells.size()) return part;
    // Cells that other parts are made of use their points; parts that are not cells of this one have no meaning any more.
    for (const RawCell& cell : raw.cells)
        for (const Index node : cell) part.elsewhere[node] = 1;
    std::vector<RawCell> chosen;
    for (const Index c : cells) chosen.push_back(part.cells[c]);
    part.cells = std::move(chosen);
    part.parts.clear();
    return part;
}

/// Nodes that cells use, in order; returns the new number of every point, -1 for the others.
std::vector<Index> compact(const RawMesh& raw, Mesh& mesh) {
    std::vector<Index> number(raw.points.size(), -1);
    for (const RawCell& cell : raw.cells)
        for (const Index node : cell) number[node] = 0;
    for (std::size_t p = 0; p < number.size(); ++p)
        if (number[p] == 0) {
            number[p] = mesh.node_count();
            mesh.nodes.push_back(raw.points[p]);
            mesh.node_ids.push_back(raw.point_ids[p]);
        }
    return number;
}

using Corners = std::array<Index, 4>; ///< sorted; -1 in front for a triangle

Corners sorted_corners(const Index* nodes, int count) {
    Corners key{-1, -1, -1, -1};
    std::copy(nodes, nodes + count, key.begin());
    sort_few(key.begin(), key.end());
    return key;
}

/// The facets that a face of the file consists of, by their corners.
void add_keys(const RawFace& face, const std::vector<Index>& number, std::vector<Corners>& keys) {
    std::array<Index, most_nodes_per_face> n{};
    for (int i = 0; i < face.count; ++i)
        if ((n[i] = number[face.nodes[i]]) < 0) return; // of another part
    for_each_piece(n, face.count, [&](const std::array<Index, 4>& corners, int count) {
        keys.push_back(sorted_corners(corners.data(), count));
    });
}

void name_surfaces(const RawMesh& raw, const std::vector<Index>& number, Mesh& mesh) {
    if (raw.surfaces.empty() && !(raw.sets_are_surfaces && !raw.node_sets.empty())) return;
    const std::vector<Facet> exterior = exterior_facets(mesh);
    std::vector<std::pair<Corners, Index>> places(exterior.size());
    for (std::size_t f = 0; f < exterior.size(); ++f)
        places[f] = {sorted_corners(exterior[f].nodes.data(), exterior[f].count), static_cast<Index>(f)};
    if (!raw.surfaces.empty()) std::sort(places.begin(), places.end());
    for (const auto& [name, faces] : raw.surfaces) {
        std::vector<Corners> keys;
        for (const RawFace& face : faces) add_keys(face, number, keys);
        std::set<Index> found;
        for (const Corners& key : keys) {
            const auto at = std::lower_bound(places.begin(), places.end(), std::pair(key, Index{-1}));
            if (at != places.end() && at->first == key) found.insert(at->second);
        }
        if (found.empty()) continue;
        std::vector<Facet>& surface = mesh.surfaces[name];
        for (const Index f : found) surface.push_back(exterior[f]);
    }
    if (!raw.sets_are_surfaces) return;
    std::vector<char> member(mesh.nodes.size(), 0);
    for (const auto& [name, nodes] : mesh.node_sets) {
        for (const Index n : nodes) member[n] = 1;
        for (const Facet& facet : exterior)
            if (std::all_of(facet.begin(), facet.end(), [&](Index node) { return member[node] != 0; }))
                mesh.surfaces[name].push_back(facet);
        for (const Index n : nodes) member[n] = 0;
    }
}

void name_node_sets(const RawMesh& raw, const std::vector<Index>& number, Mesh& mesh) {
    for (const auto& [name, points] : raw.node_sets) {
        std::vector<Index> nodes;
        for (const Index p : points)
            if (number[p] >= 0) nodes.push_back(number[p]);
        sort_unique(nodes);
        // A surface keeps its name, and a set of nodes that is something else gets out of its way.
        if (!nodes.empty()) mesh.node_sets[raw.surfaces.contains(name) ? name + ".nodes" : name] = std::move(nodes);
    }
}

void add_blocks(const RawMesh& raw, const std::vector<Index>& number, Mesh& mesh) {
    std::vector<std::vector<int>> section;
    for (const CellInfo& info : cell_types()) {
        ElementBlock block{info.type, {}};
        std::vector<int> own;
        for (const RawCell& cell : raw.cells)
            if (cell.type == block.type) {
                for (const Index node : cell) block.connectivity.push_back(number[node]);
                own.push_back(cell.section);
            }
        if (block.size() == 0) continue;
        mesh.blocks.push_back(std::move(block));
        section.push_back(std::move(own));
    }
    divide(mesh, section);
}

} // namespace

std::vector<std::string> mesh_file_endings() {
    std::vector<std::string> all;
    for (const Format& format : formats()) all.insert(all.end(), format.endings.begin(), format.endings.end());
    return all;
}

std::vector<int> pieces_of(const RawMesh& raw, const std::vector<Index>& cells) {
    std::vector<Index> parent(raw.points.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (const Index c : cells)
        for (const Index node : raw.cells[c]) parent[root_of(parent, node)] = root_of(parent, raw.cells[c].nodes[0]);
    std::vector<int> of_root(raw.points.size(), 0), numbers;
    int pieces = 0;
    for (const Index c : cells) {
        int& number = of_root[root_of(parent, raw.cells[c].nodes[0])];
        if (number == 0) number = ++pieces;
        numbers.push_back(number);
    }
    return numbers;
}

RawMesh read_mesh_file(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) throw MeshError(path.string(), "no such file");
    if (!std::filesystem::is_regular_file(path)) throw MeshError(path.string(), "not a file");
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const Format& format : formats())
        if (std::find(format.endings.begin(), format.endings.end(), ending) != format.endings.end())
            return format.read(path);
    std::string known;
    for (const std::string& one : mesh_file_endings()) known += " " + one;
    throw MeshError(path.string(), "no mesh format has the ending '" + ending + "'; osculate reads" + known);
}

Mesh make_mesh(const RawMesh& raw, const MeshFileOptions& options, std::vector<std::string>* mended) {
    if (raw.cells.empty()) throw MeshError(raw.file, "no volume cells");
    RawMesh part = select(raw, options);
    MeshFaults found = find_and_mend(part, options.repairs);
    if (mended != nullptr) *mended = std::move(found.notes);
    if (found.faults.empty() && part.cells.empty())
        found.faults.push_back(raw.file + ": nothing is left after repairs");
    if (!found.faults.empty()) throw MeshError(std::move(found.faults));
    Mesh mesh;
    const std::vector<Index> number = compact(part, mesh);
    add_blocks(part, number, mesh);
    name_node_sets(part, number, mesh);
    name_surfaces(part, number, mesh);
    return mesh;
}

Mesh read_vtu(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) throw MeshError(path.string(), "no such file");
    if (!std::filesystem::is_regular_file(path)) throw MeshError(path.string(), "not a file");
    return make_mesh(read_vtu_cells(path));
}

} // namespace osculate::mesh
