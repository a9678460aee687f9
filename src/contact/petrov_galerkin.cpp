#include "contact/facet_rule.hpp"
#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/dual_weights.hpp"
#include "osculate/contact/master_filter.hpp"
#include "osculate/contact/past_end.hpp"
#include "osculate/core/parallel.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

namespace osculate::contact {

namespace {

/// Slivers count as long as their dual functions keep enough digits: no part of a pressure is lost.
constexpr double least_covered = 1e-3;

/// Gaps at the slave nodes, forces by DualWeights:
///     gap, normal  those of slave node j over the smooth surface through the filtered vertices, see MasterFilter
///     weights      W_ji of the unfiltered vertices: a force lambda on j loads vertex i with -W_ji lambda
/// The forces are not the work conjugates of the gaps, hence the name. Where a slave node is beyond the master's boundary,
/// but some of its facets are above the master, its gap is that over the surface, extended, see PastEnd. Where it is above
/// the master, but none of its facets is (a vertex on a vertex), its force is that of the smooth surface, W_ji = Q_vi Phi_v:
/// the closest facet may be either of two.
///
/// ContactPoint::nodes: the vertices that carry force, ascending; the other slave nodes of j's facets, on which the
/// weights depend, numbered from surface.vertex_count() on; then the vertices on which only the gap depends.
class PetrovGalerkin final : public Discretisation {
public:
    PetrovGalerkin(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& vertices,
                   const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S, std::vector<Mat3> in_plane)
        : surface_(surface), weights_(surface, facets, S, least_covered), nodes_(make_node_discretisation(surface)),
          past_end_(surface), in_plane_(std::move(in_plane)), raw_(S.size()), ends_(S.size()), area_(S.size(), 0),
          carriers_(S.size(), 0), moving_(S.size(), 0), normal_length_(S.size(), 1.0), outside_(S.size(), 0),
          alone_(S.size(), 0), below_(facets.size(), -1) {
        std::vector<std::vector<Vec3>> corners;
        for (Index f = 0; f < weights_.facet_count(); ++f) corners.push_back(weights_.X(f));
        if (!corners.empty()) filter_ = MasterFilter(surface, vertices, with_images(mesh_metric(corners)));
    }

    [[nodiscard]] std::unique_ptr<Discretisation> clone() const override {
        return std::unique_ptr<Discretisation>(new PetrovGalerkin(*this));
    }

    void begin(const PairPositions& at, const FacetTracking& tracking, int threads) override {
        nodes_->begin(at, tracking, threads);
        weights_.begin(at);
        if (filter_.active()) filter_.make_room();
        parallel_for(threads, weights_.facet_count(), [&](Index begin, Index end) {
            for (Index f = begin; f < end; ++f)
                below_[f] =
                    at.search.track(centre(f, at), tracking.facet[weights_.corners(f).node[0]], at.vertices, 0).facet;
        });
    }

