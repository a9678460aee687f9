#include "osculate/deck/import_deck.hpp"

#include "deck/bodies.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace osculate::deck {
namespace {

/// Metres, pascals and kg/m^3 per unit of the deck.
struct Units {
    double length, stress, density;
    const char* words;
};

Units units_of(DeckUnits units) {
    return units == DeckUnits::mm ? Units{1e-3, 1e6, 1e12, "mm, t, s, N, MPa"} : Units{1, 1, 1, "SI"};
}

std::string number(double value) {
    return fmt::format("{:.12g}", value);
}

/// Text of a deck for a comment.
std::string harmless(const std::string& text) {
    std::string result = text;
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return result;
}

/// What the deck holds a component of a node at: step (-1: all of them), value, amplitude.
struct Holding {
    int step = -1;
    double value = 0;
    std::string amplitude;
    auto operator<=>(const Holding&) const = default;
};
using Holdings = std::array<std::vector<Holding>, 3>;

class Importer {
public:
    Importer(DeckModel model, std::string path, DeckUnits units)
        : model_(std::move(model)), path_(std::move(path)), units_(units_of(units)), bodies_(make_bodies(model_)),
          sets_(model_, bodies_, units_.length) {
        for (const DeckStep& step : model_.steps) nlgeom_ = nlgeom_ || step.nlgeom;
    }

    ImportedScene write() {
        if (bodies_.empty()) throw mesh::MeshError(model_.mesh.raw.file, "no volume elements");
        if (model_.steps.empty())
            throw mesh::MeshError(model_.mesh.raw.file,
                                  "no *STEP with *STATIC or *DYNAMIC, which alone have counterparts");
        stages_.resize(model_.steps.size());
        const std::string bodies = write_bodies(), supports = write_supports(), contact = write_contact();
        for (std::size_t s = 0; s < model_.steps.size(); ++s) add_loads(s);
        ImportedScene scene;
        std::string text =
            fmt::format("# From {}, numbers in {}; everything here is in SI.\n", harmless(path_), units_.words);
        text += "# A body per connected piece of the mesh, named after its solid section.\n";
        if (!model_.left_out.empty()) text += "# Not as in the deck:\n";
        for (const LeftOut& one : model_.left_out) {
            scene.left_out.push_back(harmless(one.place + ": " + one.what + ": " + one.why));
            text += "#   " + scene.left_out.back() + "\n";
        }
        text += "bodies:\n" + bodies;
        if (!sets_.yaml().empty()) text += "sets:\n" + sets_.yaml();
        if (!supports.empty()) text += "supports:\n" + supports;
        if (!contact.empty()) text += "contact:\n" + contact;
        text += "stages:\n";
        for (std::size_t s = 0; s < model_.steps.size(); ++s) text += write_stage(s);
        scene.text = std::move(text);
        return scene;
    }

private:
    void leave(const std::string& place, const std::string& what, const std::string& why) {
        model_.left_out.push_back({place, what, why});
    }

    // ---- bodies ----

    std::string write_bodies() {
        std::string text;
        bool dangling = false;
        std::vector<char> used(model_.mesh.raw.points.size(), 0);
        for (const mesh::RawCell& cell : model_.mesh.raw.cells)
            for (const Index p : cell) used[static_cast<std::size_t>(p)] = 1;
        for (const char u : used) dangling = dangling || !u;
        for (const DeckBody& body : bodies_) {
            text += "  " + body.name + ":\n    mesh: {file: {path: " + in_quotes(path_);
            if (body.piece > 0) text += fmt::format(", piece: {}", body.piece);
            if (dangling) text += ", repair: [dangling_nodes]";
            text += "}";
            if (units_.length != 1) text += ", scale: " + number(units_.length);
            text += "}\n    material: " + material_of(body) + "\n";
            if (body.formulation != "full") text += "    hex_formulation: " + body.formulation + "\n";
        }
        return text;
    }

