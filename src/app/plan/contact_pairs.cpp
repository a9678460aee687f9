#include "app/plan/contact_pairs.hpp"

#include "app/overloaded.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/mortar.hpp"
#include "osculate/contact/path_crossing.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

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
    if (std::ranges::none_of(nodes, [&](Index node) { return kept.contains(node); })) return {};
    std::vector<Mat3> in_plane;
    for (const Index node : nodes) in_plane.push_back(kept.contains(node) ? kept.at(node) : Mat3::Identity());
    return in_plane;
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
    return std::visit(Overloaded{
                          [&](const scene::FacetsSurface& s) {
                              options.hysteresis = s.hysteresis;
                              return contact::make_facets_surface(surface);
                          },
                          [&](const scene::RpimSurface& s) {
                              options.hysteresis = s.hysteresis;
                              return contact::make_rpim_surface(
                                  surface, vertices, {s.ring, radial_basis(s, discretisation), s.m, s.coordinates});
                          },
                          [&](const scene::BlendSurface& s) { // does not depend on the facet: no hysteresis
                              options.hysteresis = 0;
                              return contact::make_blend_surface(
                                  surface, vertices, {s.ring, radial_basis(s, discretisation), s.m, s.coordinates});
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
        for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] -= body.first_node;
    const std::vector<double> behind = contact::thickness_behind(corners(own), corners(exterior), body.mesh.nodes);
    std::vector<double> result(model.X.size(), std::numeric_limits<double>::infinity());
    for (std::size_t f = 0; f < master.facets.size(); ++f)
        for (const Index node : master.facets[f]) result[node] = std::min(result[node], behind[f]);
    return result;
}

} // namespace

std::unique_ptr<const model::ContactPair> make_contact_pair(const scene::Scene& scene, const std::string& name,
                                                            const scene::Pair& spec, const model::Model& model,
                                                            const model::Set& slave, const model::Set& master,
                                                            const std::vector<mesh::Facet>* exterior) {
    const std::vector<Vec3>& X = model.X;
    model::ContactOptions options;
    options.discretisation = spec.discretisation.value();
    options.friction = spec.friction;
    options.closing_tolerance = spec.closing_tolerance;
    const contact::MirroredSurface mirrored = mirror_at_symmetry(scene, model, master);
    auto surface = std::make_unique<mesh::HalfEdgeSurface>(mirrored.facets, mirrored.positions);

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
    // c = E * tributary area / h: the stiffness of a layer of elements, so free of units, of the softer body: it is the one
    // that gives way
    const double E = std::min(scene::elastic(scene.bodies[slave.body].second.material).E,
                              scene::elastic(scene.bodies[master.body].second.material).E);
    for (const auto& [node, values] : area_and_size) {
        slaves.node.push_back(node);
        slaves.area.push_back(values.first);
        slaves.stiffness.push_back(spec.stiffness_scale * E * values.first / values.second);
    }

    if (averages(options.discretisation)) slaves.in_plane = in_symmetry_planes(scene, model, slave, slaves.node);

    model::MasterNodes master_nodes;
    const std::vector<double> behind =
        exterior != nullptr ? thickness(model, master, *exterior) : std::vector<double>{};
    std::vector<Vec3> vertices;
    for (const Index node : surface->vertex_nodes()) {
        master_nodes.node.push_back(mirrored.original[node]);
        vertices.push_back(mirrored.positions[node]);
        if (exterior != nullptr) master_nodes.thickness.push_back(behind[mirrored.original[node]]);
        if (mirrored.images.size() > 1) master_nodes.image.push_back(mirrored.image[node]);
    }
    master_nodes.images = mirrored.images;
    auto shape = make_master(spec.master, options.discretisation, *surface, vertices, options);
    std::optional<contact::SmoothSlave> smooth;
    if (options.discretisation == Discretisation::mortar)
        smooth = smooth_slave(scene, spec.master, model, slave, slaves.node);
    return std::make_unique<model::ContactPair>(name, X, std::move(slaves), std::move(surface), std::move(master_nodes),
                                                std::move(shape), options, smooth ? &*smooth : nullptr);
}

} // namespace osculate::app
