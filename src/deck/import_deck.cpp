#include "osculate/deck/import_deck.hpp"

#include "deck/bodies.hpp"
#include "deck/body_writer.hpp"
#include "deck/equations.hpp"
#include "deck/general_contact.hpp"
#include "deck/loads.hpp"
#include "deck/rigid_bodies.hpp"
#include "deck/supports.hpp"
#include "deck/words.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <numbers>
#include <set>

namespace osculate::deck {
namespace {

Units units_of(DeckUnits units) {
    return units == DeckUnits::mm ? Units{1e-3, 1e6, 1e12, "mm, t, s, N, MPa"} : Units{1, 1, 1, "SI"};
}

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
        const DeckRigidBodies rigid(model_, bodies_, sets_, units_, stages_);
        const std::string bodies = BodyWriter(model_, bodies_, rigid, units_, path_, nlgeom_).write(),
                          supports = DeckSupports(model_, sets_, units_.length, stages_).write(),
                          contact = write_contact(), ties = write_ties(), rings = write_rings(),
                          equations = write_equations(model_, sets_);
        if (std::ranges::any_of(model_.steps, &DeckStep::dynamic)) damping_ = damping();
        DeckLoads(model_, bodies_, sets_, units_, nlgeom_).write(stages_);
        check_strains();
        ImportedScene scene;
        std::string text =
            fmt::format("# From {}, numbers in {}; everything here is in SI.\n", harmless(path_), units_.words);
        text += "# A body per connected piece of the mesh, named after its instance or its solid section.\n";
        for (const LeftOut& one : model_.left_out) {
            scene.left_out.push_back(harmless(one.place + ": " + one.what + ": " + one.why));
            if (one.lost)
                scene.lost.push_back(scene.left_out.back());
            else
                scene.notes.push_back(scene.left_out.back());
        }
        const auto list = [&](const char* heading, const std::vector<std::string>& lines) {
            if (!lines.empty()) text += fmt::format("# {}:\n#   {}\n", heading, fmt::join(lines, "\n#   "));
        };
        list("Lost", scene.lost);
        list("Not as in the deck", scene.notes);
        text += "bodies:\n" + bodies;
        if (!sets_.yaml().empty()) text += "sets:\n" + sets_.yaml();
        if (!supports.empty()) text += "supports:\n" + supports;
        if (!rigid.couplings().empty()) text += "couplings:\n" + rigid.couplings();
        if (!ties.empty()) text += "ties:\n" + ties;
        if (!rings.empty()) text += "cyclic:\n" + rings;
        if (!equations.empty()) text += "equations:\n" + equations;
        if (!contact.empty()) text += "contact:\n" + contact;
        text += "stages:\n";
        for (std::size_t s = 0; s < model_.steps.size(); ++s) text += write_stage(s);
        scene.text = std::move(text);
        return scene;
    }

private:
    /// A body has one law for all steps.
    void check_strains() {
        std::string large;
        for (std::size_t s = 0; s < model_.steps.size(); ++s)
            if (model_.steps[s].nlgeom) large += (large.empty() ? "" : ", ") + std::to_string(s + 1);
        for (std::size_t s = 0; nlgeom_ && s < model_.steps.size(); ++s)
            if (!model_.steps[s].nlgeom)
                model_.lose(model_.steps[s].place, fmt::format("small strain of step {}, without NLGEOM", s + 1),
                            fmt::format("steps with NLGEOM ({}) make bodies finite strain, and bodies have one law "
                                        "for all steps",
                                        large));
    }

    // ---- contact ----

    static constexpr double most_turn = 7.5 * std::numbers::pi / 180; ///< 48 facets around a circle