    std::string material_of(const DeckBody& body) {
        std::array<double, 2> elastic{1, 0};
        std::string law = nlgeom_ ? "saint_venant_kirchhoff" : "linear_elastic";
        double density = 0;
        const auto found =
            body.section == nullptr ? model_.materials.end() : model_.materials.find(body.section->material);
        if (found == model_.materials.end()) {
            leave(body.section == nullptr ? model_.mesh.raw.file : body.section->place, "body " + body.name,
                  "it has no material: E = 1 stands in");
        } else {
            const DeckMaterial& m = found->second;
            density = m.density;
            if (m.elastic) {
                elastic = *m.elastic;
            } else if (m.neo_hookean && (*m.neo_hookean)[0] > 0 && (*m.neo_hookean)[1] > 0) {
                const double mu = 2 * (*m.neo_hookean)[0], K = 2 / (*m.neo_hookean)[1];
                elastic = {9 * K * mu / (3 * K + mu), (3 * K - 2 * mu) / (2 * (3 * K + mu))};
                law = "neo_hookean";
            } else {
                leave(m.place, "material " + m.name,
                      m.neo_hookean ? "C10 and D1 must be positive: E = 1 stands in"
                                    : "no elastic constants that have a counterpart: E = 1 stands in");
            }
            if (!(elastic[0] > 0) || !(elastic[1] > -1 && elastic[1] < 0.5))
                leave(m.place, "material " + m.name, "E must be positive, nu between -1 and 0.5");
        }
        std::string text = "{" + law + ": {E: " + number(units_.stress * elastic[0]) + ", nu: " + number(elastic[1]);
        if (density > 0) text += ", density: " + number(units_.density * density);
        return text + "}}";
    }

    // ---- supports ----

    std::string write_supports() {
        std::map<Index, Holdings> by_point;
        const auto add = [&](const DeckValues& values, int step) {
            for (const Index p : values.points)
                if (sets_.body_of(p) >= 0)
                    for (int d = values.first; d <= values.last; ++d) {
                        std::vector<Holding>& list = by_point[p][static_cast<std::size_t>(d)];
                        if (!list.empty() && list.back().step == step) list.pop_back(); // the last of a step counts
                        list.push_back({step, values.value, values.amplitude});
                    }
        };
        for (const DeckValues& values : model_.held) add(values, values.value == 0 ? -1 : 0);
        for (std::size_t s = 0; s < model_.steps.size(); ++s) {
            const DeckStep& step = model_.steps[s];
            if (step.forget_held && (s > 0 || !model_.held.empty()))
                leave(step.place, "*BOUNDARY, OP=NEW", "what is held stays held");
            for (const DeckValues& values : step.held) add(values, static_cast<int>(s));
        }
        std::map<std::pair<int, Holdings>, std::vector<Index>> groups;
        for (const auto& [p, holdings] : by_point) groups[{sets_.body_of(p), holdings}].push_back(p);
        std::string text;
        for (const auto& [key, points] : groups)
            for (const std::string& set : sets_.of_points(static_cast<std::size_t>(key.first), points, "held"))
                text += write_support(set, key.second);
        return text;
    }

    /// Components held at zero from the start are supports, others driven by stages.
    std::string write_support(const std::string& set, const Holdings& holdings) {
        std::string fixed;
        for (std::size_t d = 0; d < 3; ++d) {
            const std::vector<Holding>& list = holdings[d];
            if (list.empty()) continue;
            const bool zero = std::all_of(list.begin(), list.end(), [](const Holding& h) { return h.value == 0; });
            if (zero && list.front().step <= 0) {
                fixed += (fixed.empty() ? "" : ", ") + std::string(1, "xyz"[d]);
                continue;
            }
            for (const Holding& h : list) {
                const auto s = static_cast<std::size_t>(std::max(h.step, 0));
                stages_[s].displacement[set] += (stages_[s].displacement[set].empty() ? "" : ", ") +
                                                std::string(1, "xyz"[d]) + ": " +
                                                course(units_.length * h.value, h.amplitude);
            }
        }
        return fixed.empty() ? "" : "  " + set + ": {fix: [" + fixed + "]}\n";
    }

