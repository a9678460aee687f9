#include "app/plan/contact_pairs.hpp"

#include "app/overloaded.hpp"
#include "app/plan/body_materials.hpp"
#include "app/plan/draft_slices.hpp"
#include "app/plan/rigid_surface.hpp"
#include "app/plan/smooth_parts.hpp"
#include "osculate/contact/exact_surface.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/mortar.hpp"
#include "osculate/contact/path_crossing.hpp"
#include "osculate/contact/sided_surface.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/model/general_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace osculate::app {

namespace {

/// Projectors of the slave nodes on the symmetry planes they lie on; empty where there is no such node.
std::vector<Mat3> in_symmetry_planes(const scene::Scene& scene, const model::Model& model, const model::Set& slave,
                                     const std::vector<Index>& nodes) {
    std::map<Index, Mat3> kept;
    for (const auto& [name, support] : scene.supports) {
        if (!support.symmetry) continue;
        const Vec3 normal = support.axes.col(0);
        for (const model::Set& held : model.sets)
            if (held.name == name && held.body == slave.body)
                for (const Index node : held.nodes) {
                    Mat3& P = kept.try_emplace(node, Mat3::Identity()).first->second;
                    const Vec3 left = P * normal; // nothing where the plane is one of those before
                    if (left.norm() > 1e-6) P -= left * left.transpose() / left.squaredNorm();
                }
    }
    bool any = false;
    std::vector<Mat3> in_plane;
    for (const Index node : nodes) {
        const auto at = kept.find(model::material_node(model, node));
        any = any || at != kept.end();
        in_plane.push_back(at != kept.end() ? at->second : Mat3::Identity());
    }
    return any ? in_plane : std::vector<Mat3>{};
}

/// The master surface with its images beyond the symmetry planes that its body is held at. A patch cut off at such a
/// plane would be one-sided and wrong there.
contact::MirroredSurface mirror_at_symmetry(const scene::Scene& scene, const model::Model& model,
                                            const model::Set& master) {
    std::vector<contact::SymmetryPlane> planes;
    for (const auto& [name, support] : scene.supports) {
        if (!support.symmetry) continue;
        for (const model::Set& held : model.sets)
            if (held.name == name && held.body == master.body)
                planes.push_back({model.X[held.nodes.front()], support.axes.col(0)});
    }
    double largest = 0; // facet size
    for (const mesh::Facet& facet : master.facets) {
        const auto area = fe::tributary_areas(facet, model.X);
        largest = std::max(largest, std::sqrt(std::accumulate(area.begin(), area.end(), 0.0)));
    }
    constexpr double rings = 6; // more than patches and their bumps reach
    return contact::mirror(master.facets, model.X, planes, rings * largest);
}

/// The radial functions asked for; none: those that suit each patch.
template <class Surface>
std::optional<contact::Multiquadric> radial_basis(const Surface& s, Discretisation discretisation) {
    using enum scene::RadialBasis;
    const Surface defaults;
    switch (s.basis) {
    case r3: return contact::r3;
    case r5: return contact::r5;
    case multiquadric: break;
    case automatic:
        // forces of single nodes press the surface into waves, which r^5 carries on farther than others
        if (discretisation == Discretisation::petrov_galerkin && s.R == defaults.R && s.q == defaults.q)
            return std::nullopt;
    }
    return contact::Multiquadric{s.R, s.q};
}

/// The master surface asked for, and the rule against flip-flop that it needs.
std::unique_ptr<contact::MasterSurface> make_master(const scene::MasterSpec& spec, Discretisation discretisation,
                                                    const mesh::HalfEdgeSurface& surface,
                                                    const std::vector<Vec3>& vertices, model::ContactOptions& options) {
    return std::visit(
        Overloaded{
            [](const scene::AutomaticSurface&) -> std::unique_ptr<contact::MasterSurface> {
                throw std::logic_error("the surface of a pair is not settled");
            },
            [&](const scene::FacetsSurface& s) {
                options.hysteresis = s.hysteresis;
                return contact::with_sides(surface, contact::make_facets_surface(surface));
            },
            [&](const scene::RpimSurface& s) {
                options.hysteresis = s.hysteresis;
                return contact::with_sides(
                    surface, contact::make_rpim_surface(surface, vertices,
                                                        {s.ring, radial_basis(s, discretisation), s.m, s.coordinates}));
            },
            [&](const scene::BlendSurface& s) { // does not depend on the facet: no hysteresis
                options.hysteresis = 0;
                return contact::make_blend_surface(surface, vertices,
                                                   {s.ring, radial_basis(s, discretisation), s.m, s.coordinates});
            },
        },
        spec.surface);
}

/// The surface through the slave nodes that mortar takes its gaps from: as smooth as the master's. None where that is its
/// facets.
std::optional<contact::SmoothSlave> smooth_slave(const scene::Scene& scene, const scene::MasterSpec& spec,
                                                 const model::Model& model, const model::Set& slave,
                                                 const std::vector<Index>& slave_nodes) {
    if (std::holds_alternative<scene::FacetsSurface>(spec.surface)) return std::nullopt;
    const contact::MirroredSurface mirrored = mirror_at_symmetry(scene, model, slave);
    contact::SmoothSlave smooth;
    smooth.surface = std::make_unique<mesh::HalfEdgeSurface>(mirrored.facets, mirrored.positions);
    for (const Index node : smooth.surface->vertex_nodes()) {
        smooth.X.push_back(mirrored.positions[node]);
        const auto at = std::lower_bound(slave_nodes.begin(), slave_nodes.end(), mirrored.original[node]);
        smooth.node.push_back(static_cast<Index>(at - slave_nodes.begin()));
        smooth.image.push_back(mirrored.images[mirrored.image[node]]);
    }
    model::ContactOptions unused; // rules against flip-flop are of no use to points that stay where they are
    smooth.shape = make_master(spec, Discretisation::mortar, *smooth.surface, smooth.X, unused);
    return smooth;
}

/// Thickness of the master's body behind each of its nodes, the least over the facets that meet there; infinite elsewhere.
std::vector<double> thickness(const model::Model& model, const model::Set& master,
                              const std::vector<mesh::Facet>& exterior) {
    const auto corners = [](const std::vector<mesh::Facet>& facets) {
        std::vector<contact::MovingFacets::Corners> result;
        for (const mesh::Facet& facet : facets) result.push_back(facet.nodes);
        return result;
    };
    const model::Body& body = model.bodies[static_cast<std::size_t>(master.body)];
    std::vector<mesh::Facet> own = master.facets;
    for (mesh::Facet& facet : own)
        for (int c = 0; c < facet.count; ++c) {
            Index& node = facet.nodes[static_cast<std::size_t>(c)];
            node = model::material_node(model, node) - body.first_node;
        }
    const std::vector<double> behind = contact::thickness_behind(corners(own), corners(exterior), body.mesh.nodes);
    std::vector<double> result(model.X.size(), std::numeric_limits<double>::infinity());
    for (std::size_t f = 0; f < master.facets.size(); ++f)
        for (const Index node : master.facets[f]) result[node] = std::min(result[node], behind[f]);
    return result;
}

/// The master side of a pair.
/// @param exterior  of the body, its own node numbers, where thickness is needed; null: it is not
/// @param options   gets what suits the surface
std::shared_ptr<const model::MasterSide> make_side(const scene::Scene& scene, const scene::MasterSpec& spec,
                                                   Discretisation discretisation, const model::Model& model,
                                                   const model::Set& master, const std::vector<mesh::Facet>* exterior,
                                                   model::ContactOptions& options) {
    const contact::MirroredSurface mirrored = mirror_at_symmetry(scene, model, master);
    auto surface = std::make_unique<mesh::HalfEdgeSurface>(mirrored.facets, mirrored.positions);
    model::MasterNodes nodes;
    const std::vector<double> behind =
        exterior != nullptr ? thickness(model, master, *exterior) : std::vector<double>{};
    std::vector<Vec3> vertices;
    for (const Index node : surface->vertex_nodes()) {
        nodes.node.push_back(mirrored.original[node]);
        vertices.push_back(mirrored.positions[node]);
        if (exterior != nullptr) nodes.thickness.push_back(behind[mirrored.original[node]]);
        if (mirrored.images.size() > 1) nodes.image.push_back(mirrored.image[node]);
    }
    nodes.images = mirrored.images;
    auto shape = make_master(spec, discretisation, *surface, vertices, options);
    return std::make_shared<const model::MasterSide>(std::move(surface), std::move(nodes), std::move(shape));
}

/// An exact surface as the master, with the facets of its shell for what looks at these.
/// @param size  by which gaps are judged: that of slave facets, m
std::shared_ptr<const model::MasterSide> make_exact_side(const model::Model& model, const model::Set& master,
                                                         const contact::ExactShape& shape, double size,
                                                         model::ContactOptions& options) {
    auto surface = std::make_unique<mesh::HalfEdgeSurface>(master.facets, model.X);
    surface->use_facet_size(size);
    model::MasterNodes nodes;
    nodes.node = surface->vertex_nodes();
    std::vector<Vec3> vertices;
    for (const Index node : nodes.node) vertices.push_back(model.X[static_cast<std::size_t>(node)]);
    options.hysteresis = 0; // it does not depend on facets
    auto exact = contact::make_exact_surface(shape, contact::rigid_frame(vertices));
    return std::make_shared<const model::MasterSide>(std::move(surface), std::move(nodes), std::move(exact));
}

/// The exact shape of the body of a set, if it is the whole surface of such a body.
const contact::ExactShape* shape_of(const model::Model& model, const model::Set& set) {
    for (const model::RigidBody& rigid : model.rigid)
        if (rigid.body == set.body && !rigid.coupling && rigid.shape) return &*rigid.shape;
    return nullptr;
}

/// Slave nodes of a slice that have another below them in the set, and this one; of a skin, as their hosts are.
std::vector<std::pair<Index, Index>> of_slice(const scene::Scene& scene, const model::Model& model,
                                              const model::Set& slave, const std::map<Index, Vec3>& loose) {
    const std::map<Index, Index> above = nodes_above(scene, model, slave.body);
    if (above.empty()) return {};
    std::map<Index, Index> by_host;
    for (const Index node : mesh::nodes_of(slave.facets)) by_host.emplace(material_node(model, node), node);
    for (const auto& [node, area] : loose) by_host.emplace(material_node(model, node), node);
    std::vector<std::pair<Index, Index>> pairs;
    for (const auto& [host, node] : by_host)
        if (const auto at = above.find(host); at != above.end())
            if (const auto base = by_host.find(at->second); base != by_host.end())
                pairs.emplace_back(node, base->second);
    return pairs;
}

double mean_size(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& X) {
    double sum = 0;
    for (const mesh::Facet& facet : facets)
        sum += std::sqrt(mesh::facet_area_vector(facet, X).norm()) / static_cast<double>(facets.size());
    return sum;
}

} // namespace

