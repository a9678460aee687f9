#include "deck/loads.hpp"

#include "deck/words.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

namespace osculate::deck {
namespace {

const char* const on_elements = "DLOAD";
const char* const on_surfaces = "DSLOAD";
const char* const on_nodes = "CLOAD";

} // namespace

std::string end_components(std::array<LoadHistory, 3>& components, const DeckStep& step) {
    std::array<std::string, 3> courses;
    bool any = false;
    for (std::size_t d = 0; d < 3; ++d) {
        courses[d] = components[d].end_step(step.duration, step.ramps());
        any = any || !courses[d].empty();
        if (courses[d].empty()) courses[d] = number(components[d].standing());
    }
    return any ? fmt::format("[{}]", fmt::join(courses, ", ")) : "";
}

DeckLoads::DeckLoads(DeckModel& model, const std::vector<DeckBody>& bodies, DeckSets& sets, const Units& units,
                     bool follow)
    : model_(model), bodies_(bodies), sets_(sets), units_(units), follow_(follow), gravity_(bodies.size()) {
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

void DeckLoads::write(std::vector<StageLoads>& stages) {
    for (std::size_t s = 0; s < model_.steps.size(); ++s) {
        const DeckStep& step = model_.steps[s];
        forget(step);
        add_pressures(step);
        add_forces(step);
        add_gravity(step);
        add_centrifugal(step, stages[s]);
        end_step(s, stages[s]);
    }
    write_pressures(stages);
    write_forces(stages);
    write_temperatures(stages);
}

void DeckLoads::forget(const DeckStep& step) {
    for (auto& [key, load] : facets_) {
        if (step.forget_on_elements) load.history.remove(on_elements);
        if (step.forget_on_surfaces) load.history.remove(on_surfaces);
    }
    if (step.forget_on_elements)
        for (auto& body : gravity_)
            for (LoadHistory& component : body) component.remove_all();
    if (step.forget_forces)
        for (auto& [point, force] : forces_)
            for (LoadHistory& component : force.components) component.remove_all();
}

DeckLoads::FacetLoad& DeckLoads::facet_load(const FacetKey& key, const std::string& name, const std::string& place) {
    FacetLoad& load = facets_[key];
    if (load.place.empty()) {
        load.place = place;
        load.courses.resize(model_.steps.size());
    }
    load.names.insert(name);
    return load;
}

/// On the outside of bodies, each once.
std::set<std::pair<std::size_t, Index>> DeckLoads::facets_of(const DeckPressure& p) {
    std::set<std::pair<std::size_t, Index>> facets;
    std::size_t inside = 0;
    for (const mesh::RawFace& face : p.faces) {
        mesh::for_each_piece(face.nodes, face.count, [&](std::array<Index, 4> corners, int) {
            std::sort(corners.begin(), corners.end());
            const auto at = exterior_.find(corners);
            if (at == exterior_.end())
                ++inside;
            else
                facets.insert(at->second);
        });
    }
    if (inside > 0)
        model_.lose(p.place, fmt::format("pressure on {} faces within '{}'", inside, p.name),
                    "they are not on the outside");
    return facets;
}

void DeckLoads::add_pressures(const DeckStep& step) {
    Repeated again, beside;
    for (const DeckPressure& p : step.pressures) {
        const bool of_surface = p.keyword == on_surfaces;
        const char* const other = of_surface ? on_elements : on_surfaces;
        const bool forgotten = of_surface ? step.forget_on_elements : step.forget_on_surfaces;
        for (const auto& [body, facet] : facets_of(p)) {
            FacetLoad& load = facet_load({follow_, body, facet}, "pressed_" + p.name, p.place);
            if (load.history.gives(p.keyword)) again.count(p.place);
            if (!forgotten && load.history.standing(other) != 0) beside.count(p.place);
            load.history.add(p.keyword, units_.stress * p.value, model_.amplitude(p.amplitude));
        }
    }
    if (again.faces > 0)
        model_.note(again.place, fmt::format("pressure on {} faces that the step loads already", again.faces),
                    "they add, as in Abaqus and CalculiX; early versions of CalculiX keep the last");
    if (beside.faces > 0)
        model_.note(beside.place,
                    fmt::format("pressure by *DLOAD and *DSLOAD on {} faces that an earlier step loads by the other",
                                beside.faces),
                    "they add, as in Abaqus; in CalculiX the later takes the place of the earlier");
}

/// Forces that a step gives take the place of those before it, node by node and component by component.
void DeckLoads::add_forces(const DeckStep& step) {
    for (const DeckValues& f : step.forces) {
        std::size_t without = 0;
        std::size_t of_rigid = 0;
        for (const Index p : f.points) {
            if (sets_.body_of(p) < 0) {
                ++without;
                continue;
            }
            if (sets_.is_rigid(p)) {
                ++of_rigid;
                continue;
            }
            NodeForce& force = forces_[p];
            if (force.place.empty()) {
                force.place = f.place;
                force.courses.resize(model_.steps.size());
            }
            // in a body of revolution that of the whole circle
            const bool revolves =
                bodies_[static_cast<std::size_t>(sets_.body_of(p))].slice == mesh::DeckSlice::axisymmetric;
            const double part = revolves ? mesh::DeckMesh::sector_angle / 360 : 1;
            const Mat3 axes = model_.axes_of(p);
            if (f.first < 2 && model_.on_axis(p)) {
                model_.lose(f.place, "*CLOAD on a node on the axis of its *TRANSFORM", "no direction there is radial");
                continue;
            }
            for (int k = 0; k < 3; ++k) // what a step gives along an axis takes the place of what was given along it
                if (const double share = axes(k, f.first); share != 0)
                    force.components[static_cast<std::size_t>(k)].add(fmt::format("{} {}", on_nodes, f.first),
                                                                      units_.force() * part * share * f.value,
                                                                      model_.amplitude(f.amplitude));
        }
        if (of_rigid > 0 && f.value != 0)
            model_.lose(f.place, fmt::format("*CLOAD on {} nodes of rigid bodies", of_rigid),
                        "forces act at the reference point");
        if (without > 0 && f.value != 0)
            model_.lose(f.place, fmt::format("*CLOAD on {} nodes", without), "no element has them");
    }
}

std::vector<const DeckMaterial*> DeckLoads::materials(const DeckBody& body) const {
    std::vector<const DeckMaterial*> all;
    const auto take = [&](const DeckSection* section) {
        if (section == nullptr) return;
        if (const auto at = model_.materials.find(section->material); at != model_.materials.end())
            all.push_back(&at->second);
    };
    take(body.section);
    for (const DeckSection* section : body.other_sections) take(section);
    return all;
}

double DeckLoads::density(const DeckBody& body) const {
    double largest = 0;
    for (const DeckMaterial* m : materials(body)) largest = std::max(largest, m->density);
    return largest;
}

void DeckLoads::add_gravity(const DeckStep& step) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const DeckBody& body = bodies_[b];
        std::vector<const DeckGravity*> parts;
        for (const DeckGravity& g : step.gravity) {
            std::vector<Index> in, sorted = g.cells;
            std::sort(sorted.begin(), sorted.end());
            std::set_intersection(sorted.begin(), sorted.end(), body.cells.begin(), body.cells.end(),
                                  std::back_inserter(in));
            if (in.empty()) continue;
            if (!(density(body) > 0) && body.rigid != nullptr) {
                model_.note(g.place, "GRAV on rigid body " + body.name, "it has no mass");
                continue;
            }
            if (!(density(body) > 0)) {
                model_.lose(g.place, "GRAV on body " + body.name, "it has no density");
            } else if (std::ranges::any_of(materials(body),
                                           [&](const auto* m) { return m->density != density(body); })) {
                model_.lose(g.place, "GRAV on body " + body.name,
                            "a force per volume is the same in all of a body, and "
                            "its materials differ in density");
            } else if (in.size() != body.cells.size()) {
                parts.push_back(&g);
            } else {
                Vec3 before;
                for (std::size_t d = 0; d < 3; ++d) before[static_cast<Index>(d)] = gravity_[b][d].standing(g.elements);
                constexpr double parallel = 1e-10; // as CalculiX takes it
                if (!step.forget_on_elements &&
                    before.cross(g.acceleration).norm() > parallel * before.norm() * g.acceleration.norm())
                    model_.note(g.place, "GRAV on body " + body.name + " in another direction than in an earlier step",
                                "it takes the place of the earlier, as in Abaqus; in CalculiX they add");
                add_acceleration(b, g.elements, g.acceleration, g.amplitude);
            }
        }
        if (!parts.empty()) add_partial_gravity(b, parts);
    }
}

