#include "contact/blend_variation.hpp"
#include "contact/creases.hpp"
#include "contact/placed_patch.hpp"
#include "contact/reach.hpp"
#include "osculate/core/parallel.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

class BlendSurface final : public MasterSurface {
public:
    BlendSurface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const BlendOptions& options)
        : surface_(surface), vertex_patches_(surface, X, options), facets_(make_facets_surface(surface)),
          creases_(surface) {
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
            for (const Creases::Neighbour& other : creases_.of(f)) add(other.facet);
            std::sort(nodes.begin(), nodes.end());
            nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
            // without the room that the patches took, which share most of their nodes
            reach_.emplace_back(nodes.begin(), nodes.end());
        }
    }

    std::span<const Index> patch_vertices(Index facet) const override { return reach_[facet]; }
    Index fallbacks() const override { return vertex_patches_.fallbacks; }
    void add_replicas(Replicas& replicas) const override { replicas.add(*vertex_patches_.numbers); }

    void place(std::span<const FacetHit> hits, const std::vector<Vec3>& x, int threads,
               std::unique_ptr<Placement>& placement) const override {
        if (!placement) placement = std::make_unique<Placed>();
        auto& placed = static_cast<Placed&>(*placement);
        const auto count = static_cast<Index>(vertex_patches_.patches.size());
        placed.x = x;
        placed.patches.resize(vertex_patches_.patches.size());
        placed.balls.assign(vertex_patches_.patches.size(), {});
        std::vector<char>& wanted = placed.wanted;
        wanted.assign(vertex_patches_.patches.size(), 0);
        const auto want = [&](Index facet) {
            for (const Index p : vertex_patches_.of_facet[facet]) wanted[p] = 1;
        };
        for (const FacetHit& hit : hits)
            if (hit.facet >= 0) {
                want(hit.facet);
                for (const Creases::Neighbour& other : creases_.of(hit.facet)) want(other.facet);
            }
        parallel_for(threads, count, [&](Index begin, Index end) {
            for (Index p = begin; p < end; ++p) {
                if (wanted[p] == 0) continue;
                placed.patches[p].place(vertex_patches_.patches[p], x);
                placed.balls[p] = placed.patches[p].ball;
            }
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
        point.trace = trace;
        Side& side = *trace;
        look(s, hit, x, placement, side);
        for (const Index facet : creases_.across(hit)) {
            FacetHit there;
            there.facet = facet;
            there.distance = hit.distance;
            Side other;
            look(s, there, x, placement, other);
            if (other.found && (!side.found || Creases::is_on_other(side.gap, other.gap, size)))
                side = std::move(other);
        }
        point.found = side.found;
        point.behind = side.behind;
        point.gap = side.gap;
        point.side = side.hit.facet;
        if (!point.found) return;
        if (side.active.empty()) {
            facets_->evaluate(s, side.hit, x, point, nullptr);
            point.facet = hit.facet;
            point.side = side.hit.facet;
        } else {
            blend(side.active, reach_[side.hit.facet], x, point);
        }
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
    /// How much farther than its facet a foot may be from s, in facet sizes: smooth surfaces leave their facets by a tenth. What is
    /// farther is another place of a patch that is folded.
    static constexpr double farther = 0.25;

    /// Patches where the vertices are now.
    struct Placed : Placement {
        std::vector<Vec3> x;              ///< positions of the vertices
        std::vector<PlacedPatch> patches; ///< those of facets that were asked for
        std::vector<Ball> balls;          ///< theirs, which most patches are passed over by
        std::vector<char> wanted;         ///< (patches)
    };
    /// A slave point seen from one smooth side of the surface.
    struct Side : PointTrace {
        FacetHit hit;
        std::vector<ActivePatch> active;                  ///< empty where only the facet itself is left
        std::vector<std::unique_ptr<PlacedPatch>> placed; ///< those that place() has not placed
        bool found = false, behind = false;
        double gap = 0;
    };
    /// What a vertex has in the blend: three numbers, and one.
    using PressingAndWeight = Eigen::Vector4d;

    /// The trace of a point's last evaluation where nothing else holds it, or a new one.
    static std::shared_ptr<Side> own_trace(const ContactPoint& point) {
        const bool shared = point.trace.use_count() > 1;
        auto last = std::const_pointer_cast<PointTrace>(point.trace);
        auto own = shared ? nullptr : std::dynamic_pointer_cast<Side>(std::move(last));
        return own ? own : std::make_shared<Side>();
    }

    /// The patches of a placement, if it is for these positions of all vertices that the patches of a facet have.
    [[nodiscard]] const Placed* ready(const Placement* placement, Index facet, const std::vector<Vec3>& x) const {
        if (placement == nullptr) return nullptr;
        const Placed& placed = static_cast<const Placed&>(*placement);
        if (placed.x.size() != x.size()) return nullptr;
        for (const Index v : reach_[facet])
            if (placed.x[v] != x[v]) return nullptr;
        return &placed;
    }

    void look(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, const Placement* placement,
              Side& side) const {
        const Placed* const placed = ready(placement, hit.facet, x);
        const double size = surface_.facet_size(hit.facet), most = hit.distance + farther * size;
        side.hit = hit;
        side.active.clear();
        side.placed.clear();
        side.found = side.behind = false;
        std::unique_ptr<PlacedPatch> own;
        for (const Index p : vertex_patches_.of_facet[hit.facet]) {
            const VertexPatch& patch = vertex_patches_.patches[p];
            const bool is_ready = placed != nullptr && placed->balls[p].radius >= 0;
            if (!is_ready) {
                if (!own) own = std::make_unique<PlacedPatch>();
                own->place(patch, x);
            }
            const Ball& ball = is_ready ? placed->balls[p] : own->ball;
            if (!ball.reaches(s, most)) continue;
            if (!see(s, patch, is_ready ? placed->patches[p] : *own, most, side.active.emplace_back())) {
                side.active.pop_back();
                continue;
            }
            if (!is_ready) side.placed.push_back(std::move(own));
        }
        if (!side.active.empty()) {
            double P = 0, g = 0, largest = size; // it is next to nothing where its vertices are near duplicates
            for (const ActivePatch& a : side.active) {
                P += a.psi;
                g += a.psi * a.gap;
                largest = std::max(largest, a.patch->shape.node_distance());
            }
            side.gap = g / P;
            side.behind = side.gap <= -deepest * largest;
            side.found = !side.behind;
        } else if (vertex_patches_.bare[hit.facet] != 0) {
            ContactPoint point;
            facets_->evaluate(s, hit, x, point, nullptr);
            side.found = point.found;
            side.behind = point.behind;
            side.gap = point.gap;
        } // else s is too far off for any foot
    }

    /// g = sum psi_v g_v / P;  dg = (1/P) sum [ psi_v dg_v + (g_v - g) dpsi_v ];  weights (1/P) sum psi_v Phi_i
    /// @param reach  vertices of all patches that might be active, ascending
    static void blend(const std::vector<ActivePatch>& active, std::span<const Index> reach, const std::vector<Vec3>& x,
                      ContactPoint& point) {
        static thread_local std::vector<Index> place; // of the vertices of `reach`, others are not asked for
        static thread_local std::vector<char> taken;  // (reach) by a node of an active patch
        static thread_local std::vector<PressingAndWeight> shares;
        static thread_local std::vector<double> phi;
        static thread_local BasisTable table;
        place.resize(std::max(place.size(), x.size()));
        taken.assign(reach.size(), 0);
        shares.assign(reach.size(), PressingAndWeight::Zero());
        for (std::size_t i = 0; i < reach.size(); ++i) place[reach[i]] = static_cast<Index>(i);
        double P = 0;
        for (const ActivePatch& a : active) P += a.psi;
        const double g = point.gap;
        Vec3 by_s = Vec3::Zero();
        for (const ActivePatch& a : active) {
            const double share = a.psi / P;
            const Vec2 t = ((a.gap - g) / P) * (a.K_inverse * a.by_foot); // dpsi_v = by_foot . du, K symmetric
            const Vec3 along = share * a.normal + a.foot.point.X_a * t;   // ds, less Phi_i dx_i
            const Vec2 across = a.gap * t;                                // of n . Phi_i,b dx_i
            by_s += along;
            // Phi_i and across_b Phi_i,b
            const RpimPatch& shape = a.patch->shape;
            shape.tabulate(a.foot.u, BasisTable::first, table);
            double* const by_1 = table.row(1);
            const double *const by_2 = table.row(2), across_1 = across.x(), across_2 = across.y();
            for (Index k = 0; k < table.width; ++k) by_1[k] = across_1 * by_1[k] + across_2 * by_2[k];
            const Index stride = shape.padded_size();
            phi.resize(std::max(phi.size(), static_cast<std::size_t>(2 * stride)));
            shape.weights(table, 2, 2, phi.data());
            // p_i = across_b Phi_i,b n - Phi_i along,  weight Phi_i psi_v / P
            PressingAndWeight by_phi, by_across;
            by_phi << -along, share;
            by_across << a.normal, 0;
            const std::vector<Index>& vertices = a.patch->vertices;
            const double* const phi_across = phi.data() + stride;
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                const Index k = place[vertices[i]];
                taken[k] = 1;
                shares[k] += phi[i] * by_phi + phi_across[i] * by_across;
            }
        }
        const double slope = by_s.norm();
        point.normal = by_s / slope;
        point.nodes.clear();
        for (std::size_t k = 0; k < reach.size(); ++k)
            if (taken[k] != 0) point.nodes.push_back(reach[k]);
        const auto n = static_cast<Index>(point.nodes.size());
        point.weights.resize(n);
        point.pressing.resize(n, 3);
        point.foot.setZero();
        for (Index i = 0; i < n; ++i) {
            const PressingAndWeight& node = shares[place[point.nodes[i]]];
            point.weights(i) = node(3);
            point.pressing.row(i) = node.head<3>().transpose() / slope;
            point.foot += node(3) * (x[point.nodes[i]] - x[point.nodes[0]]);
        }
        point.foot += x[point.nodes[0]];
    }

    const mesh::HalfEdgeSurface& surface_;
    VertexPatches vertex_patches_;
    std::shared_ptr<const MasterSurface> facets_;
    Creases creases_;
    std::vector<std::vector<Index>> reach_; ///< per facet, vertices of all patches it may need
};

} // namespace

std::unique_ptr<MasterSurface> make_blend_surface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                                                  const BlendOptions& options) {
    return std::make_unique<BlendSurface>(surface, X, options);
}

} // namespace osculate::contact