std::optional<contact::Overclosure> law_of(const scene::PressureOverclosure& law) {
    return std::visit(Overloaded{[](const scene::ExactContact&) -> std::optional<contact::Overclosure> { return {}; },
                                 [](const scene::LinearOverclosure& given) {
                                     return std::optional(contact::Overclosure::linear(given.stiffness));
                                 },
                                 [](const scene::ExponentialOverclosure& given) {
                                     return std::optional(
                                         contact::Overclosure::exponential(given.pressure, given.clearance));
                                 },
                                 [](const scene::TabularOverclosure& given) {
                                     return std::optional(contact::Overclosure::table(given.table.rows));
                                 }},
                      law);
}

std::unique_ptr<const model::ContactPair> make_contact_pair(const scene::Scene& scene, const std::string& name,
                                                            const scene::Pair& spec, const model::Model& model,
                                                            const model::Set& slave, const model::Set& master,
                                                            const std::map<Index, Vec3>& loose,
                                                            const std::vector<mesh::Facet>* exterior) {
    const std::vector<Vec3>& X = model.X;
    model::ContactOptions options;
    options.discretisation = spec.discretisation.value();
    options.friction = spec.friction;
    options.static_friction = spec.static_friction.value_or(0);
    options.tangential_damping = spec.tangential_damping;
    options.overclosure = law_of(spec.pressure_overclosure);
    options.damping = spec.damping;
    options.stick_stiffness = spec.stick_stiffness.value_or(0);
    options.closing_tolerance = spec.closing_tolerance;
    const contact::ExactShape* shape = shape_of(model, master);
    const double slave_size =
        slave.facets.empty() ? std::sqrt(loose.begin()->second.norm()) : mean_size(slave.facets, X);
    std::shared_ptr<const model::MasterSide> side =
        shape != nullptr ? make_exact_side(model, master, *shape, slave_size, options)
                         : make_side(scene, spec.master, options.discretisation, model, master, exterior, options);

    model::SlaveNodes slaves;
    slaves.facets = slave.facets;
    std::map<Index, std::pair<double, double>> area_and_size; // tributary area, largest facet size at the node
    for (const mesh::Facet& facet : slave.facets) {
        const auto area = fe::tributary_areas(facet, X);
        const double size = std::sqrt(std::accumulate(area.begin(), area.end(), 0.0));
        for (int c = 0; c < facet.count; ++c) {
            auto& [sum, largest] = area_and_size[facet.nodes[c]];
            sum += area[static_cast<std::size_t>(c)];
            largest = std::max(largest, size);
        }
    }
    // of a corner the part that faces the master, as long as the master faces somewhere
    Vec3 facing = Vec3::Zero();
    for (const mesh::Facet& facet : master.facets) facing += mesh::facet_area_vector(facet, X);
    for (const auto& [node, vector] : loose) {
        const double towards = facing.isZero(0) ? 0 : std::abs(vector.dot(facing.normalized())), whole = vector.norm();
        const double area = towards > 1e-6 * whole ? towards : whole;
        area_and_size.emplace(node, std::pair(area, std::sqrt(area)));
    }
    // c = E * tributary area / h: the stiffness of a layer of elements, so free of units, of the softer body: it is the one
    // that gives way
    const auto modulus = [&](const model::Set& set) {
        const auto b = static_cast<std::size_t>(set.body);
        return modulus_under(scene.bodies[b].second, model.bodies[b], set.facets);
    };
    const double E = std::min(modulus(slave), modulus(master));
    if (!averages(options.discretisation)) // nodes that move as another are one slave
        for (const auto& [above, base] : of_slice(scene, model, slave, loose)) {
            const auto at = area_and_size.find(above);
            area_and_size.at(base).first += at->second.first;
            area_and_size.erase(at);
        }
    for (const auto& [node, values] : area_and_size) {
        slaves.node.push_back(node);
        slaves.area.push_back(values.first);
        slaves.stiffness.push_back(spec.stiffness_scale * E * values.first / values.second);
    }

    if (!options.overclosure)
        for (const model::CyclicSymmetry& ring : model.cyclic)
            for (const model::LikeNode& one : ring.nodes) { // both ends of the sector hold the same place
                const auto slave_of = [&](Index host) {
                    return std::ranges::find(slaves.node, host, [&](Index node) { return material_node(model, node); });
                };
                const auto at = slave_of(one.node);
                if (at == slaves.node.end() || slave_of(one.like) == slaves.node.end()) continue;
                slaves.yields.resize(slaves.node.size(), 0);
                slaves.yields[static_cast<std::size_t>(at - slaves.node.begin())] = 1;
            }

    if (averages(options.discretisation)) slaves.in_plane = in_symmetry_planes(scene, model, slave, slaves.node);

    std::optional<contact::SmoothSlave> smooth;
    if (options.discretisation == Discretisation::mortar)
        smooth = smooth_slave(scene, spec.master, model, slave, slaves.node);
    return std::make_unique<model::ContactPair>(name, X, std::move(slaves), std::move(side), options,
                                                smooth ? &*smooth : nullptr);
}

