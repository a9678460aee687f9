#include "deck/bodies.hpp"

#include "deck/words.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/mesh_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace osculate::deck {
namespace {

/// Finds what the elements of a body are made of. @param section  of every cell of the mesh, -1: none
void find_sections(DeckModel& model, const std::vector<int>& section, DeckBody& body) {
    std::map<int, std::size_t> count;
    for (const Index c : body.cells) ++count[section[static_cast<std::size_t>(c)]];
    const auto most =
        std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most->first < 0) return;
    body.section = &model.sections[static_cast<std::size_t>(most->first)];
    const std::set<Index> cells(body.cells.begin(), body.cells.end());
    for (const auto& [other, elements] : count) {
        if (other < 0) {
            model.lose(
                body.section->place,
                fmt::format("{} elements without a section in the piece of '{}'", elements, body.section->elements),
                "they get the material of most of its elements");
            continue;
        }
        const DeckSection& one = model.sections[static_cast<std::size_t>(other)];
        if (&one == body.section) continue;
        if (one.material == body.section->material && one.orientation == body.section->orientation) continue;
        body.other_sections.push_back(&one);
        if (std::ranges::any_of(one.cells, [&](Index c) {
                return cells.contains(c) && section[static_cast<std::size_t>(c)] == most->first;
            }))
            model.lose(one.place, "the section of '" + one.elements + "', whose elements a later one takes in part",
                       "a section of a body has its elements whole");
    }
}

/// @param rigid  number of the rigid body of every cell, -1: none
void find_rigid(DeckModel& model, const std::vector<int>& rigid, DeckBody& body) {
    std::set<int> all;
    bool shells = false;
    for (const Index c : body.cells) {
        all.insert(rigid[static_cast<std::size_t>(c)]);
        shells = shells || model.mesh.is_shell(c);
    }
    if (all == std::set<int>{-1} && shells)
        model.lose(model.mesh.raw.file, "R3D3 and R3D4 without a *RIGID BODY", "they become a thin layer that deforms");
    if (all == std::set<int>{-1}) return;
    const DeckRigid& one = model.rigid[static_cast<std::size_t>(*all.rbegin())];
    if (all.size() > 1)
        return model.lose(one.place, "*RIGID BODY of part of a connected piece",
                          "a body is rigid as a whole: it deforms");
    body.rigid = &one;
}

std::string formulation_of(const DeckModel& model, const std::vector<Index>& cells) {
    std::map<std::string, std::size_t> count;
    for (const Index c : cells)
        ++count[model.mesh.types[static_cast<std::size_t>(model.mesh.type[static_cast<std::size_t>(c)])]];
    std::size_t plain = 0, modes = 0, reduced = 0;
    for (const auto& [type, n] : count) {
        const bool r = type.ends_with('R'), linear = type.starts_with("C3D8") || type.find('4', 3) == 3;
        if (type == "C3D8I" || (linear && r))
            modes += n;
        else if (r)
            reduced += n;
        else if (type != "C3D4" && type != "C3D6" && type != "C3D10")
            plain += n;
    }
    if (reduced > plain + modes) return "reduced";
    return modes > plain ? "incompatible_modes" : "full";
}

} // namespace

namespace {
mesh::DeckSlice slice_of(DeckModel& model, const DeckBody& body) {
    const auto& slices = model.mesh.slices;
    std::set<mesh::DeckSlice> kinds;
    for (const Index c : body.cells)
        kinds.insert(static_cast<std::size_t>(c) < slices.size() ? slices[static_cast<std::size_t>(c)]
                                                                 : mesh::DeckSlice::none);
    if (kinds.size() > 1)
        model.lose(model.mesh.raw.file, "elements of several kinds (plane, of revolution, solid) in body " + body.name,
                   "a body is of one kind");
    return *kinds.rbegin();
}
} // namespace

namespace {
/// Parts that touch at nodes alone are joined there, as decks have it.
void make_mesh_of(DeckModel& model, mesh::MeshFileOptions options, DeckBody& body) {
    try {
        body.mesh = mesh::make_mesh(model.mesh.raw, options);
    } catch (const mesh::MeshError&) {
        options.repairs.wanted[static_cast<std::size_t>(mesh::Repair::keep_non_manifold)] = true;
        body.mesh = mesh::make_mesh(model.mesh.raw, options);
        body.joined_at_nodes = true;
        model.note(model.mesh.raw.file, "parts of body " + body.name + " that share nodes but no face",
                   "they stay joined there; contact refuses such a surface as a master");
    }
}
} // namespace