void DeckLoads::add_partial_gravity(std::size_t b, const std::vector<const DeckGravity*>& parts) {
    const DeckBody& body = bodies_[b];
    using Sum = std::map<std::string, Vec3>; // by amplitude
    std::map<Index, Sum> of_cell;
    std::set<std::string> names;
    for (const DeckGravity* g : parts) {
        names.insert(g->elements);
        for (const Index c : g->cells)
            of_cell[c].try_emplace(g->amplitude, Vec3::Zero()).first->second += g->acceleration;
    }
    const Sum& first = of_cell[body.cells.front()];
    const bool same = std::ranges::all_of(body.cells, [&](Index c) { return of_cell[c] == first; });
    if (!same) {
        for (const DeckGravity* g : parts)
            model_.lose(g->place, "GRAV on body " + body.name, "gravity acts on whole bodies");
        return;
    }
    for (const auto& [amplitude, acceleration] : first)
        add_acceleration(b, fmt::format("{}", fmt::join(names, "+")), acceleration, amplitude);
}

void DeckLoads::add_centrifugal(const DeckStep& step, StageLoads& stage) {
    const auto vector = [](const Vec3& v) {
        return "[" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "]";
    };
    const auto write = [&](std::size_t b, const Vec3& point, const Vec3& axis, double speed) {
        stage.centrifugal[bodies_[b].name] =
            "{point: " + vector(point) + ", axis: " + vector(axis) + ", speed: " + number(speed) + "}";
    };
    if (step.forget_on_elements) {
        for (const std::size_t b : turning_) write(b, Vec3::Zero(), Vec3::UnitZ(), 0);
        turning_.clear();
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const DeckBody& body = bodies_[b];
        const DeckCentrifugal* last = nullptr;
        for (const DeckCentrifugal& c : step.centrifugal) {
            std::vector<Index> in, sorted = c.cells;
            std::sort(sorted.begin(), sorted.end());
            std::set_intersection(sorted.begin(), sorted.end(), body.cells.begin(), body.cells.end(),
                                  std::back_inserter(in));
            if (in.empty()) continue;
            if (!(density(body) > 0))
                model_.lose(c.place, "CENTRIF on body " + body.name, "it has no density");
            else if (in.size() != body.cells.size())
                model_.lose(c.place, "CENTRIF on part of body " + body.name, "centrifugal forces act on whole bodies");
            else if (last != nullptr)
                model_.lose(c.place, "CENTRIF twice on body " + body.name, "a body turns about one axis");
            else
                last = &c;
        }
        if (last == nullptr) continue;
        turning_.insert(b);
        write(b, units_.length * last->point, last->axis, std::sqrt(last->square));
    }
}