    std::string course(double value, const std::string& amplitude) const {
        const auto found = model_.amplitudes.find(amplitude);
        if (found == model_.amplitudes.end()) return number(value);
        std::string rows;
        for (const auto& [t, factor] : found->second)
            rows += (rows.empty() ? "[" : ", [") + number(t) + ", " + number(factor * value) + "]";
        return "{table: [" + rows + "]}";
    }

    // ---- contact ----

    std::string write_contact() {
        std::string text;
        std::set<std::string> taken;
        for (const DeckPair& pair : model_.pairs) {
            bool any = false;
            for (std::size_t a = 0; a < bodies_.size(); ++a)
                for (std::size_t b = 0; b < bodies_.size(); ++b) {
                    if (a == b) continue;
                    const std::string slave = sets_.of_surface(a, pair.slave),
                                      master = sets_.of_surface(b, pair.master);
                    if (slave.empty() || master.empty()) continue;
                    any = true;
                    if (!covers_facets(a, pair.slave)) {
                        leave(pair.place, "*CONTACT PAIR of " + pair.slave + " and " + pair.master,
                              "nodes that cover no facet of their body cannot be slaves");
                        continue;
                    }
                    text += "  " + fresh_name(slave + "_on_" + master, taken) + ":\n    slave: " + slave +
                            "\n    master: {set: " + master + "}\n";
                    if (pair.mortar && bodies_[a].mesh.surfaces.contains(surface_name(pair.slave)))
                        text += "    discretisation: mortar  # surface to surface\n";
                    if (const auto mu = model_.friction.find(pair.interaction);
                        mu != model_.friction.end() && mu->second > 0)
                        text += "    friction: " + number(mu->second) + "\n";
                }
            if (!any)
                leave(pair.place, "*CONTACT PAIR of " + pair.slave + " and " + pair.master,
                      "no two pieces of the mesh have them: a body in contact with itself has no counterpart");
        }
        return text;
    }

    /// A surface does; a set of nodes where it has all the nodes of a facet.
    bool covers_facets(std::size_t body, const std::string& key) const {
        if (bodies_[body].mesh.surfaces.contains(surface_name(key))) return true;
        const auto name = model_.mesh.node_set_names.find(key);
        if (name == model_.mesh.node_set_names.end()) return false;
        const std::vector<Index>& nodes = bodies_[body].mesh.node_sets.at(name->second);
        return std::any_of(bodies_[body].exterior.begin(), bodies_[body].exterior.end(), [&](const mesh::Facet& facet) {
            return std::all_of(facet.begin(), facet.end(),
                               [&](Index n) { return std::binary_search(nodes.begin(), nodes.end(), n); });
        });
    }

    std::string surface_name(const std::string& key) const {
        const auto at = model_.mesh.surface_names.find(key);
        return at == model_.mesh.surface_names.end() ? "" : at->second;
    }

    // ---- loads ----

    void add_loads(std::size_t s) {
        const DeckStep& step = model_.steps[s];
        if (s > 0 && (step.forget_forces || step.forget_pressures))
            leave(step.place, "OP=NEW", "loads of earlier steps stay unless the step gives them anew");
        add_forces(s);
        for (const DeckPressure& p : model_.steps[s].pressures) add_pressure(s, p);
        for (const DeckGravity& g : model_.steps[s].gravity) add_gravity(s, g);
    }

