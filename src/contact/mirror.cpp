#include "osculate/contact/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace osculate::contact {
namespace {

constexpr int rings = 6; ///< of facets beyond the planes: more than patches and their bumps reach

/// Grows the surface by its images, ring by ring. What lies around image A x of a node x is what A makes of the facets
/// around x and of all their images that keep x where it is, so several planes, parallel ones among them, need no order.
class Grower {
public:
    Grower(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& X, const std::vector<SymmetryPlane>& planes,
           double depth)
        : originals_(facets), X_(X), planes_(planes), depth_(depth), on_plane_(1e-6 * depth), around_(X.size()) {
        surface_.facets = facets;
        surface_.positions = X;
        surface_.original.resize(X.size());
        std::iota(surface_.original.begin(), surface_.original.end(), 0);
        surface_.image.assign(X.size(), 0);
        for (std::size_t f = 0; f < facets.size(); ++f)
            for (const Index node : facets[f]) around_[static_cast<std::size_t>(node)].push_back(static_cast<Index>(f));
    }

    MirroredSurface run() {
        std::vector<Placed> front;
        for (std::size_t f = 0; f < originals_.size(); ++f) {
            front.push_back({static_cast<Index>(f), 0});
            present_.insert(front.back());
        }
        for (int ring = 0; ring < rings && !front.empty(); ++ring) {
            std::vector<Placed> next;
            for (const Placed& facet : front)
                for (const Index node : originals_[static_cast<std::size_t>(facet.first)])
                    for (const Index fixing : stabiliser(node)) {
                        const Index image = composed(facet.second, fixing);
                        for (const Index f : around_[static_cast<std::size_t>(node)])
                            if (Placed placed{f, image}; wanted(placed) && present_.insert(placed).second) {
                                add(placed);
                                next.push_back(placed);
                            }
                    }
            front = std::move(next);
        }
        return std::move(surface_);
    }

private:
    using Placed = std::pair<Index, Index>; ///< facet and image

    [[nodiscard]] double distance(const SymmetryPlane& plane, const Vec3& x) const {
        return std::abs(plane.normal.dot(x - plane.point));
    }

    /// The image's place among `images`, where it is put if it is new.
    Index numbered(const Image& image) {
        for (std::size_t i = 0; i < surface_.images.size(); ++i)
            if ((surface_.images[i].M - image.M).norm() < 1e-6 && (surface_.images[i].t - image.t).norm() <= on_plane_)
                return static_cast<Index>(i);
        surface_.images.push_back(image);
        return static_cast<Index>(surface_.images.size()) - 1;
    }

    /// What `second` does, then `first`.
    Index composed(Index first, Index second) {
        if (first == 0 || second == 0) return first + second;
        const auto [entry, fresh] = products_.try_emplace({first, second}, 0);
        if (fresh) {
            const Image &a = surface_.images[static_cast<std::size_t>(first)],
                        &b = surface_.images[static_cast<std::size_t>(second)];
            entry->second = numbered({a.M * b.M, a.M * b.t + a.t});
        }
        return entry->second;
    }

    /// Images that keep the node where it is, the identity first.
    const std::vector<Index>& stabiliser(Index node) {
        std::vector<std::size_t> through;
        for (std::size_t p = 0; p < planes_.size(); ++p)
            if (distance(planes_[p], X_[static_cast<std::size_t>(node)]) <= on_plane_) through.push_back(p);
        const auto [entry, fresh] = stabilisers_.try_emplace(through);
        std::vector<Index>& group = entry->second;
        if (!fresh) return group;
        group.push_back(0);
        std::vector<Index> reflections;
        for (const std::size_t p : through) {
            const SymmetryPlane& plane = planes_[p];
            const Index reflection = numbered({Mat3::Identity() - 2 * plane.normal * plane.normal.transpose(),
                                               2 * plane.normal.dot(plane.point) * plane.normal});
            if (std::ranges::count(reflections, reflection) == 0) reflections.push_back(reflection);
        }
        // planes at angles that divide a half turn make a finite group, a cube's at most; others are let be
        constexpr std::size_t largest = 48;
        for (std::size_t i = 0; i < group.size() && group.size() <= largest; ++i)
            for (const Index reflection : reflections)
                if (const Index product = composed(reflection, group[i]); std::ranges::count(group, product) == 0)
                    group.push_back(product);
        if (group.size() > largest) {
            group = {0};
            group.insert(group.end(), reflections.begin(), reflections.end());
        }
        return group;
    }

    /// Not in a plane, where it would be its own image, and not too far from all of them.
    [[nodiscard]] bool wanted(const Placed& placed) const {
        const mesh::Facet& facet = originals_[static_cast<std::size_t>(placed.first)];
        double nearest = std::numeric_limits<double>::infinity();
        for (const SymmetryPlane& plane : planes_) {
            double farthest = 0;
            for (const Index node : facet) {
                const Vec3& X = X_[static_cast<std::size_t>(node)];
                farthest = std::max(farthest, distance(plane, X));
                nearest =
                    std::min(nearest, distance(plane, surface_.images[static_cast<std::size_t>(placed.second)](X)));
            }
            if (farthest <= on_plane_) return false;
        }
        return nearest <= depth_;
    }

    void add(const Placed& placed) {
        mesh::Facet facet = originals_[static_cast<std::size_t>(placed.first)];
        const Image& image = surface_.images[static_cast<std::size_t>(placed.second)];
        for (int c = 0; c < facet.count; ++c) {
            Index& node = facet.nodes[static_cast<std::size_t>(c)];
            node = at(node, image(X_[static_cast<std::size_t>(node)]), placed.second);
        }
        if (image.M.determinant() < 0) // a reflection turns it over
            std::reverse(facet.nodes.begin(), facet.nodes.begin() + facet.count);
        surface_.facets.push_back(facet);
    }

    /// The node itself, or its ghost at this position.
    Index at(Index node, const Vec3& position, Index image) {
        if ((position - X_[static_cast<std::size_t>(node)]).norm() <= on_plane_) return node;
        std::vector<Index>& ghosts = ghosts_[node];
        for (const Index ghost : ghosts)
            if ((position - surface_.positions[static_cast<std::size_t>(ghost)]).norm() <= on_plane_) return ghost;
        ghosts.push_back(static_cast<Index>(surface_.positions.size()));
        surface_.positions.push_back(position);
        surface_.original.push_back(node);
        surface_.image.push_back(image);
        return ghosts.back();
    }

    const std::vector<mesh::Facet>& originals_;
    const std::vector<Vec3>& X_;
    const std::vector<SymmetryPlane>& planes_;
    double depth_, on_plane_;
    std::vector<std::vector<Index>> around_; ///< facets at each node
    MirroredSurface surface_;
    std::set<Placed> present_;
    std::map<std::vector<std::size_t>, std::vector<Index>> stabilisers_; ///< by the planes through a node
    std::map<std::pair<Index, Index>, Index> products_;
    std::map<Index, std::vector<Index>> ghosts_;
};

} // namespace

MirroredSurface mirror(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& X,
                       const std::vector<SymmetryPlane>& planes, double depth) {
    return Grower(facets, X, planes, depth).run();
}

} // namespace osculate::contact