void DeckLoads::add_acceleration(std::size_t b, const std::string& origin, const Vec3& acceleration,
                                 const std::string& amplitude) {
    const double per_volume = units_.density * density(bodies_[b]) * units_.length;
    for (std::size_t d = 0; d < 3; ++d)
        gravity_[b][d].add(origin, per_volume * acceleration[static_cast<Index>(d)], model_.amplitude(amplitude));
}

void DeckLoads::end_step(std::size_t s, StageLoads& stage) {
    const DeckStep& step = model_.steps[s];
    for (auto& [key, load] : facets_) load.courses[s] = load.history.end_step(step.duration, step.ramps());
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (const std::string course = end_components(gravity_[b], step); !course.empty())
            stage.body_force[bodies_[b].name] = course;
    for (auto& [point, force] : forces_) force.courses[s] = end_components(force.components, step);
}

/// Nodes of a body with the same history are a set.
void DeckLoads::write_forces(std::vector<StageLoads>& stages) {
    std::map<std::pair<int, std::vector<std::string>>, std::vector<Index>> groups;
    for (const auto& [point, force] : forces_) groups[{sets_.body_of(point), force.courses}].push_back(point);
    for (const auto& [key, points] : groups)
        for (const std::string& set : sets_.of_points(static_cast<std::size_t>(key.first), points, "loaded"))
            for (std::size_t s = 0; s < stages.size(); ++s)
                if (!key.second[s].empty()) stages[s].nodal_force[set] = key.second[s];
}