namespace {

/// Symmetry planes that hold a body: the sets' nodes.
std::vector<char> cut_off(const scene::Scene& scene, const model::Model& model, Index body) {
    std::vector<char> held(model.X.size(), 0);
    char plane = 0; // facets in one plane, not between two
    for (const auto& [name, support] : scene.supports) {
        if (!support.symmetry) continue;
        for (const model::Set& set : model.sets) {
            if (set.name != name || set.body != body) continue;
            plane = static_cast<char>(plane + 1);
            for (const Index node : set.nodes) held[node] = static_cast<char>(held[node] | (1 << (plane % 7)));
        }
    }
    return held;
}

model::GeneralContactOptions general_options(const scene::Scene& scene, const model::Model& model,
                                             const std::vector<model::OuterSurface>& surfaces,
                                             const std::map<Index, model::Set>& skins) {
    const scene::GeneralContact& spec = *scene.general;
    model::GeneralContactOptions options;
    options.pair.discretisation = spec.discretisation.value();
    options.pair.closing_tolerance = spec.closing_tolerance;
    options.stiffness_scale = spec.stiffness_scale;
    const auto n = static_cast<Index>(surfaces.size());
    options.friction = Matrix::Constant(n, n, spec.friction);
    Matrix at_rest = Matrix::Constant(n, n, spec.static_friction.value_or(0));
    const auto is = [&](Index s, const std::string& side) {
        const auto& [name, body] = scene.bodies[static_cast<std::size_t>(surfaces[static_cast<std::size_t>(s)].body)];
        return side == name || side == body.finish;
    };
    for (Index a = 0; a < n; ++a)
        for (Index b = a; b < n; ++b) {
            bool meet = true;
            for (const auto& [name, rule] : spec.pairs) {
                const auto& [one, other] = rule.between;
                if (!(is(a, one) && is(b, other)) && !(is(a, other) && is(b, one))) continue;
                if (rule.friction) {
                    options.friction(a, b) = options.friction(b, a) = *rule.friction;
                    at_rest(a, b) = at_rest(b, a) = 0;
                }
                if (rule.static_friction) at_rest(a, b) = at_rest(b, a) = *rule.static_friction;
                meet = rule.contact;
            }
            if (!meet) options.left_out.emplace_back(a, b);
        }
    if ((at_rest.array() > options.friction.array()).any()) options.static_friction = std::move(at_rest);
    const auto nodes_of = [&](const std::string& name) {
        const auto set = std::ranges::find(model.sets, name, &model::Set::name);
        std::vector<Index> nodes = set->nodes;
        if (const auto skin = skins.find(set->body); skin != skins.end()) {
            std::ranges::sort(nodes);
            std::vector<Index> instead;
            for (const Index node : skin->second.nodes)
                if (std::ranges::binary_search(nodes, model::material_node(model, node))) instead.push_back(node);
            nodes = std::move(instead);
        }
        std::ranges::sort(nodes);
        return nodes;
    };
    for (const auto& [name, pair] : scene.contact)
        options.treated_elsewhere.emplace_back(nodes_of(pair.slave), nodes_of(master_set(pair.master)));
    for (const auto& [name, tie] : scene.ties)
        options.treated_elsewhere.emplace_back(nodes_of(tie.slave), nodes_of(tie.master));
    return options;
}

} // namespace

