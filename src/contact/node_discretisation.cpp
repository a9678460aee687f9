#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/facet_patch.hpp"
#include "osculate/core/parallel.hpp"

namespace osculate::contact {

namespace {

class NodeDiscretisation final : public Discretisation {
public:
    explicit NodeDiscretisation(const mesh::HalfEdgeSurface& surface) : surface_(surface) {}

    [[nodiscard]] std::unique_ptr<Discretisation> clone() const override {
        return std::make_unique<NodeDiscretisation>(surface_);
    }
    void begin(const PairPositions& at, const FacetTracking&, int) override { side_.assign(at.slaves.size(), -1); }

    int evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points,
                 int threads) override {
        place(at, tracking, threads);
        const auto count = static_cast<Index>(points.size());
        side_.resize(points.size(), -1);
        parallel_for(threads, count, [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j)
                if (tracking.owns(j))
                    at.master.evaluate(at.slaves[j], tracking.hits[j], at.vertices, points[j], nullptr,
                                       placement_.get());
        });
        seen_.resize(points.size());
        for (Index j = 0; j < count; ++j)
            if (tracking.owns(j)) seen_[j] = points[j].found ? points[j].side : -1;
        if (tracking.share != nullptr)
            tracking.share->exchange([&](Index j, std::vector<double>& numbers) { numbers.push_back(seen_[j]); },
                                     [&](Index j, const double* number) {
                                         seen_[j] = static_cast<Index>(*number);
                                         return number + 1;
                                     });
        // a point in a crease may see now one side, now the other, above the same facet
        for (Index j = 0; j < count; ++j) {
            const Index now = seen_[j];
            if (now >= 0 && side_[j] >= 0 && now != side_[j] && at.master.tells_apart(side_[j], now) &&
                ++tracking.changes[j] >= tracking.changes_before_latch)
                tracking.facet[j] = now;
            side_[j] = now;
        }
        return 0;
    }

    void vary(Index j, const PairPositions& at, const FacetHit& hit, const ContactPoint& point,
              ContactVariation& variation) const override {
        at.master.vary(at.slaves[j], hit, at.vertices, point, variation);
    }

    [[nodiscard]] Index carriers(Index, const ContactPoint& point) const override {
        return point.found ? static_cast<Index>(point.nodes.size()) : 0;
    }

    void force_change(const ContactPoint& point, const Vec3& lambda, const Vec3& dn, std::span<const double> dweights,
                      const double* dpressing, double* df) const override {
        // df_i = dp_i L + p_i dL - dPhi_i lambda_T + Phi_i (n dL + L dn)
        const Vec3& n = point.normal;
        const double L = lambda.dot(n), dL = lambda.dot(dn);
        const Vec3 lambda_T = lambda - L * n, turn = dL * n + L * dn;
        for (Index i = 0; i < static_cast<Index>(dweights.size()); ++i)
            for (int c = 0; c < 3; ++c)
                df[3 * i + c] = L * dpressing[3 * i + c] + point.pressing(i, c) * dL + point.weights(i) * turn(c) -
                                lambda_T(c) * dweights[i];
    }

    void weights_along(const ContactPoint& point, const ContactVariation& variation, const Vector& dy, Vector& dweights,
                       Vector& dpressing) const override {
        variation.along(point, dy, dweights, dpressing);
    }

    [[nodiscard]] double gap_rounded_off(Index j, const PairPositions& at, const ContactPoint& point) const override {
        // the variation of the gap is the work of a unit normal force
        const Vec3& n = point.normal;
        double lost = n.dot(at.slave_tails[j]);
        for (Index i = 0; i < static_cast<Index>(point.nodes.size()); ++i)
            lost += point.force(i, n).dot(at.vertex_tails[point.nodes[i]]);
        return lost;
    }

    void follow(const FacetHit& hit, const ContactPoint&, Index, std::vector<Index>& vertices,
                std::vector<double>& shares) const override {
        const auto around = surface_.facet_vertices(hit.facet);
        const FacetPatch facet(static_cast<int>(around.size()));
        Vector weights(facet.size());
        MatrixX2 slopes(facet.size(), 2);
        facet.weights(hit.u, weights, slopes);
        vertices.assign(around.begin(), around.end());
        shares.assign(weights.begin(), weights.end());
    }

private:
    void place(const PairPositions& at, const FacetTracking& tracking, int threads) {
        if (tracking.share == nullptr) return at.master.place(tracking.hits, at.vertices, threads, placement_);
        const auto first = tracking.hits.begin();
        const std::vector<FacetHit> own(first + tracking.share->begin(), first + tracking.share->end());
        at.master.place(own, at.vertices, threads, placement_);
    }

    const mesh::HalfEdgeSurface& surface_;
    std::vector<Index> side_; ///< (slaves) ContactPoint::side at the last evaluation
    std::vector<Index> seen_; ///< (slaves) scratch: at this one
    std::unique_ptr<Placement> placement_;
};

} // namespace

std::unique_ptr<Discretisation> make_node_discretisation(const mesh::HalfEdgeSurface& surface) {
    return std::make_unique<NodeDiscretisation>(surface);
}

} // namespace osculate::contact
