#include "osculate/output/nodal_contact.hpp"

#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::output {

namespace {
constexpr double faces_it = 0.5; ///< of the cosine of the face that is pressed on most
}

NodalContact nodal_contact(const model::Model& model, const model::State& state,
                           const model::ContactEvaluations& contact) {
    const std::size_t n = model.X.size();
    NodalContact all{Field(n), std::vector<double>(n, 0.0),
                     std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()), std::vector<double>(n, 0.0),
                     Field(n)};
    Field pressing(n); // forces without friction
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
            const Vec3 normal_part =
                point.found ? Vec3(point.normal * point.normal.dot(history.lambda[k])) : Vec3::Zero();
            evaluation.for_each_force(j, normal_part, [&](Index at, const Vec3& force) {
                pressing[static_cast<std::size_t>(model::material_node(model, at))] += force;
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
    for (const model::Body& body : model.bodies) {
        std::vector<mesh::Facet> facets = mesh::exterior_facets(body.mesh);
        for (mesh::Facet& facet : facets)
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += body.first_node;
        // a node on an edge: only the faces that contact presses on count; all of them where it presses on the edge itself
        const auto for_each_pressed = [&](auto&& use) {
            for (const mesh::Facet& facet : facets) {
                const Vec3 across = mesh::facet_area_vector(facet, x);
                for (int c = 0; c < facet.count; ++c) {
                    const auto node = static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(c)]);
                    const double towards = -pressing[node].dot(across);
                    if (towards > 0) use(facet, c, node, across, towards / across.norm());
                }
            }
        };
        std::vector<double> most(n, 0.0); // by the face that it faces most, N
        for_each_pressed([&](const mesh::Facet&, int, std::size_t node, const Vec3&, double by) {
            most[node] = std::max(most[node], by);
        });
        for_each_pressed([&](const mesh::Facet& facet, int c, std::size_t node, const Vec3& across, double by) {
            if (by < faces_it * most[node]) return;
            area[node] += fe::tributary_areas(facet, model.X)[static_cast<std::size_t>(c)];
            normal[node] += across;
        });
    }
    for (std::size_t i = 0; i < n; ++i)
        if (area[i] > 0) all.pressure[i] = -all.force[i].dot(normal[i].normalized()) / area[i];
    return all;
}

} // namespace osculate::output
