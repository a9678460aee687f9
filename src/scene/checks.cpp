#include "scene/checks.hpp"

#include "osculate/scene/units.hpp"
#include "scene/describe_parts.hpp"
#include "scene/rules.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace osculate::scene {

namespace {

class SceneRules : public Rules {
public:
    using Rules::Rules;

    void check_set(const std::string& name, const SetSpec& set) {
        const auto* box = std::get_if<SelectBox>(&set.select);
        if (box && (box->min.array() > box->max.array()).any())
            fault({"sets", name, "box"}, "min at most max in every component", "min above max");
    }

    /// Masses are made once for all dynamic stages.
    void check_contact_mass(const Named<Stage>& stages) {
        const DynamicAnalysis* first = nullptr;
        for (const auto& [name, stage] : stages) {
            const auto* dynamic = std::get_if<DynamicAnalysis>(&stage.analysis);
            if (dynamic == nullptr) continue;
            if (first == nullptr) first = dynamic;
            if (dynamic->contact_mass != first->contact_mass)
                fault({"stages", name, "analysis", "dynamic", "contact_mass"}, "the same in all dynamic stages",
                      "another than in the first");
        }
    }

    void check_density(const std::string& name, const Body& body, const std::string& reason) {
        if (body.rigid_surface) return; // see check_held()
        if (body.rigid && (body.rigid->mass || body.rigid->density > 0)) return;
        if (elastic(body.material).density == 0)
            fault({"bodies", name, body.has_material ? "material" : "rigid"},
                  (body.rigid ? "a density or a mass, which " : "a density, which ") + reason + " needs", "none");
        for (const auto& [part, section] : body.sections)
            if (elastic(section.material).density == 0)
                fault({"bodies", name, "sections", part, "material"}, "a density, which " + reason + " needs", "none");
    }

    void check_gravity(const Scene& scene) {
        const auto weighs = [](const auto& named) {
            const Body& body = named.second;
            return (body.rigid && (body.rigid->mass || body.rigid->density > 0)) ||
                   elastic(body.material).density > 0 || std::ranges::any_of(body.sections, [](const auto& part) {
                       return elastic(part.second.material).density > 0;
                   });
        };
        if (!scene.gravity.isZero(0) && !scene.bodies.empty() && std::ranges::none_of(scene.bodies, weighs))
            fault({"gravity"}, "a body with a density or a mass, on which it acts", "none");
    }

    /// Sets of rigid bodies have no equations of their own.
    void check_rigid_sets(const Scene& scene) {
        const auto rigid = [&](const std::string& set) -> const std::string* {
            const SetSpec* spec = find(scene.sets, set);
            const Body* body = spec != nullptr ? find(scene.bodies, spec->body) : nullptr;
            return body != nullptr && body->rigid ? &spec->body : nullptr;
        };
        for (const auto& [set, support] : scene.supports)
            if (const std::string* body = rigid(set))
                fault({"supports", set}, "bodies." + *body + ".rigid.fix, which holds the whole body",
                      "a set of rigid body '" + *body + "'");
        for (const auto& [name, stage] : scene.stages)
            for (const auto& [set, components] : stage.displacement)
                if (const std::string* body = rigid(set))
                    fault({"stages", name, "displacement", set},
                          "stages." + name + ".motion." + *body + ", which moves the whole body",
                          "a set of rigid body '" + *body + "'");
        for (const auto& [name, pair] : scene.contact) {
            const bool between = !pair.between[0].empty();
            const std::string *slave = rigid(between ? pair.between[0] : pair.slave),
                              *master = !pair.master.rigid_surface.empty()
                                            ? &pair.master.rigid_surface
                                            : rigid(between ? pair.between[1] : pair.master.set);
            if (slave != nullptr && master != nullptr)
                fault({"contact", name}, "a side that deforms: two rigid bodies have no contact pressure of their own",
                      "two rigid bodies, '" + *slave + "' and '" + *master + "'");
        }
    }

