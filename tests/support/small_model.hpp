#pragma once
/// Models put together by hand, without a scene: for tests of what happens within a step.

#include "osculate/contact/master_surface.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/model/model.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace osculate::support {

/// Bodies first, then pairs and constraints, finish() last. Surfaces are those that a mesh names: z_min, z_max, ...
class SmallModel {
public:
    using MakeKernel = std::function<std::unique_ptr<fe::ElementKernel>(mesh::CellType)>;

    Index add_body(const std::string& name, mesh::Mesh mesh, const MakeKernel& make_kernel, double density = 0) {
        model::Body body{name, std::move(mesh), model.nodes(), {}, {}, {}};
        body.density.assign(body.mesh.blocks.size(), density);
        body.expansion.assign(body.mesh.blocks.size(), 0);
        body.exterior = mesh::exterior_facets(body.mesh);
        for (const mesh::ElementBlock& block : body.mesh.blocks) body.kernels.push_back(make_kernel(block.type));
        std::vector<Vec3>& X = model.X.values();
        X.insert(X.end(), body.mesh.nodes.begin(), body.mesh.nodes.end());
        model.bodies.push_back(std::move(body));
        return static_cast<Index>(model.bodies.size()) - 1;
    }
    /// Linear elastic, or neo-Hookean with the same constants.
    Index add_body(const std::string& name, mesh::Mesh mesh, const material::LinearElastic& elastic, double density = 0,
                   bool finite_strain = false) {
        return add_body(
            name, std::move(mesh),
            [&](mesh::CellType type) {
                return finite_strain ? fe::make_kernel(type, HexFormulation::full, material::NeoHookean(elastic))
                                     : fe::make_kernel(type, HexFormulation::full, elastic);
            },
            density);
    }

    /// A surface by global nodes.
    [[nodiscard]] std::vector<mesh::Facet> facets(Index body, const std::string& surface) const {
        const model::Body& own = model.bodies[static_cast<std::size_t>(body)];
        std::vector<mesh::Facet> list = own.mesh.surfaces.at(surface);
        for (mesh::Facet& facet : list)
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += own.first_node;
        return list;
    }
    /// Its nodes, ascending.
    [[nodiscard]] std::vector<Index> nodes(Index body, const std::string& surface) const {
        std::map<Index, int> found;
        for (const mesh::Facet& facet : facets(body, surface))
            for (const Index node : facet) found[node] = 1;
        std::vector<Index> list;
        for (const auto& [node, one] : found) list.push_back(node);
        return list;
    }

    /// A pair on facets. @param E  of the softer body, Pa  @param thickness  of the master's body, m; 0: not known
    void add_pair(const std::string& name, std::pair<Index, const char*> slave, std::pair<Index, const char*> master,
                  double E, double friction = 0, double thickness = 0) {
        model::SlaveNodes slaves;
        slaves.facets = facets(slave.first, slave.second);
        std::map<Index, std::pair<double, double>> area_and_size; // tributary area, largest facet size at the node
        for (const mesh::Facet& facet : slaves.facets) {
            const auto area = fe::tributary_areas(facet, model.X);
            const double size = std::sqrt(std::accumulate(area.begin(), area.end(), 0.0));
            for (int c = 0; c < facet.count; ++c) {
                auto& [sum, largest] = area_and_size[facet.nodes[static_cast<std::size_t>(c)]];
                sum += area[static_cast<std::size_t>(c)];
                largest = std::max(largest, size);
            }
        }
        for (const auto& [node, values] : area_and_size) {
            slaves.node.push_back(node);
            slaves.area.push_back(values.first);
            slaves.stiffness.push_back(E * values.first / values.second);
        }
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(facets(master.first, master.second), model.X);
        std::shared_ptr<const contact::MasterSurface> shape = contact::make_facets_surface(*surface);
        model::MasterNodes vertices{surface->vertex_nodes()};
        if (thickness > 0) vertices.thickness.assign(vertices.node.size(), thickness);
        model::ContactOptions options;
        options.friction = friction;
        model.pairs.push_back(std::make_unique<const model::ContactPair>(
            name, model.X, std::move(slaves), std::move(surface), std::move(vertices), std::move(shape), options));
    }

    /// Holds the nodes of a surface along x, y, z as `axes` has them, for example "xz".
    void fix(Index body, const std::string& surface, const std::string& axes) {
        for (const Index node : nodes(body, surface))
            for (const char axis : axes) constraints.push_back({node, Vec3::Unit(axis - 'x')});
    }
    /// Moves them along one axis to `target`, m, by the end of the stage.
    void drive(Index body, const std::string& surface, char axis, double target) {
        for (const Index node : nodes(body, surface))
            constraints.push_back({node, Vec3::Unit(axis - 'x'), target, true});
    }

    /// Undeformed, without a past.
    [[nodiscard]] model::State at_rest() const {
        model::State state;
        state.u.reset(model.X.size());
        for (const auto& pair : model.pairs) state.contact.push_back(model::opened(pair));
        state.material = model::initial_history(model);
        return state;
    }
    /// Nodal forces of a constant acceleration of all masses, N.
    [[nodiscard]] Field weight(const Vec3& acceleration) const {
        Field force(model.X.size());
        model.consistent_mass.multiply_add(Field(model.X.size(), acceleration), force, 1);
        return force;
    }

    /// Matrices, and masses where bodies are to move.
    void finish(bool dynamic = false) {
        model.K = model::assemble_stiffness(model.bodies, model::neighbours(model.bodies, model.nodes()));
        for (const model::Body& body : model.bodies)
            for (const auto& kernel : body.kernels)
                if (!kernel->linear() && !model.nonlinear)
                    model.nonlinear = std::make_unique<model::NonlinearElements>(model.bodies, model.K);
        if (!dynamic) return;
        model.consistent_mass = model::assemble_mass(model.bodies, model.nodes(), false, {}).M;
        model.initial_velocity.reset(model.X.size());
    }

    model::Model model;
    std::vector<linear::NodeConstraint> constraints;
};

} // namespace osculate::support
