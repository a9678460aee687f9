#include "deck/rigid_bodies.hpp"

#include "deck/words.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace osculate::deck {
namespace {

constexpr std::array<const char*, 6> component_words{"x", "y", "z", "rx", "ry", "rz"};

} // namespace

DeckRigidBodies::DeckRigidBodies(DeckModel& model, const std::vector<DeckBody>& bodies, DeckSets& sets,
                                 const Units& units, std::vector<StageLoads>& stages)
    : model_(model), units_(units) {
    for (const DeckBody& body : bodies) taken_.insert(body.name);
    const bool dynamic = std::ranges::any_of(model.steps, &DeckStep::dynamic);
    for (std::size_t r = 0; r < model.rigid.size(); ++r) {
        const Motion& motion = motions_.emplace_back(motion_of(r));
        if (model.rigid[r].couples()) {
            couple(r, bodies, sets, stages);
            continue;
        }
        const std::string& place = model.rigid[r].place;
        std::vector<const DeckBody*> own;
        for (const DeckBody& body : bodies)
            if (body.rigid == &model.rigid[r]) own.push_back(&body);
        const bool follows = std::ranges::all_of(motion.held, [](bool held) { return held; });
        if (own.size() > 1 && !follows)
            model.lose(place, "*RIGID BODY of several pieces",
                       "pieces that move as one must be held or driven in all six components");
        for (const DeckBody* body : own) {
            if (dynamic && !(density(*body) > 0))
                model.lose(place, "*RIGID BODY " + body->name,
                           "dynamics need its mass: give bodies." + body->name +
                               ".rigid a mass, a centre and an inertia");
            put(body->name, motion, stages);
        }
    }
}

void DeckRigidBodies::put(const std::string& name, const Motion& motion, std::vector<StageLoads>& stages) const {
    for (std::size_t s = 0; s < stages.size(); ++s) {
        if (!motion.motions[s].empty()) stages[s].motion[name] = motion.motions[s];
        if (!motion.forces[s].empty()) stages[s].force[name] = motion.forces[s];
        if (!motion.moments[s].empty()) stages[s].moment[name] = motion.moments[s];
    }
}

void DeckRigidBodies::couple(std::size_t rigid, const std::vector<DeckBody>& bodies, DeckSets& sets,
                             std::vector<StageLoads>& stages) {
    const DeckRigid& one = model_.rigid[rigid];
    const Motion& motion = motions_[rigid];
    std::set<int> of;
    for (const Index p : one.points) of.insert(sets.body_of(p));
    of.erase(-1);
    const auto lose = [&](const char* why) { model_.lose(one.place, "the coupling of " + one.set, why); };
    if (of.size() != 1)
        return lose(of.empty() ? "no element has its nodes" : "it has nodes of several pieces of the mesh");
    const auto body = static_cast<std::size_t>(*of.begin());
    if (bodies[body].rigid != nullptr) return lose("its nodes are those of a rigid body");
    if (bodies[body].slice != mesh::DeckSlice::none) return lose("its nodes are those of plane elements");
    if (one.distributing && std::ranges::any_of(motion.held, [](bool held) { return held; }))
        return lose("a distributing coupling has forces and moments alone: its reference node is held or moved");
    if (one.distributing && std::ranges::any_of(motion.motions, [](const std::string& m) { return !m.empty(); }))
        return lose("a distributing coupling has forces and moments alone: its reference node is moved");
    const bool large = std::ranges::any_of(model_.steps, &DeckStep::nlgeom);
    if (one.distributing && large) return lose("with NLGEOM bodies are of finite strain, whose loads turn with them");
    if (!one.distributing && !large)
        model_.note(one.place, "the coupling of " + one.set,
                    "its rotation is exact; without NLGEOM it is linear there");
    std::string set = sets.of_surface(body, one.set);
    if (set.empty()) {
        std::vector<Index> points = one.points;
        std::erase_if(points, [&](Index p) { return sets.body_of(p) < 0; });
        const std::vector<std::string> all = sets.of_points(body, points, "coupled");
        if (all.size() != 1) return lose("no one set of a scene has just these nodes");
        set = all.front();
    }
    const std::string name = fresh_name(set + "_coupling", taken_);
    couplings_ += fmt::format("  {}: {{set: {}, {}reference_point: {}{}}}\n", name, set,
                              one.distributing ? "kind: distributing, " : "", at_reference(rigid), fixed(motion));
    put(name, motion, stages);
}