    int evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points,
                 int threads) override {
        if (filter_.active()) filter_.apply(at.vertices, at.vertex_tails, filtered_, filtered_tails_);
        const PairPositions smooth = filtered(at);
        const int changed = nodes_->evaluate(smooth, tracking, raw_, threads);
        parallel_for(threads, weights_.facet_count(), [&](Index begin, Index end) {
            for (Index f = begin; f < end; ++f) {
                if (!is_needed(f, tracking)) continue;
                if (is_far(f, tracking)) {
                    weights_.leave_out(f);
                    continue;
                }
                below_[f] = at.search.track(centre(f, at), below_[f], at.vertices, 0).facet;
                std::vector<Index> seeds;
                const auto add = [&](Index facet) {
                    if (facet < 0) return;
                    seeds.push_back(facet);
                    for (const Index v : surface_.facet_vertices(facet)) {
                        const auto around = surface_.vertex_facets(v);
                        seeds.insert(seeds.end(), around.begin(), around.end());
                    }
                };
                add(below_[f]);
                for (const Index j : weights_.corners(f)) add(tracking.facet[j]);
                weights_.update(f, at, std::move(seeds));
            }
        });
        if (tracking.share != nullptr) share_facets(*tracking.share);
        parallel_for(threads, static_cast<Index>(points.size()), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) {
                if (!tracking.owns(j)) continue;
                const double share = area_[j] = weights_.share(j);
                outside_[j] = !raw_[j].found && !raw_[j].behind && share > 0 && tracking.hits[j].facet >= 0;
                if (outside_[j]) past_end_.evaluate(at.slaves[j], tracking.hits[j], smooth, ends_[j], raw_[j]);
                alone_[j] = raw_[j].found && !(share > 0);
                points[j].facet = raw_[j].facet;
                points[j].side = raw_[j].side;
                gather(j, at.vertices, points[j]);
            }
        });
        return changed;
    }

    void prepare_variations(const PairPositions& at, std::span<const char> wanted, int threads) override {
        if (filter_.active()) filter_.differentiate(at.vertices);
        parallel_for(threads, weights_.facet_count(), [&](Index begin, Index end) {
            for (Index f = begin; f < end; ++f)
                if (std::ranges::any_of(weights_.corners(f), [&](Index j) { return wanted[j] != 0; }))
                    weights_.vary(f, at);
        });
    }

    void vary(Index j, const PairPositions& at, const FacetHit& hit, const ContactPoint& point,
              ContactVariation& variation) const override {
        static thread_local ContactVariation own;
        own.form = alone_[j] ? VariationForm::matrices : VariationForm::gap;
        own.patches.clear();
        const PairPositions smooth = filtered(at);
        if (outside_[j])
            past_end_.vary(at.slaves[j], smooth, ends_[j], raw_[j], own);
        else
            nodes_->vary(j, smooth, hit, raw_[j], own);
        const auto columns = 3 + 3 * static_cast<Index>(point.nodes.size());
        variation.dg.setZero(columns);
        variation.dn.setZero(3, columns);
        variation.dg.leftCols<3>() = own.dg.leftCols<3>();
        variation.dn.leftCols<3>() = own.dn.leftCols<3>();
        static thread_local std::vector<Index> place; // first columns of vertices
        place.resize(std::max(place.size(), at.vertices.size()));
        for (Index i = 0; i < static_cast<Index>(point.nodes.size()); ++i)
            if (point.nodes[i] < surface_.vertex_count()) place[point.nodes[i]] = 3 + 3 * i;
        for (std::size_t i = 0; i < raw_[j].nodes.size(); ++i) {
            const Index from = 3 + 3 * static_cast<Index>(i);
            const Eigen::RowVector3d dg = own.dg.middleCols<3>(from);
            const Mat3 dn = own.dn.middleCols<3>(from);
            through_filter(raw_[j].nodes[i], [&](Index v, double, const Mat3& by) {
                variation.dg.middleCols<3>(place[v]).noalias() += dg * by;
                variation.dn.middleCols<3>(place[v]).noalias() += dn * by;
            });
        }
        if (!in_plane_.empty()) {
            const Vec3& n = point.normal;
            variation.dn =
                ((Mat3::Identity() - n * n.transpose()) / normal_length_[j] * in_plane_[j] * variation.dn).eval();
        }
        // nothing else moves the weights: these are the first columns
        variation.dweights.setZero(carriers_[j], 3 + 3 * moving_[j]);
        variation.dpressing.resize(0, 0);
        if (alone_[j]) return vary_alone(j, own, place, variation.dweights);
        const Columns column(point.nodes, carriers_[j], moving_[j]);
        weights_.add_variations(
            j, point.weights, [&](Index v) { return column.carrier(v); },
            [&](Index slave) { return slave == j ? 0 : column.of_slave(surface_.vertex_count() + slave); },
            [&](Index v) { return 3 + 3 * column.carrier(v); }, variation.dweights);
    }

    [[nodiscard]] Index carriers(Index j, const ContactPoint&) const override { return carriers_[j]; }

    void force_change(const ContactPoint&, const Vec3& lambda, const Vec3&, std::span<const double> dweights,
                      const double*, double* df) const override {
        // p_i = -W_i n: what is left is f_i = -W_i lambda
        for (std::size_t i = 0; i < dweights.size(); ++i) Eigen::Map<Vec3>(df + 3 * i) = -dweights[i] * lambda;
    }

    void weights_along(const ContactPoint&, const ContactVariation& variation, const Vector& dy, Vector& dweights,
                       Vector&) const override {
        dweights.noalias() = variation.dweights * dy.head(variation.dweights.cols());
    }

    [[nodiscard]] double gap_rounded_off(Index j, const PairPositions& at, const ContactPoint&) const override {
        return nodes_->gap_rounded_off(j, filtered(at), raw_[j]);
    }

    void follow(const FacetHit&, const ContactPoint& point, Index carried, std::vector<Index>& vertices,
                std::vector<double>& shares) const override {
        vertices.assign(point.nodes.begin(), point.nodes.begin() + carried);
        shares.assign(point.weights.begin(), point.weights.begin() + carried);
    }

    [[nodiscard]] bool overlooks() const override { return true; }

    [[nodiscard]] double loaded_area(Index j, double tributary) const override {
        return area_[j] > 0 ? area_[j] : tributary;
    }

    void pack(Index j, std::vector<double>& numbers) const override {
        numbers.insert(numbers.end(), {area_[j], static_cast<double>(carriers_[j])});
    }
    const double* unpack(Index j, const double* numbers) override {
        area_[j] = *numbers++;
        carriers_[j] = static_cast<Index>(*numbers++);
        return numbers;
    }

