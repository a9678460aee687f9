#include "app/check/pairing_advice.hpp"

#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace osculate::app {

namespace {
/// Distance of the nodes of a facet from its area: two triangles make a square.
double spacing(double area, int corners) {
    return std::sqrt(corners == 3 ? 2 * area : area);
}
} // namespace

Pairing pairing(const model::ContactEvaluation& evaluation, const model::Model& model) {
    const std::vector<Vec3>& X = model.X.values();
    const model::ContactPair& pair = evaluation.pair();
    constexpr double apart = 1e-3; // of the facet size: nodes that do not coincide
    Pairing result;
    result.discretisation = pair.options().discretisation;
    for (const mesh::Facet& facet : pair.slaves().facets)
        for (const Index node : facet)
            if (!std::ranges::binary_search(pair.slaves().node, node)) return result; // a slice
    const std::vector<Vec3> master = pair.vertices(X);
    std::map<Index, bool> is_near; // slave node
    for (Index j = 0; j < pair.size(); ++j) {
        const contact::FacetHit& hit = evaluation.hit(j);
        if (hit.facet < 0) continue;
        const double size = pair.surface().facet_size(hit.facet);
        if (hit.distance > size || hit.boundary) continue;
        const Index node = pair.slaves().node[j];
        is_near[node] = true;
        result.midside = result.midside || model::material_node(model, node) != node;
        ++result.near;
        const auto vertices = pair.surface().facet_vertices(hit.facet);
        result.master_spacing += spacing(size * size, static_cast<int>(vertices.size()));
        result.matching =
            result.matching && std::ranges::any_of(vertices, [&](Index v) {
                const Vec3 beside = master[v] - X[node];
                return std::sqrt(std::max(0.0, beside.squaredNorm() - hit.distance * hit.distance)) < apart * size;
            });
    }
    if (result.near == 0) return result;
    result.master_spacing /= static_cast<double>(result.near);
    Index facets = 0;
    for (const mesh::Facet& facet : pair.slaves().facets) {
        if (std::none_of(facet.begin(), facet.end(), [&](Index node) { return is_near.contains(node); })) continue;
        const auto area = fe::tributary_areas(facet, X);
        result.slave_spacing += spacing(std::accumulate(area.begin(), area.end(), 0.0), facet.count);
        ++facets;
    }
    if (facets > 0) result.slave_spacing /= static_cast<double>(facets);
    return result;
}

std::vector<std::string> advice(const Pairing& pairing) {
    if (pairing.near == 0 || averages(pairing.discretisation)) return {};
    // docs/verification: nested tubes 0.4 against 0.8 %, foundation on triangles 5 against 30 % of uneven pressure
    constexpr double coarser = 1.1;
    constexpr double alike = 0.05;
    const double ratio = pairing.slave_spacing / pairing.master_spacing;
    if (pairing.matching && std::abs(ratio - 1) < alike) return {};
    std::vector<std::string> sentences;
    if (pairing.midside)
        sentences.emplace_back(
            "corners and midside nodes of the slave share its force unevenly, by some 30 % at single "
            "nodes: discretisation: petrov_galerkin or mortar would even out the pressures");
    if (ratio > coarser)
        sentences.push_back(
            fmt::format("the slave's nodes are {:.2g} times as far apart as the master's: with contact at the "
                        "nodes the finer side should be the slave",
                        ratio));
    sentences.emplace_back(
        "the meshes do not match: discretisation: petrov_galerkin would even out the pressures at single nodes");
    return sentences;
}

} // namespace osculate::app