std::string DeckRigidBodies::at_reference(std::size_t rigid) const {
    const Vec3 x = units_.length * model_.mesh.raw.points[static_cast<std::size_t>(model_.rigid[rigid].reference)];
    return fmt::format("[{}, {}, {}]", number(x[0]), number(x[1]), number(x[2]));
}

std::string DeckRigidBodies::fixed(const Motion& motion) const {
    std::string words;
    for (std::size_t c = 0; c < component_words.size(); ++c)
        if (motion.fixed[c]) words += (words.empty() ? "" : ", ") + std::string(component_words[c]);
    return words.empty() ? "" : ", fix: [" + words + "]";
}

std::string DeckRigidBodies::of(const DeckBody& body) const {
    const auto r = static_cast<std::size_t>(body.rigid - model_.rigid.data());
    std::string text = "{reference_point: " + at_reference(r) + fixed(motions_[r]);
    if (const double rho = density(body); rho > 0) text += ", density: " + number(rho);
    return text + "}";
}

double DeckRigidBodies::density(const DeckBody& body) const {
    const auto at = body.section == nullptr ? model_.materials.end() : model_.materials.find(body.section->material);
    return at == model_.materials.end() ? 0 : units_.density * at->second.density;
}

DeckRigidBodies::Motion DeckRigidBodies::motion_of(std::size_t rigid) {
    Motion motion;
    for (auto* list : {&motion.motions, &motion.forces, &motion.moments}) list->resize(model_.steps.size());
    for (std::size_t c = 0; c < component_words.size(); ++c) hold(rigid, c, motion);
    load(rigid, motion);
    return motion;
}

void DeckRigidBodies::hold(std::size_t rigid, std::size_t component, Motion& motion) {
    struct Given {
        std::size_t step;
        const DeckRigidValue* value;
    };
    std::vector<Given> all;
    const auto take = [&](const std::vector<DeckRigidValue>& list, std::size_t step) {
        for (const DeckRigidValue& v : list)
            if (v.rigid == rigid && v.component == static_cast<int>(component)) {
                if (!all.empty() && all.back().step == step) all.pop_back(); // the last of a step counts
                all.push_back({step, &v});
            }
    };
    take(model_.rigid_held, 0);
    for (std::size_t s = 0; s < model_.steps.size(); ++s) {
        take(model_.steps[s].rigid_held, s);
        if (model_.steps[s].forget_held && !all.empty() && all.back().step != s)
            model_.lose(model_.steps[s].place,
                        fmt::format("OP=NEW, which lets go of {} of a rigid body", component_words[component]),
                        "a rigid body is held or driven for the rest of the run");
    }
    if (all.empty()) return;
    motion.held[component] = all.front().step == 0;
    motion.fixed[component] =
        all.front().step == 0 && std::ranges::all_of(all, [](const Given& g) { return g.value->value == 0; });
    if (motion.fixed[component]) return;
    const double unit = component < 3 ? units_.length : 1;
    for (const auto& [step, value] : all)
        motion.motions[step] += (motion.motions[step].empty() ? "" : ", ") + std::string(component_words[component]) +
                                ": " + course(unit * value->value, model_.amplitude(value->amplitude));
}

void DeckRigidBodies::load(std::size_t rigid, Motion& motion) {
    std::array<LoadHistory, 3> forces, moments;
    for (std::size_t s = 0; s < model_.steps.size(); ++s) {
        const DeckStep& step = model_.steps[s];
        if (step.forget_forces)
            for (auto* list : {&forces, &moments})
                for (LoadHistory& one : *list) one.remove_all();
        for (const DeckRigidValue& v : step.rigid_forces) {
            if (v.rigid != rigid) continue;
            const bool turns = v.component >= 3;
            (turns ? moments : forces)[static_cast<std::size_t>(v.component % 3)].add(
                "CLOAD", units_.force() * (turns ? units_.length : 1) * v.value, model_.amplitude(v.amplitude));
        }
        motion.forces[s] = end_components(forces, step);
        motion.moments[s] = end_components(moments, step);
    }
}

} // namespace osculate::deck
