/// Rules that join several keys of contact.

#include "osculate/scene/nearest.hpp"
#include "osculate/scene/units.hpp"
#include "scene/rules.hpp"

#include <algorithm>

namespace osculate::scene {

namespace {

class ContactRules : public Rules {
public:
    using Rules::Rules;

    void check_pair(const std::string& name, const Pair& pair) {
        check_sides(name, pair);
        if (const auto* rpim = std::get_if<RpimSurface>(&pair.master.surface)) check_basis(name, "rpim", *rpim);
        if (const auto* blend = std::get_if<BlendSurface>(&pair.master.surface)) check_basis(name, "blend", *blend);
    }

    /// Slave and master, or two sides without roles.
    void check_sides(const std::string& name, const Pair& pair) {
        const auto written = [&](std::vector<std::string> path) {
            path.insert(path.begin(), {"contact", name});
            return has(path);
        };
        const bool slave = written({"slave"}), exact = written({"master", "rigid_surface"}),
                   master = written({"master", "set"}) || exact;
        if (exact && written({"master", "set"}))
            fault({"contact", name, "master", "set"}, "set or rigid_surface", "both");
        if (exact && pair.discretisation && *pair.discretisation != Discretisation::node)
            fault({"contact", name, "discretisation"},
                  "node: gaps to a rigid surface are exact at the slave nodes, and its pressure needs no averaging",
                  "another one");
        if (written({"between"})) {
            if (slave) fault({"contact", name, "slave"}, "between, or slave and master", "both");
            if (master)
                fault({"contact", name, "master", exact ? "rigid_surface" : "set"}, "between, or slave and master",
                      "both");
            if (!pair.between[0].empty() && pair.between[0] == pair.between[1])
                fault({"contact", name, "between"}, "two sets", "'" + pair.between[0] + "' twice");
            return;
        }
        if (!slave) fault({"contact", name, "slave"}, "the name of a set, or between with two", "nothing");
        if (!master) fault({"contact", name, "master", "set"}, "the name of a set, or between with two", "nothing");
        if (!pair.slave.empty() && pair.slave == pair.master.set)
            fault({"contact", name, "slave"}, "another set than the master's", "'" + pair.slave + "' for both");
    }

    void check_general(const GeneralContact& general, const Named<Body>& bodies) {
        Words known;
        for (const auto& [name, body] : bodies) {
            known.push_back(name);
            if (!body.finish.empty()) known.push_back(body.finish);
        }
        check_static({"contact", "general", "static_friction"}, general.friction, general.static_friction);
        for (const auto& [name, rule] : general.pairs)
            check_static({"contact", "general", "pairs", name, "static_friction"},
                         rule.friction.value_or(general.friction), rule.static_friction);
        for (const auto& [name, rule] : general.pairs)
            for (const std::string& side : rule.between)
                if (!side.empty() && std::ranges::count(known, side) == 0) {
                    fault({"contact", "general", "pairs", name, "between"}, "bodies or finishes", "'" + side + "'");
                    faults_.back().nearest = nearest(side, known);
                }
        for (std::size_t a = 0; a < bodies.size(); ++a)
            for (std::size_t b = a + 1; b < bodies.size(); ++b)
                if (bodies[a].second.rigid && bodies[b].second.rigid && !bodies[a].second.rigid_surface &&
                    !bodies[b].second.rigid_surface && may_meet(general, bodies[a], bodies[b]))
                    fault({"contact", "general"},
                          "a rule of contact.general.pairs with `contact: false` for every two rigid bodies: they have "
                          "no "
                          "contact pressure of their own",
                          "none for '" + bodies[a].first + "' and '" + bodies[b].first + "'");
    }

    [[nodiscard]] static bool may_meet(const GeneralContact& general, const Named<Body>::value_type& one,
                                       const Named<Body>::value_type& other) {
        const auto is = [](const std::string& side, const Named<Body>::value_type& body) {
            return side == body.first || side == body.second.finish;
        };
        bool meet = true;
        for (const auto& [name, rule] : general.pairs)
            if ((is(rule.between[0], one) && is(rule.between[1], other)) ||
                (is(rule.between[0], other) && is(rule.between[1], one)))
                meet = rule.contact;
        return meet;
    }

    template <class Surface> void check_basis(const std::string& name, const char* tag, const Surface& surface) {
        const auto key = [&](const char* last) {
            return std::vector<std::string>{"contact", name, "master", "surface", tag, last};
        };
        const auto q = key("q");
        if (surface.basis == RadialBasis::r3 || surface.basis == RadialBasis::r5) {
            const Surface defaults;
            if (surface.R != defaults.R) fault(key("R"), "basis multiquadric with R", "another basis");
            if (surface.q != defaults.q) fault(q, "basis multiquadric with q", "another basis");
            if (surface.basis == RadialBasis::r5 && surface.m < 6) fault(key("m"), "6 with basis r5", "3");
            return;
        }
        // (r^2 + R^2)^q is conditionally definite of order ceil(q); the basis must hold all polynomials of lower degree.
        if (surface.q > 2 && surface.m < 6) fault(q, "at most 2 with m = 3", number_text(surface.q));
        if (surface.R == 0 && surface.q < 1) fault(q, "more than 1 with R = 0", number_text(surface.q));
    }

