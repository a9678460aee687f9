#include "contact/vertex_patch.hpp"

#include "contact/fold.hpp"
#include "contact/largest_turn.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace osculate::contact {

namespace {

constexpr int highest_level = 5;
constexpr double kappa_aim = 0.8;     ///< where neither interpolation nor coverage asks for another
constexpr double beyond_nodes = 1.15; ///< least tau at nodes outside the patch: the bump has ended there
constexpr double most_stretch = 4;    ///< of edges one way to those across, in natural coordinates
constexpr double covered = 0.75;      ///< largest tau at the vertex's own edge midpoints and facet centres

std::vector<Index> grown(const mesh::HalfEdgeSurface& surface, const std::vector<Index>& facets) {
    std::vector<Index> result;
    for (const Index f : facets) {
        const auto ring = surface.ring_facets(f, 1);
        result.insert(result.end(), ring.begin(), ring.end());
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

std::vector<Index> corners(const mesh::HalfEdgeSurface& surface, const std::vector<Index>& facets) {
    std::vector<Index> result;
    for (const Index f : facets) {
        const auto v = surface.facet_vertices(f);
        result.insert(result.end(), v.begin(), v.end());
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

/// Corner normals weighted with the corner angles.
Vec3 vertex_normal(const mesh::HalfEdgeSurface& surface, Index vertex, const std::vector<Index>& sector,
                   const std::vector<Vec3>& X) {
    Vec3 sum = Vec3::Zero();
    for (const Index f : sector) {
        const auto v = surface.facet_vertices(f);
        const std::size_t n = v.size(), c = static_cast<std::size_t>(std::find(v.begin(), v.end(), vertex) - v.begin());
        const Vec3 a = (X[v[(c + 1) % n]] - X[vertex]).normalized(),
                   b = (X[v[(c + n - 1) % n]] - X[vertex]).normalized();
        sum += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * a.cross(b).normalized();
    }
    return sum.normalized();
}

/// Map of natural coordinates that makes strongly stretched facets square, area kept. Without it the round-off of the
/// interpolation grows with the square of the stretch: dc is the short edge, and the long ones are far out on the basis.
/// @param S  mean of u_j u_j^T over the edge neighbours, from the vertex
Mat2 unstretching(const Mat2& S) {
    const Eigen::SelfAdjointEigenSolver<Mat2> axes(S);
    const Vec2& squares = axes.eigenvalues(); // ascending
    if (!(squares(0) > 0) || squares(1) <= most_stretch * most_stretch * squares(0)) return Mat2::Identity();
    return std::pow(S.determinant(), 0.25) * axes.operatorInverseSqrt();
}

/// Angles of facets to the normal at a vertex.
std::vector<double> turns(const mesh::HalfEdgeSurface& surface, Index vertex, const std::vector<Index>& sector,
                          const std::vector<Index>& facets, const std::vector<Vec3>& X) {
    const Vec3 up = vertex_normal(surface, vertex, sector, X);
    std::vector<double> result;
    for (const Index f : facets) {
        const auto v = surface.facet_vertices(f);
        const Vec3 a = v.size() == 4 ? Vec3(X[v[2]] - X[v[0]]) : Vec3(X[v[1]] - X[v[0]]),
                   b = v.size() == 4 ? Vec3(X[v[3]] - X[v[1]]) : Vec3(X[v[2]] - X[v[0]]);
        const Vec3 n = a.cross(b);
        result.push_back(std::atan2(n.cross(up).norm(), n.dot(up)));
    }
    return result;
}

std::optional<VertexPatch> make_patch(const mesh::HalfEdgeSurface& surface, Index vertex,
                                      const std::vector<Index>& sector, const std::vector<Vec3>& X,
                                      const BlendOptions& options) {
    const ReferencePlane plane = ReferencePlane::through(X[vertex], vertex_normal(surface, vertex, sector, X));
    const auto in_plane = [&](const Vec3& x) {
        return options.coordinates == PatchCoordinates::tangential ? plane.tangential(x) : plane.equal_length(x);
    };
    std::vector<Index> neighbours;
    for (const Index f : sector) {
        const auto v = surface.facet_vertices(f);
        const std::size_t n = v.size(), c = static_cast<std::size_t>(std::find(v.begin(), v.end(), vertex) - v.begin());
        for (const Index w : {v[(c + 1) % n], v[(c + n - 1) % n]}) neighbours.push_back(w);
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    Mat2 S = Mat2::Zero();
    for (const Index w : neighbours)
        S += in_plane(X[w]) * in_plane(X[w]).transpose() / static_cast<double>(neighbours.size());
    const Mat2 W = unstretching(S);
    const auto natural = [&](const Vec3& x) -> Vec2 { return W * in_plane(x); };
    // M from the edge neighbours; q = u^T M u is about 1 at them
    Mat2 sum = Mat2::Zero();
    double near = 0;
    std::vector<Vec2> own; // where the bump must still be high
    for (const Index f : sector) {
        const auto v = surface.facet_vertices(f);
        Vec3 centroid = Vec3::Zero();
        for (const Index w : v) centroid += X[w] / static_cast<double>(v.size());
        own.push_back(natural(centroid));
    }
    for (const Index w : neighbours) {
        const Vec2 u = natural(X[w]);
        sum += u * u.transpose() / static_cast<double>(neighbours.size());
        own.push_back(natural((X[vertex] + X[w]) / 2));
    }
    VertexPatch patch{vertex,
                      0,
                      {},
                      *RpimPatch::fit((MatrixX2(3, 2) << 0, 0, 1, 0, 0, 1).finished(), {}, 3),
                      0.5 * sum.inverse(),
                      kappa_aim,
                      natural(X[vertex]),
                      sector,
                      {},
                      {}};
    if (!patch.metric.allFinite()) return std::nullopt;
    const auto q = [&](const Vec2& u) { return u.dot(patch.metric * u); };
    for (const Vec2& u : own) near = std::max(near, q(u));

    std::vector<Index> within = sector;
    for (int level = 1; level < options.level; ++level) within = grown(surface, within);
    const Multiquadric basis = options.basis                  ? *options.basis
                               : options.polynomial_terms < 6 ? r3 // r^5 needs quadratics
                                                              : basis_for(largest_turn(surface, within, X));
    std::vector<Index> facets = sector;
    bool covered_already = false; // by a patch of fewer rings
    for (int level = 1; level <= highest_level; ++level) {
        if (level > 1) {
            std::vector<Index> next = grown(surface, facets);
            if (next.size() == facets.size() && level > options.level) break; // the whole smooth part is in
            facets = std::move(next);
        }
        if (folds(surface, facets, plane, X)) break; // Fig. 5d: what fits so far has to do
        const std::vector<Index> vertices = corners(surface, facets);
        if (level < options.level && !folds(surface, grown(surface, facets), plane, X)) continue;
        MatrixX2 u(static_cast<Index>(vertices.size()), 2), flat(u.rows(), 2);
        for (Index i = 0; i < u.rows(); ++i) {
            u.row(i) = natural(X[vertices[i]]).transpose();
            flat.row(i) = (W * plane.tangential(X[vertices[i]])).transpose();
        }
        auto shape = RpimPatch::fit(u, flat, options.basis, basis, options.polynomial_terms);
        if (!shape) continue;
        // the bump ends before the nearest node that the patch does not pass through
        double far = std::numeric_limits<double>::max();
        for (const Index w : corners(surface, grown(surface, facets)))
            if (!std::binary_search(vertices.begin(), vertices.end(), w)) far = std::min(far, q(natural(X[w])));
        const double lowest = beyond_nodes / far, highest = covered / near;
        const bool covers = lowest <= highest, good = covers && shape->polynomial_terms() == options.polynomial_terms;
        // more rings are of use only if they bring the terms that are missing, as they do not along two rows of nodes
        if (!good && covered_already) continue;
        covered_already = covers;
        patch.level = level;
        patch.vertices = vertices;
        patch.facets = facets;
        patch.shape = std::move(*shape);
        patch.kappa = std::min(std::max(kappa_aim, lowest), highest);
        if (lowest > highest) patch.kappa = lowest; // interpolation before coverage, should no ring be left
        if (good) break;
    }
    if (patch.level == 0 && options.level > 1) { // near-duplicate nodes further out that could not be merged, perhaps
        BlendOptions fewer = options;
        --fewer.level;
        return make_patch(surface, vertex, sector, X, fewer);
    }
    if (patch.level == 0) return std::nullopt;
    patch.turn = turns(surface, vertex, sector, patch.facets, X);
    return patch;
}

} // namespace

std::vector<std::vector<Index>> sectors(const mesh::HalfEdgeSurface& surface, Index vertex) {
    const auto fan = surface.vertex_facets(vertex);
    std::vector<std::vector<Index>> result;
    std::vector<char> taken(fan.size(), 0);
    for (std::size_t seed = 0; seed < fan.size(); ++seed) {
        if (taken[seed] != 0) continue;
        std::vector<Index> sector{fan[seed]};
        taken[seed] = 1;
        for (std::size_t next = 0; next < sector.size(); ++next) {
            const auto v = surface.facet_vertices(sector[next]);
            const auto across = surface.edge_neighbours(sector[next]);
            const int n = static_cast<int>(v.size());
            for (int c = 0; c < n; ++c) {
                if (v[c] != vertex && v[(c + 1) % n] != vertex) continue;
                if (across[c] < 0 || surface.is_feature_edge(surface.first_half_edge(sector[next]) + c)) continue;
                const auto place = std::find(fan.begin(), fan.end(), across[c]) - fan.begin();
                if (taken[place] != 0) continue;
                taken[place] = 1;
                sector.push_back(across[c]);
            }
        }
        std::sort(sector.begin(), sector.end());
        result.push_back(std::move(sector));
    }
    return result;
}

VertexPatches::VertexPatches(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                             const BlendOptions& options)
    : of_facet(static_cast<std::size_t>(surface.facet_count())), bare(of_facet.size(), 0), surface_(&surface),
      merged_(merged(surface, X, options.level)), options_(options) {
    if (const MergedSurface* fewer = merged_.get()) {
        VertexPatches found(fewer->topology, fewer->X, options);
        fallbacks = found.fallbacks + surface.vertex_count() - fewer->topology.vertex_count();
        patches = std::move(found.patches);
        numbers = std::move(found.numbers);
        for (VertexPatch& patch : patches) {
            patch.vertex = fewer->vertex[patch.vertex];
            for (Index& v : patch.vertices) v = fewer->vertex[v];
        }
        for (Index f = 0; f < surface.facet_count(); ++f) {
            of_facet[f] = found.of_facet[fewer->host[f]];
            bare[f] = found.bare[fewer->host[f]];
        }
        return;
    }
    std::vector<std::vector<std::pair<Index, Index>>> corner_patch(of_facet.size()); // facet -> (vertex, patch)
    for (Index v = 0; v < surface.vertex_count(); ++v)
        for (const auto& sector : sectors(surface, v)) {
            auto patch = make_patch(surface, v, sector, X, options);
            if (!patch) {
                ++fallbacks;
                for (const Index f : sector) bare[f] = 1;
                continue;
            }
            if (patch->level < options.level || patch->shape.polynomial_terms() < options.polynomial_terms) ++fallbacks;
            for (const Index f : sector) corner_patch[f].emplace_back(v, static_cast<Index>(patches.size()));
            patches.push_back(std::move(*patch));
        }
    for (Index f = 0; f < surface.facet_count(); ++f) {
        auto& list = of_facet[f];
        for (const Index g : surface.ring_facets(f, 2))
            for (const auto& [vertex, patch] : corner_patch[g]) list.push_back(patch);
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    std::vector<RpimPatch*> shapes;
    for (VertexPatch& patch : patches) shapes.push_back(&patch.shape);
    numbers = RpimPatch::put_together(shapes);
}

std::vector<Index> VertexPatches::looked_at(Index patch) const {
    // make_patch() looks one ring further than the highest level it tries, which starts from the sector
    std::vector<Index> facets = patches[patch].sector;
    for (int ring = 0; ring < highest_level; ++ring) facets = grown(topology(), facets);
    return corners(topology(), facets);
}

Index VertexPatches::own(Index vertex) const {
    // vertices of the merged surface are ascending in those of the original
    if (!merged_) return vertex;
    return static_cast<Index>(std::ranges::lower_bound(merged_->vertex, vertex) - merged_->vertex.begin());
}

std::vector<Vec3> VertexPatches::kept(const std::vector<Vec3>& x) const {
    if (!merged_) return x;
    std::vector<Vec3> at;
    for (const Index v : merged_->vertex) at.push_back(x[v]);
    return at;
}

bool VertexPatches::fit(Index p, const std::vector<Vec3>& x) {
    VertexPatch& patch = patches[p];
    auto fresh = make_patch(topology(), own(patch.vertex), patch.sector, x, options_);
    if (!fresh) return false;
    if (merged_) {
        fresh->vertex = patch.vertex;
        for (Index& v : fresh->vertices) v = merged_->vertex[v];
    }
    patch = std::move(*fresh);
    auto& at = fitted_at_[p];
    at.clear();
    for (const Index v : looked_at(p)) at.push_back(x[v]);
    return true;
}

std::vector<Index> VertexPatches::bent(const std::vector<Vec3>& x) const {
    constexpr double most_turning = 60 * std::numbers::pi / 180;
    const std::vector<Vec3> at = kept(x);
    std::vector<Index> result;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const VertexPatch& patch = patches[p];
        const std::vector<double> now = turns(topology(), own(patch.vertex), patch.sector, patch.facets, at);
        bool turned = false;
        for (std::size_t f = 0; f < now.size(); ++f) turned = turned || std::abs(now[f] - patch.turn[f]) > most_turning;
        if (turned) result.push_back(static_cast<Index>(p));
    }
    return result;
}

Index VertexPatches::fit(const std::vector<Index>& list, const std::vector<Vec3>& x) {
    const std::vector<Vec3> at = kept(x);
    Index done = 0;
    for (const Index p : list) done += fit(p, at) ? 1 : 0;
    refits += done;
    return done;
}

std::vector<RefittedPatch> VertexPatches::refitted() const {
    std::vector<RefittedPatch> list;
    for (const auto& [patch, at] : fitted_at_) list.push_back({patch, at});
    return list;
}

bool VertexPatches::refit(const std::vector<RefittedPatch>& list) {
    std::vector<Vec3> x(static_cast<std::size_t>(topology().vertex_count()), Vec3::Zero());
    for (const auto& [patch, at] : list) {
        if (patch < 0 || patch >= static_cast<Index>(patches.size())) return false;
        const std::vector<Index> vertices = looked_at(patch);
        if (vertices.size() != at.size()) return false;
        for (std::size_t k = 0; k < at.size(); ++k) x[vertices[k]] = at[k];
        if (!fit(patch, x)) return false;
    }
    refits += static_cast<Index>(list.size());
    return true;
}

std::vector<VertexPatchInfo> vertex_patches(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                                            const BlendOptions& options) {
    std::vector<VertexPatchInfo> result;
    for (const VertexPatch& p : VertexPatches(surface, X, options).patches)
        result.push_back({p.vertex, p.level, p.kappa, p.metric, p.vertices});
    return result;
}

} // namespace osculate::contact