    /// Largest angle between neighbouring facets of a surface, rad.
    double largest_turn(std::size_t body, const std::string& surface) {
        const DeckBody& b = bodies_[body];
        std::map<std::pair<Index, Index>, Vec3> across; // normal of the first facet at an edge
        double largest = 0;
        for (const mesh::Facet& facet : facets_of(body, surface)) {
            const Vec3 normal = mesh::facet_normal(facet, b.mesh.nodes);
            for (int c = 0; c < facet.count; ++c) {
                const auto [low, high] = std::minmax(facet.nodes[static_cast<std::size_t>(c)],
                                                     facet.nodes[static_cast<std::size_t>((c + 1) % facet.count)]);
                const auto [at, fresh] = across.try_emplace({low, high}, normal);
                if (!fresh) largest = std::max(largest, std::acos(std::clamp(at->second.dot(normal), -1.0, 1.0)));
            }
        }
        return largest;
    }

    std::string write_contact() {
        std::string text = write_general_contact(model_, bodies_);
        std::set<std::string> taken;
        for (const DeckPair& pair : model_.pairs) {
            if (is_tied(pair)) continue;
            bool any = false;
            for (std::size_t a = 0; a < bodies_.size(); ++a)
                for (std::size_t b = 0; b < bodies_.size(); ++b) {
                    if (a == b) continue;
                    const std::string slave = sets_.of_surface(a, pair.slave),
                                      master = sets_.of_surface(b, pair.master);
                    if (slave.empty() || master.empty()) continue;
                    any = true;
                    if (bodies_[a].rigid != nullptr && bodies_[b].rigid != nullptr) {
                        model_.lose(pair.place, "*CONTACT PAIR of " + pair.slave + " and " + pair.master,
                                    "two rigid bodies do not meet");
                        continue;
                    }
                    const bool mortar = pair.mortar && bodies_[a].mesh.surfaces.contains(surface_name(pair.slave));
                    if (pair.mortar && !mortar)
                        model_.note(
                            pair.place, "surface to surface from the nodes of " + pair.slave,
                            "nodes alone have no facets to take averages over: node to surface is used instead");
                    // nodes of a deck meet the facets of the mesh; averages over facets are the default in statics
                    const std::string name = fresh_name(slave + "_on_" + master, taken);
                    change_pair(pair, name);
                    const double turn = std::max(mortar ? largest_turn(b, pair.master) : 0,
                                                 pair.either ? largest_turn(a, pair.slave) : 0);
                    const bool coarse = turn > most_turn;
                    if (coarse)
                        model_.note(pair.place,
                                    "facets of " + pair.master + " that turn by " +
                                        number(std::round(turn * 180 / std::numbers::pi)) +
                                        " degrees from one to the next",
                                    "as coarse as that, a smooth surface through their nodes is another one: contact "
                                    "takes the facets, as the deck's own program does");
                    text += "  " + name + ":\n";
                    if (pair.either)
                        text +=
                            "    between: [" + slave + ", " + master + "]\n" + (coarse ? "    surface: facets\n" : "");
                    else
                        text += "    slave: " + slave + "\n    master: {set: " + master +
                                (mortar && !coarse ? "" : ", surface: facets") + "}\n";
                    if (!mortar) text += "    discretisation: node  # node to surface\n";
                    if (pair.adjust > 0) text += "    adjust: " + number(units_.length * pair.adjust) + "\n";
                    text += law_of(pair);
                }
            if (!any)
                model_.lose(pair.place, "*CONTACT PAIR of " + pair.slave + " and " + pair.master,
                            "no two pieces of the mesh have them: a body in contact with itself has no counterpart");
        }
        lose_changes_of_nothing();
        return text;
    }

