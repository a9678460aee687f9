#include "app/plan/planned_probe.hpp"

#include "app/fault.hpp"
#include "app/overloaded.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace osculate::app {

namespace {

Index body_index(const model::Model& model, const std::string& name) {
    const auto at = std::ranges::find(model.bodies, name, &model::Body::name);
    return static_cast<Index>(at - model.bodies.begin());
}

Index pair_index(const model::Model& model, const std::string& name) {
    const auto at = std::ranges::find_if(model.pairs, [&](const auto& pair) { return pair->name() == name; });
    return static_cast<Index>(at - model.pairs.begin());
}

std::unique_ptr<output::Probe> make(const scene::Probe& spec, const model::Model& model) {
    return std::visit(
        Overloaded{[&](const scene::PointProbe& p) {
                       return output::make_point_probe(model, body_index(model, p.body), p.at, p.fields);
                   },
                   [&](const scene::LineProbe& p) {
                       return output::make_line_probe(model, body_index(model, p.body), p.from, p.to, p.samples,
                                                      p.fields);
                   },
                   [&](const scene::ContactLineProbe& p) {
                       return output::make_contact_line_probe(model, pair_index(model, p.pair), p.from, p.to, p.samples,
                                                              p.fields);
                   },
                   [&](const scene::ContactArcProbe& p) {
                       return output::make_contact_arc_probe(model, pair_index(model, p.pair), p.centre, p.axis, p.from,
                                                             p.angle, p.samples, p.fields);
                   },
                   [&](const scene::ContactForceProbe& p) {
                       return output::make_contact_force_probe(
                           model, *std::ranges::find(model.sets, p.set, &model::Set::name), p.point);
                   },
                   [&](const scene::NodesProbe& p) {
                       return output::make_nodes_probe(model, *std::ranges::find(model.sets, p.set, &model::Set::name),
                                                       p.fields, p.reduce);
                   },
                   [&](const scene::SlaveNodesProbe& p) {
                       return output::make_slave_nodes_probe(model, pair_index(model, p.pair), p.fields, p.reduce);
                   },
                   [&](const scene::SectionForceProbe& p) {
                       return output::make_section_force_probe(model, body_index(model, p.body), p.point, p.normal);
                   }},
        spec.kind);
}

/// The key under which a probe's place stands, and what is expected there.
std::pair<std::string, std::string> place_of(const scene::Probe& spec) {
    return std::visit(
        Overloaded{
            [](const scene::PointProbe& p) {
                return std::pair{std::string("point.at"), "a point of body '" + p.body + "'"};
            },
            [](const scene::LineProbe& p) {
                return std::pair{std::string("line"), "a line through body '" + p.body + "'"};
            },
            [](const scene::ContactLineProbe& p) {
                return std::pair{std::string("contact_line"), "a line along the slave surface of '" + p.pair + "'"};
            },
            [](const scene::ContactArcProbe& p) {
                return std::pair{std::string("contact_arc"), "an arc along the slave surface of '" + p.pair + "'"};
            },
            [](const scene::ContactForceProbe&) {
                return std::pair{std::string("contact_force.set"), std::string("a set with facets")};
            },
            [](const scene::SectionForceProbe& p) {
                return std::pair{std::string("section_force.point"), "a plane that cuts body '" + p.body + "'"};
            },
            [](const scene::NodesProbe&) {
                return std::pair{std::string("nodes.set"), std::string("a set with facets, for area_mean")};
            },
            [](const auto&) {
                return std::pair{std::string(), std::string()};
            }},
        spec.kind);
}

/// What a probe asks of a rigid body that it does not have: key, expected, found; empty: nothing.
std::array<std::string, 3> asks_too_much(const scene::Probe& spec, const model::Model& model) {
    const auto judge = [&](const std::string& key, Index body, const std::vector<std::string>& fields) {
        std::array<std::string, 3> found;
        if (!model.bodies[static_cast<std::size_t>(body)].rigid) return found;
        const std::string& name = model.bodies[static_cast<std::size_t>(body)].name;
        for (const std::string& field : fields)
            for (const char* of_strain : {"stress", "von_mises", "stress_max", "stress_mid", "stress_min", "strain",
                                          "energy_density", "plastic_strain"})
                if (field == of_strain)
                    return std::array<std::string, 3>{key + ".fields",
                                                      "fields that rigid body '" + name + "' has, as displacement",
                                                      "'" + field + "', of bodies that deform"};
        return found;
    };
    if (const auto* p = std::get_if<scene::PointProbe>(&spec.kind))
        return judge("point", body_index(model, p->body), p->fields);
    if (const auto* p = std::get_if<scene::LineProbe>(&spec.kind))
        return judge("line", body_index(model, p->body), p->fields);
    if (const auto* p = std::get_if<scene::NodesProbe>(&spec.kind))
        return judge("nodes", std::ranges::find(model.sets, p->set, &model::Set::name)->body, p->fields);
    const auto* p = std::get_if<scene::SectionForceProbe>(&spec.kind);
    if (p != nullptr && model.bodies[static_cast<std::size_t>(body_index(model, p->body))].rigid)
        return {"section_force.body", "a body that deforms", "'" + p->body + "', which is rigid"};
    return {};
}

} // namespace

std::vector<PlannedProbe> make_probes(const scene::Scene& scene, const model::Model& model,
                                      std::vector<Fault>& faults) {
    std::vector<PlannedProbe> probes;
    for (const auto& [name, spec] : scene.output.probes) try {
            if (const auto [key, expected, found] = asks_too_much(spec, model); !key.empty()) {
                faults.push_back(fault("output.probes." + name + "." + key, expected, found));
                continue;
            }
            probes.push_back({name, spec.every, make(spec, model)});
        } catch (const std::invalid_argument& error) {
            const auto [key, expected] = place_of(spec);
            faults.push_back(fault("output.probes." + name + "." + key, expected, error.what()));
        }
    return probes;
}

} // namespace osculate::app