model::Set outer_surface(const scene::Scene& scene, const model::Model& model, Index body) {
    const model::Body& own = model.bodies[static_cast<std::size_t>(body)];
    model::Set all{own.name, body, {}, model::exterior_facets(own)};
    const std::vector<char> held = cut_off(scene, model, body);
    std::erase_if(all.facets, [&](const mesh::Facet& facet) {
        char common = ~0;
        for (const Index node : facet) common = static_cast<char>(common & held[node]);
        return common != 0;
    });
    all.nodes = mesh::nodes_of(all.facets);
    return all;
}

std::unique_ptr<const model::GeneralContact> make_general_contact(const scene::Scene& scene, const model::Model& model,
                                                                  const std::map<Index, model::Set>& skins,
                                                                  bool dynamic) {
    const scene::GeneralContact& spec = *scene.general;
    std::vector<model::OuterSurface> surfaces;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (scene.bodies[b].second.rigid_surface) continue; // for pairs alone
        model::OuterSurface& one = surfaces.emplace_back();
        one.body = static_cast<Index>(b);
        one.name = model.bodies[b].name;
        const auto skin = skins.find(one.body);
        model::Set all = skin != skins.end() ? skin->second : outer_surface(scene, model, one.body);
        if (skin != skins.end())
            for (const Index node : all.nodes) one.skin.emplace(model::material_node(model, node), node);
        scene::MasterSpec master{{}, {}, scene::BlendSurface{}};
        const SmoothParts parts = smooth_parts(mesh::HalfEdgeSurface(all.facets, model.X), model.X);
        if (spec.surface == scene::GeneralSurface::facets ||
            (spec.surface == scene::GeneralSurface::automatic && ((dynamic && parts.plane) || parts.strips)))
            master.surface = scene::FacetsSurface{};
        one.smooth = std::holds_alternative<scene::BlendSurface>(master.surface);
        model::ContactOptions options;
        one.side =
            make_side(scene, master, spec.discretisation.value(), model, all, &model.bodies[b].exterior, options);
        const std::vector<Mat3> planes = in_symmetry_planes(scene, model, all, all.nodes);
        for (std::size_t i = 0; i < planes.size(); ++i)
            if (planes[i] != Mat3::Identity()) one.in_plane.emplace(all.nodes[i], planes[i]);
        one.E = modulus_under(scene.bodies[b].second, model.bodies[b], all.facets);
        one.facets = std::move(all.facets);
    }
    model::GeneralContactOptions options = general_options(scene, model, surfaces, skins);
    return std::make_unique<const model::GeneralContact>(std::move(surfaces), std::move(options), model.X);
}

} // namespace osculate::app