    /// Changes of pairs and interactions that the scene does not have.
    void lose_changes_of_nothing() {
        const auto slides = [&](const auto& is) {
            return std::ranges::any_of(model_.pairs, [&](const DeckPair& pair) { return !is_tied(pair) && is(pair); });
        };
        for (const DeckStep& step : model_.steps) {
            for (const auto& [name, friction] : step.friction)
                if (!slides([&, &name = name](const DeckPair& pair) { return pair.interaction == name; }))
                    model_.lose(step.place, "*CHANGE FRICTION of " + name, "no pair that slides has it");
            for (const auto& [name, law] : step.overclosure)
                if (!slides([&, &name = name](const DeckPair& pair) { return pair.interaction == name; }))
                    model_.lose(step.place, "*CHANGE SURFACE BEHAVIOR of " + name, "no pair that slides has it");
            for (const auto& [slave, master, in_force] : step.pairs)
                if (!slides([&, &slave = slave, &master = master](const DeckPair& pair) {
                        return pair.slave == slave && pair.master == master;
                    }))
                    model_.lose(step.place, "*MODEL CHANGE of " + slave + " and " + master, "no such pair slides");
        }
    }

    /// What the steps change of a pair that the scene calls so.
    void change_pair(const DeckPair& pair, const std::string& name) {
        for (std::size_t s = 0; s < model_.steps.size(); ++s) {
            const DeckStep& step = model_.steps[s];
            if (const auto at = step.friction.find(pair.interaction); at != step.friction.end())
                stages_[s].friction[name] = number(at->second);
            if (const auto at = step.overclosure.find(pair.interaction); at != step.overclosure.end())
                stages_[s].overclosure[name] = overclosure(at->second);
            for (const auto& [slave, master, in_force] : step.pairs)
                if (slave == pair.slave && master == pair.master) stages_[s].pairs[name] = in_force ? "true" : "false";
        }
    }

    std::string write_rings() {
        std::string text;
        std::set<std::string> taken;
        for (const DeckRing& ring : model_.rings) {
            if (ring.sectors == 0) {
                model_.lose(ring.place, "*TIE, CYCLIC SYMMETRY",
                            "no *CYCLIC SYMMETRY MODEL says how many sectors there are");
                continue;
            }
            bool any = false;
            for (std::size_t b = 0; b < bodies_.size(); ++b) {
                const std::string slave = sets_.of_surface(b, ring.slave), master = sets_.of_surface(b, ring.master);
                if (slave.empty() || master.empty()) continue;
                any = true;
                const auto vector = [](const Vec3& v) {
                    return "[" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "]";
                };
                text += fmt::format("  {}: {{slave: {}, master: {}, point: {}, axis: {}, sectors: {}",
                                    fresh_name(slave + "_and_" + master, taken), slave, master,
                                    vector(units_.length * ring.axis[0]), vector(ring.axis[1] - ring.axis[0]),
                                    ring.sectors);
                if (ring.tolerance > 0) text += ", distance: " + number(units_.length * ring.tolerance) + " m";
                text += "}\n";
            }
            if (!any)
                model_.lose(ring.place, "cyclic symmetry of " + ring.slave + " and " + ring.master,
                            "no piece of the mesh has both");
        }
        return text;
    }

    [[nodiscard]] bool is_tied(const DeckPair& pair) const {
        const auto law = model_.interactions.find(pair.interaction);
        return pair.tied || (law != model_.interactions.end() && law->second.tied);
    }