/// Above those at the start, for bodies that expand. Nodes of a body that are as warm in all steps are a set, or the body.
void DeckLoads::write_temperatures(std::vector<StageLoads>& stages) {
    if (std::ranges::all_of(model_.steps, [](const DeckStep& step) { return step.temperatures.empty(); })) return;
    const auto points = static_cast<std::size_t>(model_.mesh.raw.points.size());
    std::vector<double> start(points, 0);
    for (const DeckTemperature& t : model_.initial_temperatures)
        for (const Index p : t.points) start[static_cast<std::size_t>(p)] = t.value;
    std::vector<std::vector<double>> history(points); // by step
    std::vector<double> now = start;
    for (const DeckStep& step : model_.steps) {
        for (const DeckTemperature& t : step.temperatures)
            for (const Index p : t.points) now[static_cast<std::size_t>(p)] = t.value;
        for (std::size_t p = 0; p < points; ++p) history[p].push_back(now[p]);
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const std::vector<const DeckMaterial*> all = materials(bodies_[b]);
        const auto expands = std::ranges::find_if(all, [](const DeckMaterial* m) { return m->expansion != 0; });
        if (expands == all.end()) continue;
        const DeckMaterial& m = **expands;
        for (const DeckMaterial* other : all)
            if (other->expansion != 0 && other != &m && !(other->expansions.empty() && m.expansions.empty()))
                model_.lose(other->place, "*EXPANSION of several materials in body " + bodies_[b].name,
                            "one that depends on temperature is the only one of its body");
        // strain at a temperature, of that from which expansions count, over the expansion of the scene
        const auto grown = [&](double T) {
            return m.expansions.empty() ? T : interpolated(m.expansions, T, 1) * (T - m.zero) / m.expansion;
        };
        std::map<std::vector<std::string>, std::vector<Index>> groups;
        for (const Index p : bodies_[b].points) {
            const auto i = static_cast<std::size_t>(p);
            std::vector<std::string> values;
            for (const double T : history[i]) values.push_back(number(grown(T) - grown(start[i])));
            groups[values].push_back(p);
        }
        for (const auto& [values, alike] : groups) {
            const bool whole = alike.size() == bodies_[b].points.size();
            const std::vector<std::string> names =
                whole ? std::vector<std::string>{bodies_[b].name} : sets_.of_points(b, alike, "warm");
            for (const std::string& name : names)
                for (std::size_t s = 0; s < stages.size(); ++s)
                    if (values[s] != (s == 0 ? "0" : values[s - 1])) stages[s].temperature[name] = values[s];
        }
    }
}

void DeckLoads::write_pressures(std::vector<StageLoads>& stages) {
    struct Group {
        std::vector<Index> facets;
        std::string name, place;
    };
    using History = std::tuple<bool, std::size_t, std::vector<std::string>>; // follows, body, courses
    std::map<std::pair<History, std::string>, Group> groups;
    for (const auto& [key, load] : facets_) {
        const std::string name = fmt::format("{}", fmt::join(load.names, "_"));
        Group& group = groups[{{key.follows, key.body, load.courses}, name}];
        if (group.facets.empty()) group = {{}, name, load.place};
        group.facets.push_back(key.facet);
    }
    const auto write = [&](const History& history, const std::string& set) {
        const auto& [follows, body, courses] = history;
        for (std::size_t s = 0; s < courses.size(); ++s)
            if (!courses[s].empty()) (follows ? stages[s].follower_pressure : stages[s].pressure)[set] = courses[s];
    };
    // Loads by their names first; those that are no set by themselves, together where they have one history; at last a set
    // each.
    std::map<History, std::vector<Group>> rest;
    for (auto& [key, group] : groups) {
        const std::string set = sets_.of_facets(std::get<1>(key.first), group.facets, group.name);
        if (set.empty())
            rest[key.first].push_back(std::move(group));
        else
            write(key.first, set);
    }
    for (const auto& [history, alike] : rest) {
        const std::size_t body = std::get<1>(history);
        std::vector<Index> all;
        for (const Group& group : alike) all.insert(all.end(), group.facets.begin(), group.facets.end());
        std::sort(all.begin(), all.end());
        if (alike.size() > 1)
            if (const std::string set = sets_.of_facets(body, all, alike.front().name); !set.empty()) {
                write(history, set);
                continue;
            }
        for (const Group& group : alike) {
            std::size_t without = 0;
            for (const Index facet : group.facets) {
                const std::string set = sets_.of_facets(body, {facet}, group.name);
                if (set.empty())
                    ++without;
                else
                    write(history, set);
            }
            if (without > 0)
                model_.lose(group.place, fmt::format("load on {} faces of '{}'", without, group.name),
                            "no set of the mesh has just these faces; give them a *SURFACE");
        }
    }
}

} // namespace osculate::deck