    /// Sets that follow a reference point have no equations of their own.
    void check_couplings(const Scene& scene) {
        for (const auto& [name, coupling] : scene.couplings) {
            if (find(scene.bodies, name) != nullptr)
                fault({"couplings", name}, "another name than that of a body: stages name both", "'" + name + "'");
            if (coupling.kind == CouplingKind::distributing &&
                std::ranges::any_of(coupling.fixed, [](bool fixed) { return fixed; }))
                fault({"couplings", name, "fix"}, "none with kind distributing: its reference point has no motion",
                      "components that are held");
            const SetSpec* set = find(scene.sets, coupling.set);
            const Body* body = set != nullptr ? find(scene.bodies, set->body) : nullptr;
            if (body != nullptr && body->rigid)
                fault({"couplings", name, "set"},
                      "a set of a body that deforms: bodies." + set->body +
                          ".rigid has a reference point for the whole body",
                      "a set of rigid body '" + set->body + "'");
        }
    }

    void check_imperfections(const Scene& scene) {
        for (const auto& [name, by] : scene.imperfections) {
            const SetSpec* set = find(scene.sets, name);
            const Body* body = set != nullptr ? find(scene.bodies, set->body) : nullptr;
            if (body != nullptr && (body->rigid || body->slice))
                fault({"imperfections", name}, "a set of a body that deforms, and is no slice",
                      "a set of " + std::string(body->rigid ? "rigid body '" : "slice '") + set->body + "'");
        }
    }

    void check_ties(const Scene& scene) {
        for (const auto& [name, tie] : scene.ties) {
            for (const auto& [key, set_name] : {std::pair{"slave", tie.slave}, std::pair{"master", tie.master}}) {
                const SetSpec* set = find(scene.sets, set_name);
                const Body* body = set != nullptr ? find(scene.bodies, set->body) : nullptr;
                if (body != nullptr && body->rigid)
                    fault({"ties", name, key},
                          "a surface of a body that deforms; couplings and contact hold others to rigid bodies",
                          "a surface of rigid body '" + set->body + "'");
            }
            const SetSpec *slave = find(scene.sets, tie.slave), *master = find(scene.sets, tie.master);
            if (slave != nullptr && master != nullptr && slave->body == master->body)
                fault({"ties", name, "master"}, "a surface of another body than the slave's",
                      "two surfaces of '" + slave->body + "'");
        }
    }

    void check_cyclic(const Scene& scene) {
        for (const auto& [name, ring] : scene.cyclic)
            for (const auto& [key, set_name] : {std::pair{"slave", ring.slave}, std::pair{"master", ring.master}}) {
                const SetSpec* set = find(scene.sets, set_name);
                const Body* body = set != nullptr ? find(scene.bodies, set->body) : nullptr;
                if (body != nullptr && body->rigid)
                    fault({"cyclic", name, key}, "a set of a body that deforms",
                          "a set of rigid body '" + set->body + "'");
            }
    }

    void check_equations(const Scene& scene) {
        for (const auto& [name, equation] : scene.equations) {
            bool any = false;
            for (const auto& [set_name, factors] : equation.terms) {
                any = any || !factors.isZero(0);
                const SetSpec* set = find(scene.sets, set_name);
                const Body* body = set != nullptr ? find(scene.bodies, set->body) : nullptr;
                if (body != nullptr && body->rigid)
                    fault({"equations", name, "terms", set_name}, "a set of a body that deforms",
                          "a set of rigid body '" + set->body + "'");
            }
            if (!any && !equation.terms.empty())
                fault({"equations", name, "terms"}, "a factor other than zero", "zeros alone");
            if (!equation.each.empty() && find(equation.terms, equation.each) == nullptr)
                fault({"equations", name, "each"}, "one of the sets under terms", "'" + equation.each + "'");
        }
    }