    /// Forces on nodes that are those of one pressure on facets.
    void add_forces(std::size_t s) {
        struct Group {
            std::map<Index, Vec3> force; ///< by nodes of the body
            std::string place;
        };
        std::map<std::pair<int, std::string>, Group> groups;
        for (const DeckValues& f : model_.steps[s].forces)
            for (const Index p : f.points)
                if (sets_.body_of(p) >= 0) {
                    Group& group = groups[{sets_.body_of(p), f.amplitude}];
                    if (group.place.empty()) group.place = f.place;
                    group.force.try_emplace(sets_.node_of(p), Vec3::Zero()).first->second[f.first] += f.value;
                }
        for (const auto& entry : groups) {
            const auto& key = entry.first;
            const Group& group = entry.second;
            const auto b = static_cast<std::size_t>(key.first);
            const DeckBody& body = bodies_[b];
            std::vector<Index> facets;
            std::map<Index, Vec3> unit;
            std::vector<mesh::Facet> loaded;
            for (std::size_t f = 0; f < body.exterior.size(); ++f) {
                const mesh::SurfaceFace face = mesh::surface_faces(body.mesh, {body.exterior[f]}).front();
                // a deck may leave out the corners of six-node faces, which carry nothing where these are straight
                const auto* first = face.begin() + (face.count == 6 ? 3 : 0);
                if (!std::all_of(first, face.end(), [&](Index n) { return group.force.contains(n); })) continue;
                facets.push_back(static_cast<Index>(f));
                loaded.push_back(body.exterior[f]);
            }
            for (const mesh::SurfaceFace& face : mesh::surface_faces(body.mesh, loaded)) {
                const auto share = fe::pressure_forces(face, body.mesh.nodes, 1);
                for (std::size_t c = 0; c < static_cast<std::size_t>(face.count); ++c)
                    unit.try_emplace(face.nodes[c], Vec3::Zero()).first->second += share[c];
            }
            double both = 0, square = 0, largest = 0, worst = 0;
            for (const auto& [node, force] : group.force) {
                const auto at = unit.find(node);
                if (at != unit.end()) {
                    both += force.dot(at->second);
                    square += at->second.squaredNorm();
                }
                largest = std::max(largest, force.norm());
            }
            const double pressure = square > 0 ? both / square : 0;
            for (const auto& [node, force] : group.force) {
                const auto at = unit.find(node);
                worst = std::max(
                    worst, (force - (at != unit.end() ? Vec3(pressure * at->second) : Vec3(Vec3::Zero()))).norm());
            }
            for (const auto& [node, share] : unit)
                if (!group.force.contains(node)) worst = std::max(worst, (pressure * share).norm());
            constexpr double same = 1e-4; // of the largest force: decks have five digits or so
            const std::string set = worst <= same * largest && largest > 0 ? sets_.of_facets(b, facets, "loaded") : "";
            if (set.empty())
                leave(group.place, fmt::format("*CLOAD on {} nodes of body {}", group.force.size(), body.name),
                      "forces on nodes have a counterpart only where they are those of one pressure");
            else
                stages_[s].pressure[set] = course(units_.stress * pressure, key.second);
        }
    }

    /// Facets at the outside of bodies, by their corners among the points of the deck.
    void find_exterior() {
        for (std::size_t b = 0; b < bodies_.size(); ++b)
            for (std::size_t f = 0; f < bodies_[b].exterior.size(); ++f) {
                const mesh::Facet& facet = bodies_[b].exterior[f];
                std::array<Index, 4> corners{-1, -1, -1, -1};
                for (std::size_t c = 0; c < static_cast<std::size_t>(facet.count); ++c)
                    corners[c] = bodies_[b].points[static_cast<std::size_t>(facet.nodes[c])];
                std::sort(corners.begin(), corners.end());
                exterior_[corners] = {b, static_cast<Index>(f)};
            }
    }

