#pragma once
/// A block above another, shifted and hanging over, with contact forces given by hand.

#include "osculate/contact/master_surface.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/output/snapshot.hpp"

#include <array>
#include <set>

namespace osculate::output {

/// Base [0, 2] x [0, 1] x [0, 1]; cap above it from (0.5, 0.25, 1), 2 m x 0.5 m x 0.5 m. Its slave nodes lie at
/// x = 0.5, 1.5 and 2.5, y = 0.25 and 0.75; those at x = 2.5 hang over. The cap is then moved by `shift`.
class TwoBlocks {
public:
    static constexpr double E = 1e6;
    inline static const Vec3 shift{0.02, 0, -0.01};
    inline static const Vec3 force{-30, 0, 100}; ///< on every closed slave node, N

    /// Elements of each along x, y, z.
    struct Refined {
        std::array<Index, 3> base{2, 1, 1}, cap{2, 1, 1};
    };

    TwoBlocks() : TwoBlocks(Refined{}) {}
    explicit TwoBlocks(const Refined& elements) {
        add_body("base", mesh::make_block({0, 0, 0}, {2, 1, 1}, elements.base));
        add_body("cap", mesh::make_block({0.5, 0.25, 1}, {2, 0.5, 0.5}, elements.cap));
        add_pair();
        state.time = 2.5;
        state.u.reset(model.X.size());
        for (Index i = 0; i < model.bodies[1].nodes(); ++i) state.u[model.bodies[1].first_node + i] = shift;
        const model::ContactPair& pair = *model.pairs[0];
        state.contact.push_back(model::opened(model.pairs[0]));
        for (Index j = 0; j < pair.size(); ++j) {
            const double x = slave_X(j).x();
            if (x > 2) continue;
            state.contact[0].status[j] = x < 1 ? contact::Status::stick : contact::Status::slip;
            state.contact[0].lambda[j] = force;
        }
        Timings unused;
        contact = model::contact_evaluations(model.pairs);
        contact[0].begin_step(model.X, pair.initial_history(), unused, 1);
        contact[0].evaluate(sum(model.X, state.u), unused, 1);
    }

    [[nodiscard]] Snapshot snapshot() const {
        return {model, state, contact, std::vector<Vec3>(model.X.size(), Vec3::Zero())};
    }
    [[nodiscard]] Vec3 slave_X(Index j) const { return model.X[model.pairs[0]->slaves().node[j]]; }

    model::Model model;
    model::State state;
    model::ContactEvaluations contact; ///< at `state`

private:
    void add_body(const std::string& name, mesh::Mesh mesh) {
        model::Body body{name, std::move(mesh), model.nodes(), {}, {}, {}};
        body.kernels.push_back(fe::make_kernel(mesh::CellType::hex8, HexFormulation::full, {E, 0}));
        body.exterior = mesh::exterior_facets(body.mesh);
        model.X.values().insert(model.X.values().end(), body.mesh.nodes.begin(), body.mesh.nodes.end());
        model.bodies.push_back(std::move(body));
    }

    [[nodiscard]] std::vector<mesh::Facet> facets(Index body, const std::string& surface) const {
        std::vector<mesh::Facet> list = model.bodies[body].mesh.surfaces.at(surface);
        for (mesh::Facet& facet : list)
            for (int c = 0; c < facet.count; ++c) facet.nodes[c] += model.bodies[body].first_node;
        return list;
    }

    void add_pair() {
        model::SlaveNodes slaves;
        slaves.facets = facets(1, "z_min");
        std::set<Index> nodes;
        for (const mesh::Facet& facet : slaves.facets) nodes.insert(facet.begin(), facet.end());
        slaves.node.assign(nodes.begin(), nodes.end());
        slaves.area.assign(nodes.size(), 0.25);
        slaves.stiffness.assign(nodes.size(), E);
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(facets(0, "z_max"), model.X);
        auto shape = contact::make_facets_surface(*surface);
        const std::vector<Index> vertices = surface->vertex_nodes();
        model.pairs.push_back(std::make_unique<model::ContactPair>("joint", model.X, std::move(slaves),
                                                                   std::move(surface), model::MasterNodes{vertices},
                                                                   std::move(shape), model::ContactOptions{0.3}));
    }
};

} // namespace osculate::output