    void check_overclosure(const Scene& scene) {
        const auto dynamic = std::ranges::find_if(scene.stages, [](const auto& stage) {
            return std::holds_alternative<DynamicAnalysis>(stage.second.analysis);
        });
        for (const auto& [name, pair] : scene.contact) {
            if (pair.damping > 0 && std::holds_alternative<ExactContact>(pair.pressure_overclosure))
                fault({"contact", name, "damping"}, "a pressure_overclosure beside it that gives way", "exact contact");
            if (pair.damping > 0 && dynamic == scene.stages.end())
                fault({"contact", name, "damping"}, "none where no stage is dynamic",
                      number_text(pair.damping) + " Pa s/m");
            if (pair.tangential_damping > 0 && dynamic == scene.stages.end())
                fault({"contact", name, "tangential_damping"}, "none where no stage is dynamic",
                      number_text(pair.tangential_damping) + " Pa s/m");
            check_static({"contact", name, "static_friction"}, pair.friction, pair.static_friction);
            check_rows({"contact", name, "pressure_overclosure"}, pair.pressure_overclosure);
            // the energy of elastic stick is in no ledger
            if (dynamic != scene.stages.end() && pair.stick_stiffness)
                fault({"contact", name, "stick_stiffness"}, "none where a stage is dynamic",
                      "one, with the dynamic stage " + dynamic->first);
            if (pair.stick_stiffness && !(pair.friction > 0))
                fault({"contact", name, "stick_stiffness"}, "friction above 0 beside it", "no friction");
        }
    }
    void check_static(const std::vector<std::string>& key, double friction, const std::optional<double>& at_rest) {
        if (!at_rest) return;
        if (!(friction > 0))
            fault(key, "friction above 0 beside it", "no friction");
        else if (*at_rest < friction)
            fault(key, "at least friction, " + number_text(friction), number_text(*at_rest));
    }
    void check_rows(std::vector<std::string> key, const PressureOverclosure& law) {
        const auto* tabular = std::get_if<TabularOverclosure>(&law);
        if (tabular == nullptr || tabular->table.rows.empty()) return;
        const auto& rows = tabular->table.rows;
        key.insert(key.end(), {"tabular", "table"});
        if (rows.front()[1] != 0)
            fault(key, "a first row without pressure, where it begins", number_text(rows.front()[1]) + " Pa");
        const auto at = std::ranges::adjacent_find(rows, [](const auto& a, const auto& b) { return !(a[1] < b[1]); });
        if (at != rows.end())
            fault(key, "pressures that grow from row to row",
                  "one of " + number_text((at + 1)->at(1)) + " Pa that does not");
    }
    /// What the exact law needs of a pair is settled before the first stage.
    void check_changes_of_laws(const Scene& scene, const std::string& name, const Stage& stage) {
        for (const auto& [pair, friction] : stage.friction) {
            const Pair* of = find(scene.contact, pair);
            if (of == nullptr || !of->static_friction || (friction > 0 && friction <= *of->static_friction)) continue;
            fault({"stages", name, "friction", pair},
                  "above 0, at most the pair's static_friction, " + number_text(*of->static_friction),
                  number_text(friction));
        }
        for (const auto& [pair, law] : stage.pressure_overclosure) {
            const std::vector<std::string> key{"stages", name, "pressure_overclosure", pair};
            check_rows(key, law);
            const Pair* of = find(scene.contact, pair);
            if (of == nullptr) {
                fault(key, "a pair that the scene names", pair == "general" ? "general contact" : "another");
                continue;
            }
            const auto exact = [](const PressureOverclosure& one) { return std::holds_alternative<ExactContact>(one); };
            if (exact(law) != exact(of->pressure_overclosure))
                fault(key,
                      exact(law) ? "a law that gives way, as that of the pair" : "a pair that gives way from the start",
                      exact(law) ? "exact" : "one that is exact");
        }
    }

    /// Masters that are exact surfaces.
    void check_exact_masters(const Scene& scene) {
        for (const auto& [name, pair] : scene.contact) {
            if (pair.master.rigid_surface.empty()) continue;
            const Body* body = find(scene.bodies, pair.master.rigid_surface);
            if (body != nullptr && !body->rigid_surface)
                fault({"contact", name, "master", "rigid_surface"}, "a body with a rigid_surface",
                      "'" + pair.master.rigid_surface + "', which has a mesh: name a set of it as master.set");
        }
        for (const auto& [name, set] : scene.sets)
            if (const Body* body = find(scene.bodies, set.body); body != nullptr && body->rigid_surface)
                fault({"sets", name, "body"},
                      "a body with a mesh: contact.<pair>.master.rigid_surface names the whole "
                      "surface of '" +
                          set.body + "'",
                      "a body with a rigid_surface");
    }
};

} // namespace

void check_contact(const Scene& scene, const Tree& tree, std::vector<Fault>& faults) {
    ContactRules rules(tree, faults);
    rules.check_exact_masters(scene);
    rules.check_overclosure(scene);
    for (const auto& [name, pair] : scene.contact) rules.check_pair(name, pair);
    if (scene.general) rules.check_general(*scene.general, scene.bodies);
    for (const auto& [name, stage] : scene.stages) rules.check_changes_of_laws(scene, name, stage);
}

} // namespace osculate::scene
