#include "contact/blend_variation.hpp"
#include "contact/reach.hpp"
#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/projection.hpp"
#include "osculate/core/parallel.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

class BlendSurface final : public MasterSurface {
public:
    BlendSurface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const BlendOptions& options)
        : surface_(surface), vertex_patches_(surface, X, options), facets_(make_facets_surface(surface)) {
        find_creases();
        find_reach();
    }

    void find_reach() {
        reach_.clear();
        for (Index f = 0; f < surface_.facet_count(); ++f) {
            std::vector<Index> nodes;
            const auto add = [&](Index facet) {
                for (const Index p : vertex_patches_.of_facet[facet]) {
                    const auto& own = vertex_patches_.patches[p].vertices;
                    nodes.insert(nodes.end(), own.begin(), own.end());
                }
                const auto own = surface_.facet_vertices(facet);
                if (vertex_patches_.bare[facet] != 0) nodes.insert(nodes.end(), own.begin(), own.end());
            };
            add(f);
            for (const Neighbour& other : creases_[f]) add(other.facet);
            std::sort(nodes.begin(), nodes.end());
            nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
            reach_.push_back(std::move(nodes));
        }
    }

    std::span<const Index> patch_vertices(Index facet) const override { return reach_[facet]; }
    Index fallbacks() const override { return vertex_patches_.fallbacks; }

    void place(std::span<const FacetHit> hits, const std::vector<Vec3>& x, int threads,
               std::unique_ptr<Placement>& placement) const override {
        if (!placement) placement = std::make_unique<Placed>();
        auto& placed = static_cast<Placed&>(*placement);
        std::vector<PlacedPatch>& patches = placed.patches;
        std::vector<char>& wanted = placed.wanted;
        patches.resize(vertex_patches_.patches.size());
        wanted.assign(patches.size(), 0);
        const auto want = [&](Index facet) {
            for (const Index p : vertex_patches_.of_facet[facet]) wanted[p] = 1;
        };
        for (const FacetHit& hit : hits)
            if (hit.facet >= 0) {
                want(hit.facet);
                for (const Neighbour& other : creases_[hit.facet]) want(other.facet);
            }
        parallel_for(threads, static_cast<Index>(patches.size()), [&](Index begin, Index end) {
            for (Index p = begin; p < end; ++p)
                if (wanted[p] != 0) patches[p].place(vertex_patches_.patches[p], x);
        });
    }

    [[nodiscard]] bool refits() const override { return true; }
    [[nodiscard]] Index refits_done() const override { return vertex_patches_.refits; }
    [[nodiscard]] std::shared_ptr<const MasterSurface> refitted(const std::vector<Vec3>& x) const override {
        const std::vector<Index> bent = vertex_patches_.bent(x);
        if (bent.empty()) return nullptr;
        auto other = std::make_shared<BlendSurface>(*this);
        if (other->vertex_patches_.fit(bent, x) == 0) return nullptr;
        other->find_reach();
        return other;
    }

    [[nodiscard]] std::vector<RefittedPatch> refitted_patches() const override { return vertex_patches_.refitted(); }
    [[nodiscard]] std::shared_ptr<const MasterSurface>
    refitted(const std::vector<RefittedPatch>& patches) const override {
        auto other = std::make_shared<BlendSurface>(*this);
        if (!other->vertex_patches_.refit(patches)) return nullptr;
        other->find_reach();
        return other;
    }

    void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                  ContactVariation* variation, const Placement* placement) const override {
        point.found = point.behind = false;
        point.facet = hit.facet;
        if (hit.facet < 0) return;
        const double size = surface_.facet_size(hit.facet);
        if (beyond_boundary(hit, size)) return;
        const std::shared_ptr<Side> trace = own_trace(point);
        Side& side = *trace;
        side = seen_from(s, hit, x, placement);
        for (const Index facet : across_crease(hit)) {
            FacetHit there;
            there.facet = facet;
            there.distance = hit.distance;
            Side other = seen_from(s, there, x, placement);
            // beyond a crease both sides are planes, more or less, through it: the one s is farther from faces s. For
            // a convex edge that is the larger gap, for a concave one the smaller; a tie keeps the closest facet
            if (other.point.found &&
                (!side.point.found || std::abs(other.point.gap) > std::abs(side.point.gap) + tie * size))
                side = std::move(other);
        }
        point = std::move(side.point);
        point.facet = hit.facet;
        point.side = side.hit.facet;
        if (!point.found) return;
        point.trace = trace;
        if (variation != nullptr) vary(s, hit, x, point, *variation);
    }

    void vary(const Vec3& s, const FacetHit&, const std::vector<Vec3>& x, const ContactPoint& point,
              ContactVariation& variation) const override {
        const Side& side = static_cast<const Side&>(*point.trace);
        variation.patches.clear();
        if (side.active.empty()) {
            ContactPoint same;
            facets_->evaluate(s, side.hit, x, same, &variation);
        } else {
            vary_blend(side.active, s, point, variation);
        }
    }

    /// Facets across a crease have no patch in common, others at a vertex have that of the vertex.
    [[nodiscard]] bool tells_apart(Index from, Index to) const override {
        const auto &a = vertex_patches_.of_facet[from], &b = vertex_patches_.of_facet[to];
        return std::ranges::none_of(a, [&](Index p) { return std::ranges::find(b, p) != b.end(); });
    }

