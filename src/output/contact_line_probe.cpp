/// Probes along lines and arcs on slave surfaces.

#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/search.hpp"
#include "output/line_probe.hpp"

#include <fmt/format.h>
#include <stdexcept>

namespace osculate::output {

namespace {

/// The probe at the points of the undeformed slave surface that are closest to samples; these are moved there.
/// @param farthest  from the surface, m; else std::invalid_argument names the `shape`
std::unique_ptr<Probe> on_slave_surface(const model::Model& model, Index pair, std::vector<LineProbe::Sample> samples,
                                        double farthest, const char* shape, const FieldNames& fields) {
    const model::SlaveNodes& slaves = model.pairs[static_cast<std::size_t>(pair)]->slaves();
    std::vector<Index> slave_of(model.X.size(), -1);
    for (std::size_t j = 0; j < slaves.node.size(); ++j)
        slave_of[static_cast<std::size_t>(slaves.node[j])] = static_cast<Index>(j);
    const mesh::HalfEdgeSurface surface(slaves.facets, model.X);
    std::vector<Vec3> X;
    for (const Index node : surface.vertex_nodes()) X.push_back(model.X[static_cast<std::size_t>(node)]);
    contact::FacetSearch search(surface);
    search.build(X);
    std::vector<Between> places;
    for (LineProbe::Sample& sample : samples) {
        const contact::FacetHit hit = search.global(sample.X - model.origin, X);
        if (hit.distance > farthest)
            throw std::invalid_argument(fmt::format("{} {:.3g} m away from its slave surface", shape, hit.distance));
        const auto vertices = surface.facet_vertices(hit.facet);
        const contact::FacetPatch patch(static_cast<int>(vertices.size()));
        Between place{{}, Vector::Zero(patch.size())};
        contact::MatrixX2 gradients(patch.size(), 2);
        patch.weights(hit.u, place.weights, gradients);
        sample.X = model.origin;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            const Index node = surface.vertex_nodes()[static_cast<std::size_t>(vertices[k])];
            if (slave_of[static_cast<std::size_t>(node)] < 0)
                throw std::invalid_argument(
                    fmt::format("{} on a slice, whose facets have slaves at one side alone", shape));
            place.points.push_back(slave_of[static_cast<std::size_t>(node)]);
            sample.X += place.weights(static_cast<Index>(k)) * model.X[static_cast<std::size_t>(node)];
        }
        places.push_back(std::move(place));
    }
    return std::make_unique<LineProbe>(FieldPlace::slave, pair, std::move(samples), std::move(places), fields);
}

} // namespace

std::unique_ptr<Probe> make_contact_line_probe(const model::Model& model, Index pair, const Vec3& from, const Vec3& to,
                                               int samples, const FieldNames& fields) {
    return on_slave_surface(model, pair, LineProbe::line(from, to, samples), (to - from).norm(), "a line", fields);
}

std::unique_ptr<Probe> make_contact_arc_probe(const model::Model& model, Index pair, const Vec3& centre,
                                              const Vec3& axis, const Vec3& from, double angle, int samples,
                                              const FieldNames& fields) {
    const Vec3 e = axis.normalized(), arm = from - centre;
    const double radius = (arm - e * e.dot(arm)).norm();
    if (!(radius > 1e-9 * arm.norm())) throw std::invalid_argument("an arc that begins on its axis");
    return on_slave_surface(model, pair, LineProbe::arc(centre, axis, from, angle, samples), radius, "an arc", fields);
}

} // namespace osculate::output