    void add_pressure(std::size_t s, const DeckPressure& p) {
        if (exterior_.empty()) find_exterior();
        std::map<std::size_t, std::vector<Index>> facets;
        std::size_t inside = 0;
        for (const mesh::RawFace& face : p.faces) {
            static constexpr int quarters[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
            for (int part = 0; part < (face.count == 6 ? 4 : 1); ++part) {
                std::array<Index, 4> corners{-1, -1, -1, -1};
                for (int c = 0; c < (face.count == 6 ? 3 : face.count); ++c)
                    corners[static_cast<std::size_t>(c)] =
                        face.nodes[static_cast<std::size_t>(face.count == 6 ? quarters[part][c] : c)];
                std::sort(corners.begin(), corners.end());
                const auto at = exterior_.find(corners);
                if (at == exterior_.end())
                    ++inside;
                else
                    facets[at->second.first].push_back(at->second.second);
            }
        }
        if (inside > 0)
            leave(p.place, fmt::format("pressure on {} faces within '{}'", inside, p.name),
                  "they are not on the outside");
        auto& pressures = model_.steps[s].nlgeom ? stages_[s].follower_pressure : stages_[s].pressure;
        const std::string value = course(units_.stress * p.value, p.amplitude);
        for (const auto& [b, list] : facets) {
            if (const std::string set = sets_.of_facets(b, list, "pressed_" + p.name); !set.empty()) {
                pressures[set] = value;
                continue;
            }
            std::size_t without = 0; // a set each
            for (const Index facet : list) {
                const std::string set = sets_.of_facets(b, {facet}, "pressed_" + p.name);
                if (set.empty())
                    ++without;
                else
                    pressures[set] = value;
            }
            if (without > 0)
                leave(p.place, fmt::format("pressure on {} faces of '{}'", without, p.name),
                      "no set of the mesh has just these faces; give them a *SURFACE");
        }
    }

    void add_gravity(std::size_t s, const DeckGravity& g) {
        for (const DeckBody& body : bodies_) {
            std::vector<Index> in;
            std::vector<Index> sorted = g.cells;
            std::sort(sorted.begin(), sorted.end());
            std::set_intersection(sorted.begin(), sorted.end(), body.cells.begin(), body.cells.end(),
                                  std::back_inserter(in));
            if (in.empty()) continue;
            const auto m =
                body.section == nullptr ? model_.materials.end() : model_.materials.find(body.section->material);
            const double density = m == model_.materials.end() ? 0 : m->second.density;
            if (in.size() != body.cells.size() || !(density > 0)) {
                leave(g.place, "GRAV on body " + body.name,
                      density > 0 ? "gravity acts on whole bodies" : "it has no density");
                continue;
            }
            std::string components;
            for (int d = 0; d < 3; ++d)
                components += (d > 0 ? ", " : "") +
                              course(units_.density * density * units_.length * g.acceleration[d], g.amplitude);
            stages_[s].body_force[body.name] = "[" + components + "]";
        }
    }

    // ---- stages ----

    std::string write_stage(std::size_t s) {
        const DeckStep& step = model_.steps[s];
        constexpr double most_automatic = 100, most = 1e6; // increments; those of no fixed length may grow
        const double ratio = std::ceil(step.duration / step.increment - 1e-9);
        const double steps = std::clamp(ratio, 1.0, step.direct ? most : most_automatic);
        std::string text = fmt::format("  step_{}:\n", s + 1);
        if (step.dynamic)
            text +=
                "    analysis: {dynamic: {integrator: {hht: {alpha: " + number(step.alpha) + "}}}}\n    ramp: step\n";
        text += "    duration: " + number(step.duration) + "\n";
        text += fmt::format("    steps: {}{}\n", static_cast<int>(steps),
                            ratio > steps ? "  # the deck begins with smaller ones" : "");
        const auto map = [&](const char* key, const std::map<std::string, std::string>& values, bool braces) {
            if (values.empty()) return;
            text += fmt::format("    {}:\n", key);
            for (const auto& [name, value] : values)
                text += "      " + name + ": " + (braces ? "{" + value + "}" : value) + "\n";
        };
        map("displacement", stages_[s].displacement, true);
        map("pressure", stages_[s].pressure, false);
        map("follower_pressure", stages_[s].follower_pressure, false);
        map("body_force", stages_[s].body_force, false);
        return text;
    }

    struct StageLoads {
        std::map<std::string, std::string> displacement, pressure, follower_pressure, body_force;
    };

    DeckModel model_;
    std::string path_;
    Units units_;
    std::vector<DeckBody> bodies_;
    DeckSets sets_;
    std::vector<StageLoads> stages_;
    std::map<std::array<Index, 4>, std::pair<std::size_t, Index>> exterior_; ///< body and facet
    bool nlgeom_ = false;
};

} // namespace

ImportedScene import_deck(const mesh::Deck& deck, const std::string& mesh_path, DeckUnits units) {
    return Importer(read_deck_model(deck), mesh_path, units).write();
}

} // namespace osculate::deck