    void check_motion(const std::string& name, const Stage& stage, const Scene& scene) {
        /// What holds components for the whole run, and where it is written.
        struct Held {
            const std::array<bool, 6>* fixed = nullptr; ///< null: nothing that moves as one
            std::string key;
        };
        const auto needs_rigid = [&](const char* key, const std::string& body) -> Held {
            if (const Coupling* coupling = find(scene.couplings, body))
                return {&coupling->fixed, "couplings." + body + ".fix"};
            const Body* spec = find(scene.bodies, body);
            if (spec == nullptr) return {};
            if (!spec->rigid)
                fault({"stages", name, key, body}, "a rigid body or a coupling", "'" + body + "', which deforms");
            return spec->rigid ? Held{&spec->rigid->fixed, "bodies." + body + ".rigid.fix"} : Held{};
        };
        for (const auto& [body, components] : stage.motion) {
            const Held rigid = needs_rigid("motion", body);
            if (rigid.fixed == nullptr) continue;
            if (const Coupling* coupling = find(scene.couplings, body);
                coupling != nullptr && coupling->kind == CouplingKind::distributing)
                fault({"stages", name, "motion", body},
                      "a coupling of kind rigid: others have forces and moments alone", "one that distributes");
            bool any = false;
            for (std::size_t a = 0; a < components.size(); ++a) {
                if (!components[a]) continue;
                any = true;
                if ((*rigid.fixed)[a])
                    fault({"stages", name, "motion", body, motion_words[a]},
                          "a component that " + rigid.key + " leaves free", motion_words[a] + ", which is held");
                check_course({"stages", name, "motion", body, motion_words[a]}, *components[a], stage, range::position);
            }
            if (!any) fault({"stages", name, "motion", body}, "at least one of x, y, z, rx, ry, rz", "none");
        }
        for (const auto& [key, loads] : {std::pair{"force", &stage.force}, std::pair{"moment", &stage.moment}})
            for (const auto& [body, load] : *loads)
                if (needs_rigid(key, body).fixed != nullptr)
                    for (std::size_t a = 0; a < 3; ++a)
                        check_course({"stages", name, key, body}, load[a], stage, {}, a);
    }

    /// A surface has no volume: where inertia may move it, it needs a mass.
    void check_held(const Scene& scene) {
        for (const auto& [name, body] : scene.bodies) {
            if (!body.rigid_surface || body.rigid->mass) continue;
            std::array<bool, 6> held = body.rigid->fixed;
            for (const auto& [stage_name, stage] : scene.stages) {
                if (const auto* motion = find(stage.motion, name))
                    for (std::size_t a = 0; a < held.size(); ++a) held[a] = held[a] || (*motion)[a].has_value();
                if (!std::holds_alternative<DynamicAnalysis>(stage.analysis)) continue;
                for (std::size_t a = 0; a < held.size(); ++a)
                    if (!held[a])
                        return fault({"bodies", name, "rigid_surface"},
                                     "rigid.mass and rigid.inertia, or `fix` or `motion` for " + motion_words[a] +
                                         ", in dynamic stage '" + stage_name + "'",
                                     "neither");
            }
        }
    }

    void check_stage(const std::string& name, const Stage& stage, const Named<Support>& supports) {
        if (stage.control.error_tolerance && std::holds_alternative<StaticAnalysis>(stage.analysis))
            fault({"stages", name, "control", "error_tolerance"}, "a dynamic stage", "a static one");
        if (stage.control.step_size == StepSize::fixed && std::holds_alternative<StaticAnalysis>(stage.analysis))
            fault({"stages", name, "control", "step_size"}, "a dynamic stage", "a static one");
        if (stage.control.error_tolerance && stage.control.step_size == StepSize::fixed)
            fault({"stages", name, "control", "error_tolerance"}, "step_size: controlled", "step_size: fixed");
        for (const auto& [set, released] : stage.release) {
            const Support* support = find(supports, set);
            if (support != nullptr && support->symmetry)
                fault({"stages", name, "release", set},
                      "a set that no plane of symmetry holds: contact is mirrored there",
                      "supports." + set + ".symmetry");
            if (const auto* driven = find(stage.displacement, set))
                for (std::size_t a = 0; a < 3; ++a)
                    if (released[a] && (*driven)[a])
                        fault({"stages", name, "release", set}, "components that this stage does not drive",
                              axis_words[a]);
        }
        for (const auto& [pair, friction] : stage.friction)
            if (pair == "general")
                fault({"stages", name, "friction", pair}, "a pair that the scene names", "general contact");
        for (const auto& [pair, in_force] : stage.pairs)
            if (pair == "general")
                fault({"stages", name, "pairs", pair}, "a pair that the scene names", "general contact");
        const std::vector<std::string> path{"stages", name, "displacement"};
        for (const auto& [set, components] : stage.displacement) {
            const Support* support = find(supports, set);
            for (std::size_t a = 0; a < 3; ++a) {
                if (!components[a] || !support || !support->fixed[a]) continue;
                const std::string axis(1, "xyz"[a]);
                fault({"stages", name, "displacement", set, axis}, "a component that supports." + set + " leaves free",
                      axis + ", which is held");
            }
            const Tree* written = deepest({"stages", name, "displacement", set});
            if (written->key == set && written->children.empty())
                fault({"stages", name, "displacement", set}, "at least one of x, y, z", "none");
            for (std::size_t a = 0; a < 3; ++a)
                if (components[a])
                    check_course({"stages", name, "displacement", set, axis_words[a]}, *components[a], stage,
                                 range::position);
        }
        for (const auto& [key, named] :
             {std::pair{"pressure", &stage.pressure}, std::pair{"follower_pressure", &stage.follower_pressure}})
            for (const auto& [set, pressure] : *named) check_course({"stages", name, key, set}, pressure, stage, {});
        for (const auto& [part, temperature] : stage.temperature)
            check_course({"stages", name, "temperature", part}, temperature, stage, {});
        for (const auto& [key, named] :
             {std::pair{"body_force", &stage.body_force}, std::pair{"nodal_force", &stage.nodal_force}})
            for (const auto& [on, force] : *named)
                for (std::size_t a = 0; a < 3; ++a) check_course({"stages", name, key, on}, force[a], stage, {}, a);
    }