namespace {
/// That of its instance, or else of its rigid elements or its section.
std::string wanted_name(const DeckModel& model, const DeckBody& body) {
    const mesh::RawMesh& raw = model.mesh.raw;
    if (const mesh::Instance* instance = raw.instances.of(raw.cells[static_cast<std::size_t>(body.cells.front())].id))
        return instance->name;
    if (body.rigid != nullptr) return body.rigid->elements;
    return body.section != nullptr ? body.section->elements : "body";
}
} // namespace

std::vector<DeckBody> make_bodies(DeckModel& model) {
    const mesh::RawMesh& raw = model.mesh.raw;
    std::vector<Index> all(raw.cells.size());
    std::iota(all.begin(), all.end(), 0);
    const std::vector<int> piece = mesh::pieces_of(raw, all);
    const int pieces = piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end());
    std::vector<int> section(raw.cells.size(), -1);
    for (std::size_t s = 0; s < model.sections.size(); ++s)
        for (const Index c : model.sections[s].cells) section[static_cast<std::size_t>(c)] = static_cast<int>(s);

    std::vector<DeckBody> bodies(static_cast<std::size_t>(pieces));
    for (std::size_t c = 0; c < piece.size(); ++c)
        bodies[static_cast<std::size_t>(piece[c] - 1)].cells.push_back(static_cast<Index>(c));
    std::map<std::string, int> pieces_of_name, seen;
    std::vector<int> rigid(raw.cells.size(), -1);
    for (std::size_t r = 0; r < model.rigid.size(); ++r)
        for (const Index c : model.rigid[r].cells) rigid[static_cast<std::size_t>(c)] = static_cast<int>(r);
    for (DeckBody& body : bodies) {
        find_rigid(model, rigid, body);
        find_sections(model, section, body);
        ++pieces_of_name[wanted_name(model, body)];
    }
    std::set<std::string> taken;
    mesh::MeshFileOptions options;
    options.repairs.wanted[static_cast<std::size_t>(mesh::Repair::dangling_nodes)] = true;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        DeckBody& body = bodies[b];
        const std::string wanted = wanted_name(model, body);
        body.name =
            fresh_name(pieces_of_name[wanted] > 1 ? wanted + "_" + std::to_string(++seen[wanted]) : wanted, taken);
        body.piece = pieces > 1 ? static_cast<int>(b) + 1 : 0;
        body.formulation = formulation_of(model, body.cells);
        body.slice = slice_of(model, body);
        options.piece = body.piece;
        make_mesh_of(model, options, body);
        body.exterior = mesh::exterior_facets(body.mesh);
        std::vector<char> used(raw.points.size(), 0);
        for (const Index c : body.cells)
            for (const Index point : raw.cells[static_cast<std::size_t>(c)]) used[static_cast<std::size_t>(point)] = 1;
        for (std::size_t p = 0; p < used.size(); ++p)
            if (used[p]) body.points.push_back(static_cast<Index>(p));
    }
    return bodies;
}

DeckSets::DeckSets(const DeckModel& model, const std::vector<DeckBody>& bodies, double scale)
    : model_(model), bodies_(bodies), scale_(scale), body_of_(model.mesh.raw.points.size(), -1),
      node_of_(model.mesh.raw.points.size(), -1), numbered_alone_(model.mesh.raw.points.size(), 0) {
    Eigen::AlignedBox3d box;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        std::map<std::int64_t, int> count;
        for (const Index p : bodies[b].points) ++count[model.mesh.raw.point_ids[static_cast<std::size_t>(p)]];
        for (std::size_t n = 0; n < bodies[b].points.size(); ++n) {
            const auto p = static_cast<std::size_t>(bodies[b].points[n]);
            body_of_[p] = static_cast<int>(b);
            node_of_[p] = static_cast<Index>(n);
            numbered_alone_[p] = count.at(model.mesh.raw.point_ids[p]) == 1;
            box.extend(model.mesh.raw.points[p]);
        }
    }
    constexpr double small = 1e-7; // of the extent: nodes stand further apart, and round-off is less
    tolerance_ = small * box.diagonal().norm();
}

std::string DeckSets::add(std::size_t body, const std::string& wanted, const std::string& selection) {
    const auto [known, fresh] = known_.try_emplace(std::to_string(body) + selection);
    if (!fresh) return known->second;
    known->second = fresh_name(wanted, taken_);
    yaml_ += fmt::format("  {}: {{body: {}, {}}}\n", known->second, bodies_[body].name, selection);
    return known->second;
}

Eigen::AlignedBox3d DeckSets::box_of(const std::vector<Index>& points) const {
    Eigen::AlignedBox3d box;
    for (const Index p : points) box.extend(model_.mesh.raw.points[static_cast<std::size_t>(p)]);
    box.min().array() -= tolerance_;
    box.max().array() += tolerance_;
    return box;
}