    std::string write_ties() {
        std::string text;
        std::set<std::string> taken;
        std::vector<DeckPair> ties = model_.ties;
        std::ranges::copy_if(model_.pairs, std::back_inserter(ties),
                             [&](const DeckPair& pair) { return is_tied(pair); });
        for (const DeckPair& tie : ties) {
            bool any = false;
            for (std::size_t a = 0; a < bodies_.size(); ++a)
                for (std::size_t b = 0; b < bodies_.size(); ++b) {
                    if (a == b || sets_.of_surface(a, tie.slave).empty() || sets_.of_surface(b, tie.master).empty())
                        continue;
                    any = true;
                    if (bodies_[a].rigid != nullptr || bodies_[b].rigid != nullptr) {
                        model_.lose(tie.place, "tie of " + tie.slave + " and " + tie.master,
                                    "nodes are held to a rigid body by contact or couplings alone");
                        continue;
                    }
                    if (facets_of(a, tie.slave).empty() || facets_of(b, tie.master).empty()) {
                        model_.lose(tie.place, "tie of " + tie.slave + " and " + tie.master,
                                    "nodes that cover no facet of their body cannot be tied");
                        continue;
                    }
                    const std::string slave = sets_.of_surface(a, tie.slave), master = sets_.of_surface(b, tie.master);
                    text += "  " + fresh_name(slave + "_to_" + master, taken) + ": {slave: " + slave +
                            ", master: " + master;
                    if (tie.tolerance > 0) text += ", distance: " + number(units_.length * tie.tolerance) + " m";
                    text += "}\n";
                }
            if (!any)
                model_.lose(tie.place, "tie of " + tie.slave + " and " + tie.master,
                            "no two pieces of the mesh have them: surfaces of one body are not tied");
        }
        return text;
    }

    std::string law_of(const DeckPair& pair) {
        const auto at = model_.interactions.find(pair.interaction);
        if (at == model_.interactions.end()) {
            if (!pair.interaction.empty())
                model_.lose(pair.place, "the law of " + pair.slave + " and " + pair.master,
                            "no *SURFACE INTERACTION is called " + pair.interaction);
            return "";
        }
        const DeckInteraction& law = at->second;
        const double per_length = units_.stress / units_.length;
        const bool statics = std::ranges::none_of(model_.steps, &DeckStep::dynamic);
        std::string text;
        if (law.friction > 0) text += "    friction: " + number(law.friction) + "\n";
        if (law.static_friction > 0) text += "    static_friction: " + number(law.static_friction) + "\n";
        const bool rubs_later = std::ranges::any_of(model_.steps, [&](const DeckStep& step) {
            const auto later = step.friction.find(pair.interaction);
            return later != step.friction.end() && later->second > 0;
        });
        if (!(law.friction > 0) && rubs_later && law.stick > 0 && statics)
            model_.note(pair.place, "stick slope of " + pair.slave + " and " + pair.master,
                        "stick is exact where friction begins in a later step");
        if (law.friction > 0 && law.stick > 0 && statics)
            text += "    stick_stiffness: " + number(per_length * law.stick) + "\n";
        if (law.overclosure.gives_way()) text += "    pressure_overclosure: " + overclosure(law.overclosure) + "\n";
        if (law.stick > 0 && !statics)
            model_.note(pair.place, "stick slope of " + pair.slave + " and " + pair.master,
                        "stick is exact where a step is dynamic");
        if (law.damping > 0 && !law.overclosure.gives_way())
            model_.lose(pair.place, "damping of " + pair.slave + " and " + pair.master,
                        "only pairs that give way have it");
        else if (law.damping > 0 && !statics)
            text += "    damping: " + number(per_length * law.damping) + "\n";
        if (law.tangential_damping > 0 && !statics)
            text += "    tangential_damping: " + number(per_length * law.tangential_damping) + "\n";
        return text;
    }

    std::string overclosure(const DeckOverclosure& law) const {
        switch (law.form) {
        case DeckOverclosure::Form::exact: return "exact";
        case DeckOverclosure::Form::linear:
            return "{linear: {stiffness: " + number(units_.stress / units_.length * law.rows.front()[0]) + "}}";
        case DeckOverclosure::Form::exponential:
            return "{exponential: {clearance: " + number(units_.length * law.rows.front()[0]) +
                   ", pressure: " + number(units_.stress * law.rows.front()[1]) + "}}";
        case DeckOverclosure::Form::tabular: break;
        }
        std::string rows;
        for (const auto& [h, p] : law.rows)
            rows += (rows.empty() ? "[" : ", [") + number(units_.length * h) + ", " + number(units_.stress * p) + "]";
        return "{tabular: {table: [" + rows + "]}}";
    }

