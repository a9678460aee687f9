#include "osculate/output/nodal_contact.hpp"

#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::output {

namespace {
constexpr double faces_it = 0.5; ///< of the cosine of the face that is pressed on most
}

std::size_t NodalContact::reach(std::size_t node) {
    Index& place = place_[node];
    if (place < 0) {
        place = static_cast<Index>(nodes_.size());
        nodes_.emplace_back();
    }
    return static_cast<std::size_t>(place);
}

NodalContact nodal_contact(const model::Model& model, const model::State& state,
                           const model::ContactEvaluations& contact) {
    NodalContact all(model.X.size());
    std::vector<Vec3> pressing{Vec3::Zero()}; // forces without friction, at nodes in reach
    const auto reach = [&](Index node) {
        const std::size_t place = all.reach(static_cast<std::size_t>(model::material_node(model, node)));
        pressing.resize(all.size(), Vec3::Zero());
        return place;
    };
    for (std::size_t p = 0; p < contact.size(); ++p) {
        const model::ContactEvaluation& evaluation = contact[p];
        const model::ContactHistory& history = state.contact[p];
        for (Index j = 0; j < evaluation.pair().size(); ++j) {
            const auto k = static_cast<std::size_t>(j);
            const contact::ContactPoint& point = evaluation.point(j);
            evaluation.for_each_force(j, history.lambda[k],
                                      [&](Index at, const Vec3& force) { all.at(reach(at)).force += force; });
            const Vec3 normal_part =
                point.found ? Vec3(point.normal * point.normal.dot(history.lambda[k])) : Vec3::Zero();
            evaluation.for_each_force(j, normal_part,
                                      [&](Index at, const Vec3& force) { pressing[reach(at)] += force; });
            const bool closed = contact::is_closed(history.status[k]);
            if (!point.found && !closed) continue;
            NodalContact::Node& slave = all.at(reach(evaluation.pair().slaves().node[k]));
            if (point.found) slave.gap = std::fmin(slave.gap, point.gap);
            if (!closed) continue;
            const bool sticks = history.status[k] == contact::Status::stick;
            slave.status = sticks || slave.status == 1 ? 1 : 2;
            const Vec3 d = evaluation.drift(j) / evaluation.whole(j);
            slave.slip = d - point.normal * point.normal.dot(d);
        }
    }
    std::vector<double> area(all.size(), 0.0), most(all.size(), 0.0); // most: by the face that a node faces most, N
    std::vector<Vec3> normal(all.size(), Vec3::Zero());
    std::vector<Vec3> x(4); // of a facet
    for (const model::Body& body : model.bodies) {
        const std::vector<mesh::Facet> facets = model::exterior_facets(body);
        // a node on an edge: only the faces that contact presses on count; all of them where it presses on the edge itself
        const auto for_each_pressed = [&](auto&& use) {
            for (const mesh::Facet& facet : facets) {
                const auto node = [&](int c) {
                    return static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(c)]);
                };
                mesh::Facet corners = facet;
                bool reached = false;
                for (int c = 0; c < facet.count; ++c) {
                    x[static_cast<std::size_t>(c)] = model.X[node(c)] + state.u[node(c)];
                    corners.nodes[static_cast<std::size_t>(c)] = c;
                    reached |= all.place(node(c)) >= 0;
                }
                if (!reached) continue;
                const Vec3 across = mesh::facet_area_vector(corners, x);
                for (int c = 0; c < facet.count; ++c) {
                    if (all.place(node(c)) < 0) continue;
                    const auto place = static_cast<std::size_t>(all.place(node(c)));
                    const double towards = -pressing[place].dot(across);
                    if (towards > 0) use(facet, c, place, across, towards / across.norm());
                }
            }
        };
        for_each_pressed([&](const mesh::Facet&, int, std::size_t place, const Vec3&, double by) {
            most[place] = std::max(most[place], by);
        });
        for_each_pressed([&](const mesh::Facet& facet, int c, std::size_t place, const Vec3& across, double by) {
            if (by < faces_it * most[place]) return;
            area[place] += fe::tributary_areas(facet, model.X)[static_cast<std::size_t>(c)];
            normal[place] += across;
        });
    }
    for (std::size_t i = 0; i < all.size(); ++i)
        if (area[i] > 0) all.at(i).pressure = -all.at(i).force.dot(normal[i].normalized()) / area[i];
    return all;
}

} // namespace osculate::output