std::string DeckSets::box_around(const std::vector<Index>& points) const {
    const Eigen::AlignedBox3d box = box_of(points);
    const Vec3 low = scale_ * box.min(), high = scale_ * box.max();
    return fmt::format("box: {{min: [{:.9g}, {:.9g}, {:.9g}], max: [{:.9g}, {:.9g}, {:.9g}]}}", low[0], low[1], low[2],
                       high[0], high[1], high[2]);
}

bool DeckSets::box_has_just(const DeckBody& body, const std::vector<Index>& points) const {
    const Eigen::AlignedBox3d box = box_of(points);
    std::size_t inside = 0;
    for (const Vec3& x : body.mesh.nodes) inside += box.contains(x) ? 1 : 0;
    return inside == points.size();
}

std::string DeckSets::of_points_as_one(std::size_t body, const std::vector<Index>& points, const std::string& wanted) {
    std::vector<Index> nodes;
    for (const Index p : points) nodes.push_back(node_of(p));
    for (const auto& [name, set] : bodies_[body].mesh.node_sets)
        if (set == nodes) return add(body, name, "nodes: " + in_quotes(name));
    return box_has_just(bodies_[body], points) ? add(body, wanted, box_around(points)) : "";
}

std::vector<std::string> DeckSets::of_points(std::size_t body, const std::vector<Index>& points,
                                             const std::string& wanted) {
    if (const std::string one = of_points_as_one(body, points, wanted); !one.empty()) return {one};
    std::vector<std::string> names;
    const auto number = [&](Index p) { return model_.mesh.raw.point_ids[static_cast<std::size_t>(p)]; };
    if (std::ranges::all_of(points, [&](Index p) { return numbered_alone_[static_cast<std::size_t>(p)] != 0; })) {
        std::string numbers;
        for (const Index p : points) numbers += (numbers.empty() ? "" : ", ") + std::to_string(number(p));
        return {add(body, points.size() == 1 ? wanted + "_" + numbers : wanted, "node_numbers: [" + numbers + "]")};
    }
    for (const Index p : points) {
        if (!box_has_just(bodies_[body], {p}))
            throw mesh::MeshError(model_.mesh.raw.file,
                                  fmt::format("another node of body {} is where node {} is: no set "
                                              "tells them apart",
                                              bodies_[body].name, number(p)));
        names.push_back(add(body, wanted + "_" + std::to_string(number(p)), box_around({p})));
    }
    return names;
}

std::string DeckSets::of_facets(std::size_t body, const std::vector<Index>& facets, const std::string& wanted) {
    const DeckBody& b = bodies_[body];
    const auto key = [](const mesh::Facet& f) { return std::pair(f.block, std::pair(f.element, f.nodes)); };
    std::set<std::pair<Index, std::pair<Index, std::array<Index, 4>>>> asked;
    std::set<Index> nodes;
    for (const Index f : facets) {
        asked.insert(key(b.exterior[static_cast<std::size_t>(f)]));
        for (const Index n : b.exterior[static_cast<std::size_t>(f)]) nodes.insert(n);
    }
    for (const auto& [name, surface] : b.mesh.surfaces)
        if (surface.size() == asked.size() &&
            std::all_of(surface.begin(), surface.end(), [&](const mesh::Facet& f) { return asked.contains(key(f)); }))
            return add(body, name, "surface: " + in_quotes(name));
    // A set of nodes stands for the facets within it.
    std::size_t within = 0;
    for (const mesh::Facet& f : b.exterior)
        within += std::all_of(f.begin(), f.end(), [&](Index n) { return nodes.contains(n); }) ? 1 : 0;
    if (within != asked.size()) return "";
    std::vector<Index> points;
    for (const Index n : nodes) points.push_back(b.points[static_cast<std::size_t>(n)]);
    const std::vector<std::string> sets = of_points(body, points, wanted);
    return sets.size() == 1 ? sets.front() : ""; // boxes of single points have no facets
}

std::string DeckSets::of_surface(std::size_t body, const std::string& in_capitals) {
    const mesh::Mesh& mesh = bodies_[body].mesh;
    if (const auto at = model_.mesh.surface_names.find(in_capitals);
        at != model_.mesh.surface_names.end() && mesh.surfaces.contains(at->second))
        return add(body, at->second, "surface: " + in_quotes(at->second));
    if (const auto at = model_.mesh.node_set_names.find(in_capitals);
        at != model_.mesh.node_set_names.end() && mesh.node_sets.contains(at->second))
        return add(body, at->second, "nodes: " + in_quotes(at->second));
    return "";
}

} // namespace osculate::deck
