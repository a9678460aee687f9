#include "osculate/output/nodal_contact.hpp"

#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::output {

NodalContact nodal_contact(const model::Model& model, const model::State& state,
                           const model::ContactEvaluations& contact) {
    const std::size_t n = model.X.size();
    NodalContact all{Field(n), std::vector<double>(n, 0.0),
                     std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()), std::vector<double>(n, 0.0),
                     Field(n)};
    for (std::size_t p = 0; p < contact.size(); ++p) {
        const model::ContactEvaluation& evaluation = contact[p];
        const model::ContactHistory& history = state.contact[p];
        for (Index j = 0; j < evaluation.pair().size(); ++j) {
            const auto k = static_cast<std::size_t>(j);
            const auto node = static_cast<std::size_t>(model::material_node(model, evaluation.pair().slaves().node[k]));
            const contact::ContactPoint& point = evaluation.point(j);
            evaluation.for_each_force(j, history.lambda[k], [&](Index at, const Vec3& force) {
                all.force[static_cast<std::size_t>(model::material_node(model, at))] += force;
            });
            if (point.found) all.gap[node] = std::fmin(all.gap[node], point.gap);
            if (!contact::is_closed(history.status[k])) continue;
            const bool sticks = history.status[k] == contact::Status::stick;
            all.status[node] = sticks || all.status[node] == 1 ? 1 : 2;
            const Vec3 d = evaluation.drift(j) / evaluation.whole(j);
            all.slip[node] = d - point.normal * point.normal.dot(d);
        }
    }
    const Field x = sum(model.X, state.u);
    std::vector<double> area(n, 0.0);
    Field normal(n);
    for (const model::Body& body : model.bodies)
        for (mesh::Facet facet : mesh::exterior_facets(body.mesh)) {
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += body.first_node;
            const auto shares = fe::tributary_areas(facet, model.X);
            const Vec3 across = mesh::facet_area_vector(facet, x);
            for (int c = 0; c < facet.count; ++c) {
                const auto node = static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(c)]);
                // a node on an edge: only the faces that the force presses on count
                if (!(all.force[node].dot(across) < 0)) continue;
                area[node] += shares[static_cast<std::size_t>(c)];
                normal[node] += across;
            }
        }
    for (std::size_t i = 0; i < n; ++i)
        if (area[i] > 0) all.pressure[i] = -all.force[i].dot(normal[i].normalized()) / area[i];
    return all;
}

} // namespace osculate::output
