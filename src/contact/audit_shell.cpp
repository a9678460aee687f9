#include "contact/audit_shell.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace osculate::contact {

SurfaceAudit::Shell::Shell(const std::vector<mesh::Facet>& outer, const std::vector<Vec3>& X,
                           std::vector<Index>& shell_node)
    : facets(outer), neighbours(outer.size()) {
    std::map<std::pair<Index, Index>, std::vector<Index>> around; // facets of each edge
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const mesh::Facet& facet = facets[f];
        size.push_back(std::sqrt(mesh::facet_area_vector(facet, X).norm()));
        for (int c = 0; c < facet.count; ++c) {
            const Index a = facet.nodes[c], b = facet.nodes[(c + 1) % facet.count];
            around[std::minmax(a, b)].push_back(static_cast<Index>(f));
            if (shell_node[a] < 0) {
                shell_node[a] = static_cast<Index>(nodes.size());
                nodes.push_back(a);
            }
        }
    }
    node_facets.resize(nodes.size());
    node_nodes.resize(nodes.size());
    for (std::size_t f = 0; f < facets.size(); ++f)
        for (const Index node : facets[f]) node_facets[shell_node[node]].push_back(static_cast<Index>(f));
    for (const auto& [ends, list] : around) {
        edges.push_back({ends.first, ends.second});
        const Index a = shell_node[ends.first], b = shell_node[ends.second];
        node_nodes[a].push_back(b);
        node_nodes[b].push_back(a);
        for (const Index f : list)
            for (const Index g : list)
                if (f != g) neighbours[f].push_back(g);
    }
    find_components();
    Vec3 centre = Vec3::Zero();
    for (const Index node : nodes) centre += X[node] / static_cast<double>(nodes.size());
    for (const Index node : nodes) drawn.push_back(X[node] - centre);
    finest = size.empty() ? 0 : *std::ranges::min_element(size);
}

double SurfaceAudit::Shell::change_of_shape(const std::vector<Vec3>& x) const {
    Vec3 centre = Vec3::Zero();
    for (const Index node : nodes) centre += x[node] / static_cast<double>(nodes.size());
    Mat3 A = Mat3::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k) A += (x[nodes[k]] - centre) * drawn[k].transpose();
    const Mat3 R = nearest_rotation(A);
    double farthest = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
        farthest = std::max(farthest, (x[nodes[k]] - centre - R * drawn[k]).squaredNorm());
    return std::sqrt(farthest);
}

void SurfaceAudit::Shell::find_components() {
    std::vector<char> seen(nodes.size(), 0);
    for (std::size_t first = 0; first < nodes.size(); ++first) {
        if (seen[first]) continue;
        std::vector<Index>& part = components.emplace_back(1, static_cast<Index>(first));
        seen[first] = 1;
        for (std::size_t k = 0; k < part.size(); ++k)
            for (const Index next : node_nodes[part[k]])
                if (!seen[next]) {
                    seen[next] = 1;
                    part.push_back(next);
                }
    }
}

} // namespace osculate::contact
