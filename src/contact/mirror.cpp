#include "osculate/contact/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace osculate::contact {

MirroredSurface mirror(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& X,
                       const std::vector<SymmetryPlane>& planes, double depth) {
    MirroredSurface surface;
    surface.facets = facets;
    surface.positions = X;
    surface.original.resize(X.size());
    std::iota(surface.original.begin(), surface.original.end(), 0);
    surface.image.assign(X.size(), 0);
    const double on_plane = 1e-6 * depth;
    for (const SymmetryPlane& plane : planes) {
        const auto distance = [&](Index node) { return plane.normal.dot(surface.positions[node] - plane.point); };
        const Mat3 reflection = Mat3::Identity() - 2 * plane.normal * plane.normal.transpose();
        std::map<Index, Index> ghost;    // node -> its ghost beyond this plane
        std::map<Index, Index> mirrored; // image -> its reflection
        const std::size_t count = surface.facets.size();
        for (std::size_t f = 0; f < count; ++f) {
            mesh::Facet facet = surface.facets[f];
            double nearest = std::abs(distance(facet.nodes[0])), farthest = 0;
            for (const Index node : facet) {
                nearest = std::min(nearest, std::abs(distance(node)));
                farthest = std::max(farthest, std::abs(distance(node)));
            }
            if (nearest > depth || farthest <= on_plane) continue;
            for (int c = 0; c < facet.count; ++c) {
                Index& node = facet.nodes[static_cast<std::size_t>(c)];
                if (std::abs(distance(node)) <= on_plane) continue;
                const auto [entry, fresh] = ghost.try_emplace(node, static_cast<Index>(surface.positions.size()));
                if (fresh) {
                    const Index before = surface.image[node];
                    const auto [image, unseen] =
                        mirrored.try_emplace(before, static_cast<Index>(surface.images.size()));
                    if (unseen) {
                        const Image& old = surface.images[before];
                        const Vec3 shift = 2 * plane.normal.dot(plane.point) * plane.normal;
                        surface.images.push_back({reflection * old.M, reflection * old.t + shift});
                    }
                    surface.original.push_back(surface.original[node]);
                    surface.image.push_back(image->second);
                    surface.positions.push_back(surface.images[image->second](X[surface.original[node]]));
                }
                node = entry->second;
            }
            std::reverse(facet.nodes.begin(), facet.nodes.begin() + facet.count); // a reflection turns it over
            surface.facets.push_back(facet);
        }
    }
    return surface;
}

} // namespace osculate::contact