    /// Values of an expression at the ends of the stage's steps, in dynamics at its start too.
    /// @param component  of a list at the path
    void check_course(const std::vector<std::string>& path, const Course& course, const Stage& stage,
                      const Range& range, std::size_t component = 0) {
        const auto* expression = std::get_if<Expression>(&course.form);
        if (expression == nullptr) return;
        const auto value = course.function();
        for (int k = std::holds_alternative<DynamicAnalysis>(stage.analysis) ? 0 : 1; k <= stage.steps; ++k) {
            const double t = stage.duration * k / stage.steps, y = value(t);
            if (std::isfinite(y) && range.contains(y)) continue;
            const Tree* at = deepest(path);
            if (at->kind == Tree::Kind::list && component < at->children.size()) at = &at->children[component];
            if (const Tree* text = at->find("expression")) at = text;
            const std::string bounds = range.text();
            faults_.push_back(fault_at(at->place, join(path, ".") + ".expression",
                                       "finite values" + (bounds.empty() ? "" : " " + bounds) + " over the stage",
                                       number_text(y) + " at t = " + number_text(t) + " s"));
            return;
        }
    }

    void check_expectation(const Expectation& expect) {
        if (expect.outcome == Outcome::completed && !expect.cause.empty())
            fault({"expect", "cause"}, "outcome gives_up with a cause", "outcome completed");
    }
};

} // namespace

void check_rules(const Scene& scene, const Tree& tree, std::vector<Fault>& faults) {
    check_bodies(scene, tree, faults);
    SceneRules rules(tree, faults);
    rules.check_rigid_sets(scene);
    rules.check_imperfections(scene);
    rules.check_couplings(scene);
    rules.check_ties(scene);
    rules.check_cyclic(scene);
    rules.check_equations(scene);
    rules.check_held(scene);
    for (const auto& [name, stage] : scene.stages) rules.check_motion(name, stage, scene);
    for (const auto& [name, set] : scene.sets) rules.check_set(name, set);
    for (const auto& [stage_name, stage] : scene.stages)
        if (std::holds_alternative<DynamicAnalysis>(stage.analysis)) {
            for (const auto& [name, body] : scene.bodies)
                rules.check_density(name, body, "dynamic stage '" + stage_name + "'");
            break;
        }
    rules.check_gravity(scene);
    rules.check_contact_mass(scene.stages);
    check_contact(scene, tree, faults);
    for (const auto& [name, stage] : scene.stages) rules.check_stage(name, stage, scene.supports);
    if (scene.expect) rules.check_expectation(*scene.expect);
}

} // namespace osculate::scene