private:
    /// Finds nodes in ContactPoint::nodes, whose first two parts ascend: carriers, then slaves.
    class Columns {
    public:
        Columns(const std::vector<Index>& nodes, Index carriers, Index moving)
            : first_(nodes.begin()), slaves_(first_ + carriers), rest_(first_ + moving) {}
        /// Place of a vertex among the carriers.
        [[nodiscard]] Index carrier(Index v) const {
            return static_cast<Index>(std::lower_bound(first_, slaves_, v) - first_);
        }
        /// First column of a slave node.
        [[nodiscard]] Index of_slave(Index number) const { return at(std::lower_bound(slaves_, rest_, number)); }

    private:
        using Place = std::vector<Index>::const_iterator;
        [[nodiscard]] Index at(Place place) const { return 3 + 3 * static_cast<Index>(place - first_); }
        Place first_, slaves_, rest_;
    };

    PetrovGalerkin(const PetrovGalerkin& other)
        : Discretisation(other), surface_(other.surface_), weights_(other.weights_), nodes_(other.nodes_->clone()),
          past_end_(other.past_end_), filter_(other.filter_), in_plane_(other.in_plane_), filtered_(other.filtered_),
          filtered_tails_(other.filtered_tails_), raw_(other.raw_), ends_(other.ends_), area_(other.area_),
          carriers_(other.carriers_), moving_(other.moving_), normal_length_(other.normal_length_),
          outside_(other.outside_), alone_(other.alone_), below_(other.below_) {
        for (ContactPoint& point : raw_) point.trace.reset(); // refers to the other's placement
        for (PastEnd::Point& end : ends_) end.side.trace.reset();
    }

    /// The metric of a slave mesh with its images beyond the symmetry planes.
    [[nodiscard]] Mat3 with_images(Mat3 metric) const {
        std::vector<Mat3> reflections;
        for (const Mat3& P : in_plane_) {
            const Mat3 R = 2 * P - Mat3::Identity();
            constexpr double plane = 2, round_off = 1e-9; // a projector on an edge has trace 1
            if (std::abs(P.trace() - plane) < round_off &&
                std::ranges::none_of(reflections, [&](const Mat3& known) { return known.isApprox(R, round_off); }))
                reflections.push_back(R);
        }
        constexpr int rounds = 50; // the first does where planes are at right angles
        for (int round = 0; round < rounds; ++round)
            for (const Mat3& R : reflections) metric = ((metric + R * metric * R) / 2).eval();
        return metric;
    }

    [[nodiscard]] bool is_far(Index f, const FacetTracking& tracking) const {
        return !tracking.far.empty() &&
               std::ranges::all_of(weights_.corners(f), [&](Index j) { return tracking.far[j] != 0; });
    }

    /// Whether a slave facet has a corner that this process evaluates.
    [[nodiscard]] bool is_needed(Index f, const FacetTracking& tracking) const {
        return tracking.share == nullptr ||
               std::ranges::any_of(weights_.corners(f), [&](Index j) { return tracking.owns(j); });
    }

    /// Gives all processes below_ of each facet, from the one that evaluates its first corner.
    void share_facets(const SlaveShare& share) {
        const auto for_each = [&](Index j, auto&& use) {
            for (const auto& [f, corner] : weights_.around(j))
                if (corner == 0) use(below_[f]);
        };
        share.exchange(
            [&](Index j, std::vector<double>& numbers) { for_each(j, [&](Index facet) { numbers.push_back(facet); }); },
            [&](Index j, const double* number) {
                for_each(j, [&](Index& facet) { facet = static_cast<Index>(*number++); });
                return number;
            });
    }

    [[nodiscard]] Vec3 centre(Index f, const PairPositions& at) const {
        Vec3 sum = Vec3::Zero();
        const SlaveFacet& corners = weights_.corners(f);
        for (const Index j : corners) sum += at.slaves[j] / corners.count;
        return sum;
    }

    /// The positions with filtered vertices.
    [[nodiscard]] PairPositions filtered(const PairPositions& at) const {
        if (!filter_.active()) return at;
        return {at.master, at.search, at.slaves, filtered_, at.slave_tails, filtered_tails_};
    }

    /// Calls use(i, Q_vi, dx~_v/dx_i) for the vertices i on which the filtered position of v depends.
    template <class Use> void through_filter(Index v, Use&& use) const {
        if (!filter_.active()) return use(v, 1.0, Mat3::Identity());
        const auto row = filter_.row(v);
        for (std::size_t k = 0; k < row.size(); ++k) use(row[k], filter_.Q(v)[k], filter_.derivatives(v)[k]);
    }

    /// Variations of the weights of a slave node that no facet of its own carries.
    /// @param own    variations of its point over the filtered surface
    /// @param place  (vertices) first columns
    void vary_alone(Index j, const ContactVariation& own, const std::vector<Index>& place, Matrix& dweights) const {
        Eigen::RowVectorXd dphi(dweights.cols());
        for (std::size_t i = 0; i < raw_[j].nodes.size(); ++i) {
            const auto from = own.dweights.row(static_cast<Index>(i));
            dphi.setZero();
            dphi.head<3>() = from.head<3>();
            for (Index column = 3; column < from.cols(); column += 3)
                through_filter(raw_[j].nodes[static_cast<std::size_t>(column / 3 - 1)],
                               [&](Index v, double, const Mat3& by) {
                                   dphi.segment<3>(place[v]) += from.segment<3>(column) * by;
                               });
            through_filter(raw_[j].nodes[i],
                           [&](Index v, double Q, const Mat3&) { dweights.row(place[v] / 3 - 1) += Q * dphi; });
        }
    }

    void gather(Index j, const std::vector<Vec3>& x, ContactPoint& point) {
        const ContactPoint& raw = raw_[j];
        point.found = false;
        point.behind = raw.behind;
        point.gap = raw.gap;
        point.nodes.clear();
        carriers_[j] = moving_[j] = 0;
        if (!raw.found) return;
        point.normal = raw.normal;
        if (!in_plane_.empty()) {
            const Vec3 in_plane = in_plane_[j] * raw.normal;
            normal_length_[j] = in_plane.norm();
            if (!(normal_length_[j] > 0.1)) return; // it points out of the plane
            point.normal = in_plane / normal_length_[j];
        }
        point.found = true;

        std::vector<Index> carrying, slaves, sensing;
        if (!filter_.active())
            sensing = raw.nodes;
        else {
            static thread_local std::vector<char> listed; // all 0 in between
            listed.resize(std::max(listed.size(), x.size()), 0);
            for (const Index v : raw.nodes)
                for (const Index i : filter_.row(v))
                    if (char& known = listed[static_cast<std::size_t>(i)]; known == 0) {
                        known = 1;
                        sensing.push_back(i);
                    }
            for (const Index v : sensing) listed[static_cast<std::size_t>(v)] = 0;
        }
        std::sort(sensing.begin(), sensing.end());
        if (alone_[j])
            carrying = sensing;
        else {
            weights_.add_vertices(j, carrying);
            for (const auto& [f, c] : weights_.around(j))
                for (const Index k : weights_.corners(f))
                    if (k != j) slaves.push_back(surface_.vertex_count() + k);
        }
        sort_unique(carrying);
        sort_unique(slaves);
        point.nodes = carrying;
        point.nodes.insert(point.nodes.end(), slaves.begin(), slaves.end());
        carriers_[j] = static_cast<Index>(carrying.size());
        moving_[j] = static_cast<Index>(point.nodes.size());
        std::set_difference(sensing.begin(), sensing.end(), carrying.begin(), carrying.end(),
                            std::back_inserter(point.nodes));

        point.weights = Vector::Zero(static_cast<Index>(point.nodes.size()));
        if (alone_[j])
            for (std::size_t i = 0; i < raw.nodes.size(); ++i)
                through_filter(raw.nodes[i], [&](Index v, double Q, const Mat3&) {
                    point.weights(place_in(carrying, v)) += Q * raw.weights(static_cast<Index>(i));
                });
        else
            weights_.add_weights(j, carrying, point.weights);
        point.pressing = -point.weights * point.normal.transpose();
        point.foot.setZero();
        for (std::size_t i = 0; i < carrying.size(); ++i)
            point.foot += point.weights(static_cast<Index>(i)) * x[static_cast<std::size_t>(carrying[i])];
    }

    const mesh::HalfEdgeSurface& surface_;
    DualWeights weights_;
    std::unique_ptr<Discretisation> nodes_;
    PastEnd past_end_;
    MasterFilter filter_;
    std::vector<Mat3> in_plane_;                  ///< (slaves) projectors; empty: no symmetry planes
    std::vector<Vec3> filtered_, filtered_tails_; ///< vertices at the last evaluation, m
    std::vector<ContactPoint> raw_;               ///< (slaves) over the filtered surface
    std::vector<PastEnd::Point> ends_;            ///< (slaves) of those beyond the boundary
    std::vector<double> area_;                    ///< (slaves) m^2, of the facets' parts above the master
    std::vector<Index> carriers_, moving_;        ///< (slaves) nodes that carry force; on which the weights depend
    std::vector<double> normal_length_;           ///< (slaves) of the raw normal in the symmetry planes
    std::vector<char> outside_;                   ///< (slaves) beyond the boundary: over the surface, extended
    std::vector<char> alone_;                     ///< (slaves) above the master, which none of its facets is
    std::vector<Index> below_;                    ///< (slave facets) master facet below the centre
};

} // namespace

std::unique_ptr<Discretisation> make_petrov_galerkin(const mesh::HalfEdgeSurface& surface,
                                                     const std::vector<Vec3>& vertices,
                                                     const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S,
                                                     std::vector<Mat3> in_plane) {
    return std::make_unique<PetrovGalerkin>(surface, vertices, facets, S, std::move(in_plane));
}

} // namespace osculate::contact