private:
    static constexpr double tie = 1e-9; ///< of coordinates and gaps, of the facet size
    /// How much farther than its facet a foot may be from s, in facet sizes: smooth surfaces leave their facets by a tenth. What is
    /// farther is another place of a patch that is folded.
    static constexpr double farther = 0.25;

    /// Patches where the vertices are now.
    struct Placed : Placement {
        std::vector<PlacedPatch> patches; ///< those of facets that were asked for
        std::vector<char> wanted;         ///< (patches)
    };
    /// A slave point seen from one smooth side of the surface.
    struct Side : PointTrace {
        FacetHit hit;
        std::vector<ActivePatch> active;                  ///< empty where only the facet itself is left
        std::vector<std::unique_ptr<PlacedPatch>> placed; ///< those that place() has not placed
        ContactPoint point;
    };
    /// Another smooth side that meets a facet in one of its edges or corners.
    struct Neighbour {
        int corner; ///< the edge is the one that leaves it
        bool edge;
        Index facet;
    };

    /// The trace of a point's last evaluation where nothing else holds it, or a new one.
    static std::shared_ptr<Side> own_trace(const ContactPoint& point) {
        const bool shared = point.trace.use_count() > 1;
        auto last = std::const_pointer_cast<PointTrace>(point.trace);
        auto own = shared ? nullptr : std::dynamic_pointer_cast<Side>(std::move(last));
        return own ? own : std::make_shared<Side>();
    }

    Side seen_from(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, const Placement* placement) const {
        const std::vector<PlacedPatch>* ready =
            placement == nullptr ? nullptr : &static_cast<const Placed*>(placement)->patches;
        Side side;
        side.hit = hit;
        for (const Index p : vertex_patches_.of_facet[hit.facet]) {
            const VertexPatch& patch = vertex_patches_.patches[p];
            const PlacedPatch* placed = ready == nullptr ? nullptr : &(*ready)[p];
            if (placed == nullptr || !placed->is_at(patch, x)) {
                auto& own = side.placed.emplace_back(std::make_unique<PlacedPatch>());
                own->place(patch, x);
                placed = own.get();
            }
            activate(patch, *placed, s, hit.distance + farther * surface_.facet_size(hit.facet), side.active);
        }
        if (!side.active.empty()) {
            blend(side.active, x, side.point);
            double size = surface_.facet_size(hit.facet); // next to nothing where its vertices are near duplicates
            for (const ActivePatch& a : side.active) size = std::max(size, a.patch->shape.node_distance());
            side.point.behind = side.point.gap <= -deepest * size;
            side.point.found = !side.point.behind;
        } else if (vertex_patches_.bare[hit.facet] != 0) {
            facets_->evaluate(s, hit, x, side.point, nullptr);
        } // else s is too far off for any foot
        return side;
    }

    /// Facets of the other sides when s lies beyond a crease, so that its closest point is on one.
    [[nodiscard]] std::vector<Index> across_crease(const FacetHit& hit) const {
        std::vector<Index> result;
        if (hit.latched || hit.limited || hit.overhang == 0 || creases_[hit.facet].empty()) return result;
        const int n = static_cast<int>(surface_.facet_vertices(hit.facet).size());
        const auto on_edge = [&](int c) {
            const Vec2& u = hit.u;
            const double square[] = {1 + u.y(), 1 - u.x(), 1 - u.y(), 1 + u.x()};
            const double triangle[] = {u.y(), 1 - u.sum(), u.x()};
            return (n == 4 ? square : triangle)[c] < tie;
        };
        for (const Neighbour& k : creases_[hit.facet]) {
            const bool this_edge = on_edge(k.corner), last_edge = on_edge((k.corner + n - 1) % n);
            if (k.edge ? this_edge : this_edge && last_edge) result.push_back(k.facet);
        }
        return result;
    }

    void find_creases() {
        creases_.resize(static_cast<std::size_t>(surface_.facet_count()));
        for (Index f = 0; f < surface_.facet_count(); ++f) {
            const auto v = surface_.facet_vertices(f);
            for (std::size_t c = 0; c < v.size(); ++c) {
                const int corner = static_cast<int>(c);
                const Index h = surface_.first_half_edge(f) + corner;
                if (surface_.is_feature_edge(h))
                    creases_[f].push_back({corner, true, surface_.half_edges()[surface_.half_edges()[h].twin].facet});
                for (const auto& sector : sectors(surface_, v[c]))
                    if (!std::binary_search(sector.begin(), sector.end(), f))
                        creases_[f].push_back({corner, false, sector.front()});
            }
        }
    }

    /// Foot of s on the osculating paraboloid of the patch at its vertex, from the vertex, or nothing where the bump surely
    /// does not reach: the starting point of the projection.
    static std::optional<Vec2> start(const VertexPatch& patch, const PatchPoint& p, const Vec3& s) {
        constexpr double surely_outside = 4; // tau on the tangent plane: twice as far as the bump reaches
        constexpr double margin = 1.1;       // of the bump's radius
        const auto tau = [&](const Vec2& u) { return patch.kappa * u.dot(patch.metric * u); };
        const Mat2 metric = p.X_a.transpose() * p.X_a;
        if (!(metric.determinant() > 0)) return std::nullopt; // an iterate that ran away has its facets in one place
        const Vec2 flat = metric.inverse() * (p.X_a.transpose() * (s - p.X));
        if (!(tau(flat) < surely_outside)) return std::nullopt;
        Vec2 u = flat;
        for (int step = 0; step < 2; ++step) {
            Matrix32 X_a;
            X_a.col(0) = p.X_a.col(0) + u.x() * p.X_11 + u.y() * p.X_12;
            X_a.col(1) = p.X_a.col(1) + u.x() * p.X_12 + u.y() * p.X_22;
            const Vec3 e = s - p.X - 0.5 * (p.X_a + X_a) * u;
            const Mat2 K = X_a.transpose() * X_a - p.curvature(e);
            if (!(K.determinant() > 0 && K.trace() > 0)) return flat;
            u += K.inverse() * (X_a.transpose() * e);
        }
        // what the paraboloid leaves out is smaller than what it changed
        const double bend = tau(u - flat);
        if (!(bend < 1)) return flat;
        if (std::sqrt(tau(u)) - 2 * std::sqrt(bend) > margin) return std::nullopt;
        return u;
    }

    /// Adds the patch to `active` when s has a foot on it within its bump, no farther from it than `most`, m.
    static void activate(const VertexPatch& patch, const PlacedPatch& placed, const Vec3& s, double most,
                         std::vector<ActivePatch>& active) {
        const Vec3 from_origin = s - placed.x[0];
        const auto begin = start(patch, placed.at_vertex, from_origin);
        if (!begin) return;
        const auto radius = [&](const Vec2& u) { return std::sqrt(patch.kappa * u.dot(patch.metric * u)); };
        const auto foot =
            project(patch.shape, placed.coefficients, from_origin, patch.origin + *begin,
                    [&](const Vec2& u, const Vec2& step) { // what is left is less than twice the last step
                        return radius(u - patch.origin) - 3 * radius(step) > 1;
                    });
        if (!foot) return;
        ActivePatch a;
        a.patch = &patch;
        a.placed = &placed;
        a.foot = *foot;
        const Vec2 u = a.foot.u - patch.origin;
        a.tau = patch.kappa * u.dot(patch.metric * u);
        if (!(a.tau < 1)) return;
        a.normal = a.foot.point.normal();
        a.gap = a.normal.dot(from_origin - a.foot.point.X);
        if (std::abs(a.gap) > most || !unique(a.foot.point, a.normal, a.gap)) return;
        a.psi = (1 - a.tau) * (1 - a.tau) * (1 - a.tau);
        first_variation(a);
        a.foot.point.X += placed.x[0];
        active.push_back(std::move(a));
    }

    static void first_variation(ActivePatch& a) {
        const PatchPoint& p = a.foot.point;
        const auto n = static_cast<Index>(a.patch->vertices.size());
        a.phi.resize(n);
        a.phi_a.resize(n, 2);
        a.patch->shape.weights(a.foot.u, a.phi, a.phi_a);
        a.K_inverse = (p.X_a.transpose() * p.X_a - a.gap * p.curvature(a.normal)).inverse();
        const Vec2 m = a.patch->metric * (a.foot.u - a.patch->origin);
        a.by_foot = -6 * a.patch->kappa * (1 - a.tau) * (1 - a.tau) * m;
    }

    /// g = sum psi_v g_v / P;  dg = (1/P) sum [ psi_v dg_v + (g_v - g) dpsi_v ];  weights (1/P) sum psi_v Phi_i
    static void blend(std::vector<ActivePatch>& active, const std::vector<Vec3>& x, ContactPoint& point) {
        double P = 0, g = 0;
        point.nodes.clear();
        for (const ActivePatch& a : active) {
            P += a.psi;
            g += a.psi * a.gap;
            point.nodes.insert(point.nodes.end(), a.patch->vertices.begin(), a.patch->vertices.end());
        }
        g /= P;
        std::sort(point.nodes.begin(), point.nodes.end());
        point.nodes.erase(std::unique(point.nodes.begin(), point.nodes.end()), point.nodes.end());
        const auto n = static_cast<Index>(point.nodes.size());
        Vec3 by_s = Vec3::Zero();
        point.pressing.setZero(n, 3);
        point.weights = Vector::Zero(n);
        for (ActivePatch& a : active) {
            const double share = a.psi / P;
            const Vec2 t = ((a.gap - g) / P) * (a.K_inverse * a.by_foot); // dpsi_v = by_foot . du, K symmetric
            const Vec3 along = share * a.normal + a.foot.point.X_a * t;   // ds, less Phi_i dx_i
            const Vec2 across = a.gap * t;                                // of n . Phi_i,b dx_i
            by_s += along;
            for (std::size_t i = 0; i < a.patch->vertices.size(); ++i) {
                const auto at =
                    static_cast<Index>(std::lower_bound(point.nodes.begin(), point.nodes.end(), a.patch->vertices[i]) -
                                       point.nodes.begin());
                const auto k = static_cast<Index>(i);
                a.place.push_back(at);
                point.pressing.row(at) += (a.phi_a.row(k).dot(across) * a.normal - a.phi(k) * along).transpose();
                point.weights(at) += share * a.phi(k);
            }
        }
        point.gap = g;
        const double slope = by_s.norm();
        point.normal = by_s / slope;
        point.pressing /= slope;
        point.foot.setZero();
        for (Index i = 0; i < n; ++i) point.foot += point.weights(i) * (x[point.nodes[i]] - x[point.nodes[0]]);
        point.foot += x[point.nodes[0]];
    }

    const mesh::HalfEdgeSurface& surface_;
    VertexPatches vertex_patches_;
    std::shared_ptr<const MasterSurface> facets_;
    std::vector<std::vector<Neighbour>> creases_; ///< per facet
    std::vector<std::vector<Index>> reach_;       ///< per facet, vertices of all patches it may need
};

} // namespace

std::unique_ptr<MasterSurface> make_blend_surface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                                                  const BlendOptions& options) {
    return std::make_unique<BlendSurface>(surface, X, options);
}

} // namespace osculate::contact