    /// Facets of a surface, or those that a set of nodes has all the nodes of.
    std::vector<mesh::Facet> facets_of(std::size_t body, const std::string& key) const {
        const auto& surfaces = bodies_[body].mesh.surfaces;
        if (const auto at = surfaces.find(surface_name(key)); at != surfaces.end()) return at->second;
        const auto name = model_.mesh.node_set_names.find(key);
        if (name == model_.mesh.node_set_names.end()) return {};
        const std::vector<Index>& nodes = bodies_[body].mesh.node_sets.at(name->second);
        std::vector<mesh::Facet> facets;
        std::ranges::copy_if(bodies_[body].exterior, std::back_inserter(facets), [&](const mesh::Facet& facet) {
            return std::ranges::all_of(facet, [&](Index n) { return std::ranges::binary_search(nodes, n); });
        });
        return facets;
    }

    std::string surface_name(const std::string& key) const {
        const auto at = model_.mesh.surface_names.find(key);
        return at == model_.mesh.surface_names.end() ? "" : at->second;
    }

    // ---- stages ----

    /// A stage damps all bodies alike.
    std::string damping() {
        std::set<std::array<double, 2>> all;
        std::string place;
        const auto take = [&](const DeckSection* section) {
            const auto at = section == nullptr ? model_.materials.end() : model_.materials.find(section->material);
            all.insert(at == model_.materials.end() ? std::array{0.0, 0.0} : at->second.damping);
            if (at != model_.materials.end() && at->second.damping != std::array{0.0, 0.0}) place = at->second.place;
        };
        for (const DeckBody& body : bodies_) {
            take(body.section);
            for (const DeckSection* section : body.other_sections) take(section);
        }
        const auto [alpha, beta] = *all.rbegin();
        if (all.size() > 1) {
            model_.lose(place, "*DAMPING of some materials", "a stage damps all bodies alike: none is damped");
            return "";
        }
        return (alpha > 0 ? ", mass_damping: " + number(alpha) : "") +
               (beta > 0 ? ", stiffness_damping: " + number(beta) : "");
    }

    std::string write_stage(std::size_t s) {
        const DeckStep& step = model_.steps[s];
        constexpr double most_automatic = 100, most = 1e6; // increments; those of no fixed length may grow
        const double ratio = std::ceil(step.duration / step.increment - 1e-9);
        const double steps = std::clamp(ratio, 1.0, step.direct ? most : most_automatic);
        std::string text = fmt::format("  step_{}:\n", s + 1);
        if (step.dynamic)
            text +=
                "    analysis: {dynamic: {integrator: {hht: {alpha: " + number(step.alpha) + "}}" + damping_ + "}}\n";
        if (!step.ramps()) text += "    ramp: step\n";
        if (step.dynamic && step.direct) text += "    control: {step_size: fixed}\n";
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
        map("centrifugal", stages_[s].centrifugal, false);
        map("nodal_force", stages_[s].nodal_force, false);
        map("temperature", stages_[s].temperature, false);
        for (auto& [set, components] : stages_[s].release) components = "[" + components + "]";
        map("motion", stages_[s].motion, true);
        map("force", stages_[s].force, false);
        map("moment", stages_[s].moment, false);
        map("release", stages_[s].release, false);
        map("friction", stages_[s].friction, false);
        map("pressure_overclosure", stages_[s].overclosure, false);
        map("pairs", stages_[s].pairs, false);
        return text;
    }

    DeckModel model_;
    std::string path_;
    Units units_;
    std::vector<DeckBody> bodies_;
    DeckSets sets_;
    std::vector<StageLoads> stages_;
    std::string damping_; ///< of dynamic stages
    bool nlgeom_ = false;
};

} // namespace

ImportedScene import_deck(const mesh::Deck& deck, const std::string& mesh_path, DeckUnits units) {
    return Importer(read_deck_model(deck), mesh_path, units).write();
}

} // namespace osculate::deck
