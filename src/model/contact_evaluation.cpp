#include "osculate/model/contact_evaluation.hpp"

#include "osculate/contact/latch.hpp"
#include "osculate/core/parallel.hpp"
#include "osculate/model/model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace osculate::model {

ContactEvaluation::ContactEvaluation(const ContactPair& pair)
    : pair_(&pair), discretisation_(pair.discretisation().clone()), search_(pair.search()), master_(pair.master()),
      inertia_(pair.slaves().node.size(), 0.0), held_(inertia_.size(), 0), points_(inertia_.size()),
      states_(inertia_.size()), point_nodes_(inertia_.size()) {
    tracking_.hysteresis = pair.options().hysteresis;
    tracking_.changes_before_latch = pair.options().changes_before_latch;
    tracking_.facet.assign(inertia_.size(), -1);
    tracking_.changes.assign(inertia_.size(), 0);
    tracking_.hits.resize(inertia_.size());
    in_force_.assign(inertia_.size(), 0);
    points_at_.assign(inertia_.size(), 1);
}

ContactEvaluation::ContactEvaluation(const ContactEvaluation& other)
    : pair_(other.pair_), share_(other.share_), rounded_(other.rounded_),
      discretisation_(other.discretisation_->clone()), search_(other.search_), master_(other.master_),
      inertia_(other.inertia_), held_(other.held_), lambda_start_(other.lambda_start_), start_(other.start_),
      now_(other.now_), tails_start_(other.tails_start_), tails_(other.tails_), vertices_(other.vertices_),
      vertex_tails_(other.vertex_tails_), facets_(other.facets_), bulge_(other.bulge_), faces_(other.faces_),
      tracking_(other.tracking_), in_force_(other.in_force_), in_force_start_(other.in_force_start_),
      points_(other.points_), points_at_(other.points_at_), depth_(other.depth_), kept_part_(other.kept_part_),
      overclosure_start_(other.overclosure_start_), step_(other.step_), slides_(other.slides_),
      vertices_start_(other.vertices_start_), passes_over_(other.passes_over_), clearance_(other.clearance_),
      left_(other.left_), states_(other.states_), point_nodes_(other.point_nodes_),
      facet_changes_(other.facet_changes_) {
    for (contact::ContactPoint& point : points_) point.trace.reset(); // refers to the other's placement
}

void ContactEvaluation::gather(const std::vector<Vec3>& field, Places& into) const {
    into.slaves.clear();
    into.masters.clear();
    if (field.empty()) return;
    for (const Index node : pair_->slaves().node) into.slaves.push_back(field[node]);
    if (const auto& edges = pair_->slaves().edges)
        for (const Index node : edges->others) into.slaves.push_back(field[node]);
    for (const Index node : pair_->master_nodes()) into.masters.push_back(field[node]);
}

const Vec3& ContactEvaluation::at(const Places& places, Index vertex) const {
    const Index count = pair_->surface().vertex_count();
    return vertex < count ? places.masters[vertex] : places.slaves[vertex - count];
}

void ContactEvaluation::place(const std::vector<Vec3>& x, const std::vector<Vec3>& tails) {
    gather(x, now_);
    gather(tails, tails_);
    vertices_ = now_.masters;
    vertex_tails_ = tails_.masters;
    if (!pair_->mirrored()) return;
    for (std::size_t v = 0; v < vertices_.size(); ++v)
        vertices_[v] = pair_->image_of(static_cast<Index>(v))(vertices_[v]);
    for (std::size_t v = 0; v < vertex_tails_.size(); ++v)
        vertex_tails_[v] = pair_->image_of(static_cast<Index>(v)).M * tails_.masters[v];
}

contact::PairPositions ContactEvaluation::positions() const {
    return {*master_, search_, now_.slaves, vertices_, tails_.slaves, vertex_tails_};
}

void ContactEvaluation::begin_step(const std::vector<Vec3>& x, const ContactHistory& history, Timings& timings,
                                   int threads, const std::vector<Vec3>& tails) {
    if (master_ != history.master) {
        for (contact::ContactPoint& point : points_) point = {}; // they refer to the other surface
        discretisation_ = pair_->discretisation().clone();
        master_ = history.master;
    }
    let_go();
    given_.clear();
    if (share_) share_out_by_work(history);
    place(x, tails);
    const Places before = std::exchange(start_, now_);
    tails_start_ = tails_;
    tracking_.facet = history.facet;
    lambda_start_ = history.lambda;
    depth_.clear();
    overclosure_start_.clear();
    step_ = {};
    slides_.clear();
    if (pair_->options().static_friction > pair_->options().friction) {
        slides_ = history.slides;
        slides_.resize(points_.size(), 0);
    }
    std::fill(tracking_.changes.begin(), tracking_.changes.end(), 0);
    const ScopedTimer timer(timings, Part::search);
    if (pair_->slaves().edges) {
        facet_start_ = tracking_.facet;
        discretisation_->begin(positions(), tracking_, threads);
        return;
    }
    find_facets(x, history, before, threads);
    clearance_.clear();
    tracking_.far.clear();
    if (passes_over_) find_clearances(history);
    facet_start_ = tracking_.facet;
    for (Index j = 0; j < pair_->size(); ++j) in_force_[j] = contact::is_closed(history.status[j]);
    in_force_start_ = in_force_;
    discretisation_->begin(positions(), tracking_, threads);
}

void ContactEvaluation::find_facets(const std::vector<Vec3>& x, const ContactHistory& history, const Places& before,
                                    int threads) {
    const std::vector<std::vector<Vec3>> faces = faces_; // of nodes beside the slaves, too
    if (!pair_->slaves().around.empty()) place_facets(x);
    if (facet_before_ == history.facet && status_start_ == history.status && before.slaves == start_.slaves &&
        before.masters == start_.masters && faces == faces_) {
        tracking_.facet = facet_start_;
        return;
    }
    facet_before_ = history.facet;
    status_start_ = history.status;
    closest_.assign(points_.size(), {});
    search_.build(vertices_);
    parallel_for(threads, pair_->size(), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j)
            if (tracking_.facet[j] < 0 || !contact::is_closed(history.status[j])) {
                closest_[j] = search_.global(now_.slaves[j], vertices_, reach(), choice(j));
                tracking_.facet[j] = closest_[j].facet;
            }
    });
}

void ContactEvaluation::take_facets(HeldFacets facets) {
    tracking_.facet = std::move(facets.facet);
    given_ = std::move(facets.latched);
}

HeldFacets ContactEvaluation::held_facets() const {
    HeldFacets held{tracking_.facet, {}};
    for (const contact::FacetHit& hit : tracking_.hits) held.latched.push_back(hit.latched ? 1 : 0);
    return held;
}

void ContactEvaluation::forget_path() {
    tracking_.facet = facet_start_;
    if (!in_force_start_.empty()) in_force_ = in_force_start_;
    std::fill(tracking_.changes.begin(), tracking_.changes.end(), 0);
}

void ContactEvaluation::evaluate(const std::vector<Vec3>& x, Timings& timings, int threads,
                                 const std::vector<Vec3>& tails) {
    std::vector<Index>& facet = tracking_.facet;
    std::vector<contact::FacetHit>& hits = tracking_.hits;
    facet_changes_ = 0;
    tracking_.share = shared_points();
    if (holds_geometry()) {
        place(x, tails);
        for (Index j = 0; j < pair_->size(); ++j) {
            const HeldPoint& held = held_geometry_[j];
            if (!points_[j].found) continue;
            points_[j].gap = held.gap + held.dg.dot(point_positions(j) - held_positions_[j]);
        }
        const contact::PairPositions at = positions();
        for (Index j = 0; j < pair_->size(); ++j) states_[j] = measure(j, at);
        return;
    }
    if (pair_->slaves().edges) {
        place(x, tails);
    } else {
        const ScopedTimer timer(timings, Part::search);
        place(x, tails);
        if (!clearance_.empty()) find_far_nodes();
        const int latch = tracking_.changes_before_latch;
        parallel_for(threads, pair_->size(), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) {
                if (tracking_.share != nullptr && !owns(j)) continue;
                if (is_far(j)) {
                    hits[j] = {};
                    hits[j].distance = clearance_[j];
                    continue;
                }
                const Vec3& s = now_.slaves[j];
                const bool given = !given_.empty(), latched = given ? given_[j] != 0 : tracking_.changes[j] >= latch;
                hits[j] = given && facet[j] >= 0
                              ? search_.closest_on(facet[j], s, vertices_, choice(j))
                              : search_.track(s, facet[j], vertices_,
                                              latched ? contact::latched_hysteresis : tracking_.hysteresis, choice(j));
                hits[j].latched = latched;
                if (!pair_->slaves().around.empty()) end_at_bounds(j);
            }
        });
        if (tracking_.share != nullptr) exchange_hits();
        for (Index j = 0; j < pair_->size(); ++j)
            if (!is_far(j) && hits[j].facet != facet[j]) {
                tracking_.changes[j] +=
                    facet[j] < 0 || hits[j].facet < 0 || master_->tells_apart(facet[j], hits[j].facet);
                facet[j] = hits[j].facet;
                ++facet_changes_;
            }
        if (!clearance_.empty()) pass_over_clear_nodes();
    }
    const ScopedTimer timer(timings, Part::contact);
    facet_changes_ += discretisation_->evaluate(positions(), tracking_, points_, threads);
    if (tracking_.share != nullptr) exchange_points();
    if (!pair_->slaves().along.empty()) drop_what_is_not_pointed_at(x);
    if (!pair_->slaves().around.empty()) drop_what_is_beside();
    for (Index j = 0; j < pair_->size(); ++j) {
        point_nodes_[j].clear();
        if (!points_[j].found) continue;
        for (const Index v : points_[j].nodes) point_nodes_[j].push_back(pair_->node(v));
    }
    const contact::PairPositions at = positions();
    parallel_for(threads, pair_->size(), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) states_[j] = measure(j, at);
    });
}

Vector ContactEvaluation::point_positions(Index j) const {
    const contact::ContactPoint& point = points_[j];
    const auto n = static_cast<Index>(point.nodes.size()), count = pair_->surface().vertex_count();
    Vector y(3 + 3 * n);
    y.head<3>() = now_.slaves[j];
    for (Index i = 0; i < n; ++i) {
        const Index v = point.nodes[i];
        y.segment<3>(3 + 3 * i) = v < count ? vertices_[v] : now_.slaves[v - count];
    }
    return y;
}

void ContactEvaluation::hold_geometry() {
    held_geometry_.assign(points_.size(), {});
    held_positions_.assign(points_.size(), {});
    contact::ContactVariation variation;
    variation.form = contact::VariationForm::gap;
    for (Index j = 0; j < pair_->size(); ++j) {
        if (!points_[j].found) continue;
        variation.patches.clear();
        discretisation_->vary(j, positions(), hit(j), points_[j], variation);
        held_geometry_[j] = {points_[j].gap, variation.dg};
        held_positions_[j] = point_positions(j);
    }
}

double ContactEvaluation::moved_since_held(Index j) const {
    const Vector moved = point_positions(j) - held_positions_[j];
    Vec3 relative = moved.head<3>();
    for (Index i = 0; i < points_[j].weights.size(); ++i)
        relative -= points_[j].weights(i) * moved.segment<3>(3 + 3 * i);
    return relative.norm();
}

double ContactEvaluation::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < pair_->size(); ++j)
        if (points_[j].found)
            least = std::min(least, points_[j].gap - kept_depth(j));
        else if (is_far(j))
            least = std::min(least, left_[j]);
    return least;
}

double ContactEvaluation::unseen_gap(Index j) const {
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    if (!discretisation_->overlooks() || points_[j].found || hit(j).facet < 0) return nowhere;
    contact::ContactPoint point;
    master_->evaluate(now_.slaves[j], hit(j), vertices_, point);
    return (point.found || point.behind) && points_at_[j] != 0 ? point.gap : nowhere;
}

std::vector<Index> ContactEvaluation::patch_nodes(Index facet) const {
    std::vector<Index> nodes;
    for (const Index v : master_->patch_vertices(facet)) nodes.push_back(pair_->node(v));
    return nodes;
}

template <class Moved> Vec3 ContactEvaluation::drift(Index j, const Vec3& slave, const Moved& moved) const {
    // d = (s - s_start) - sum_i Phi_i (x_i - x_i,start)                                   [Qian 2014, eq (8)]
    const contact::ContactPoint& point = points_[j];
    Vec3 drift = slave;
    if (point.found)
        for (std::size_t i = 0; i < point.nodes.size(); ++i) {
            const Index v = point.nodes[i];
            drift -= point.weights(static_cast<Index>(i)) * (pair_->image(v) * moved(v));
        }
    // averages over half of a node's facets, those on this side of a symmetry plane, lack what the others would cancel
    const std::vector<Mat3>& in_plane = pair_->slaves().in_plane;
    if (!in_plane.empty()) drift = in_plane[j] * drift;
    return drift;
}

Vec3 ContactEvaluation::drift(Index j, const Places& from, const Places& to) const {
    return drift(j, Vec3(to.slaves[j] - from.slaves[j]), [&](Index v) -> Vec3 { return at(to, v) - at(from, v); });
}

Vec3 ContactEvaluation::drift(Index j, const std::vector<Vec3>& from, const std::vector<Vec3>& to) const {
    const Index slave = pair_->slaves().node[j];
    return drift(j, Vec3(to[slave] - from[slave]), [&](Index v) -> Vec3 {
        const Index node = pair_->node(v);
        return to[node] - from[node];
    });
}

contact::ContactState ContactEvaluation::measure(Index j, const contact::PairPositions& at) const {
    const contact::ContactPoint& point = points_[j];
    const bool rubs = pair_->options().rubs();
    contact::ContactState state{Vec3::Zero(), point.gap, point.normal, rubs ? drift(j) : Vec3(Vec3::Zero())};
    state.gap -= kept_depth(j);
    if (!point.found || tails_.slaves.empty()) return state;
    const bool told = tracking_.share != nullptr && !holds_geometry();
    state.gap += told ? rounded_[j] : discretisation_->gap_rounded_off(j, at, point);
    if (rubs && !tails_start_.slaves.empty()) state.drift += drift(j, tails_start_, tails_);
    return state;
}

void ContactEvaluation::prepare_variations(std::span<const char> wanted, int threads) {
    if (!holds_geometry()) discretisation_->prepare_variations(positions(), wanted, threads);
}

void ContactEvaluation::vary(Index j, contact::ContactVariation& variation) const {
    variation.patches.clear();
    if (!holds_geometry()) {
        discretisation_->vary(j, positions(), hit(j), points_[j], variation);
        return;
    }
    variation.dg = held_geometry_[j].dg;
    const Index columns = variation.dg.cols(), n = columns / 3 - 1;
    variation.dn.setZero(3, columns);
    variation.dweights.setZero(n, columns);
    variation.dpressing.setZero(3 * n, columns);
}

void ContactEvaluation::drift_variation(Index j, const contact::ContactVariation& variation, Matrix& dd) const {
    if (!pair_->options().rubs()) {
        dd.setZero(3, variation.dg.cols());
        return;
    }
    // dd = ds - Phi_i dx_i - (x_i - x_i,start) dPhi_i
    const contact::ContactPoint& point = points_[j];
    const auto n = static_cast<Index>(point.nodes.size());
    Eigen::Matrix3Xd moved(3, carriers(j));
    for (Index i = 0; i < moved.cols(); ++i) {
        const Index v = point.nodes[i];
        moved.col(i) = pair_->image(v) * (at(now_, v) - at(start_, v));
    }
    variation.weights_times(point, -moved, dd);
    dd.leftCols<3>() += Mat3::Identity();
    for (Index i = 0; i < n; ++i) dd.middleCols<3>(3 + 3 * i) -= point.weights(i) * Mat3::Identity();
    const std::vector<Mat3>& in_plane = pair_->slaves().in_plane;
    if (!in_plane.empty()) dd = (in_plane[j] * dd).eval();
}

Vec3 ContactEvaluation::master_force(Index j, Index i, const Vec3& lambda) const {
    return image(j, i).transpose() * points_[j].force(i, lambda);
}

contact::MatrixX3 ContactEvaluation::master_force_by_lambda(Index j) const {
    // f_i = p_i L - Phi_i lambda_T,   L = lambda . n,  lambda_T = lambda - L n
    const contact::ContactPoint& point = points_[j];
    contact::MatrixX3 by_lambda(3 * carriers(j), 3);
    for (Index i = 0; i < carriers(j); ++i) {
        const double phi = point.weights(i);
        const Vec3 along = point.pressing.row(i).transpose() + phi * point.normal;
        by_lambda.middleRows<3>(3 * i) = along * point.normal.transpose() - phi * Mat3::Identity();
    }
    return by_lambda;
}

void ContactEvaluation::master_force_by_y(Index j, const Vec3& lambda, const contact::ContactVariation& variation,
                                          Matrix& by_y) const {
    const Index count = carriers(j);
    by_y.resize(3 * count, variation.dg.cols());
    const Vector none = Vector::Zero(count);
    for (Index k = 0; k < by_y.cols(); ++k) {
        const double* const dpressing = variation.dpressing.cols() > 0 ? variation.dpressing.col(k).data() : nullptr;
        const double* const dweights = k < variation.dweights.cols() ? variation.dweights.col(k).data() : none.data();
        discretisation_->force_change(points_[j], lambda, variation.dn.col(k),
                                      {dweights, static_cast<std::size_t>(count)}, dpressing, by_y.col(k).data());
    }
}

void ContactEvaluation::master_force_along(Index j, const Vec3& lambda, const contact::ContactVariation& variation,
                                           Vector& dy, Vector& df) const {
    if (pair_->mirrored()) // dx_vertex = M dx_node
        for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i)
            dy.segment<3>(3 + 3 * i) = (image(j, i) * dy.segment<3>(3 + 3 * i)).eval();
    static thread_local Vector dweights, dpressing;
    df.resize(3 * carriers(j));
    discretisation_->weights_along(points_[j], variation, dy, dweights, dpressing);
    discretisation_->force_change(points_[j], lambda, variation.dn * dy,
                                  {dweights.data(), static_cast<std::size_t>(carriers(j))}, dpressing.data(),
                                  df.data());
    if (pair_->mirrored())
        for (Index i = 0; i < carriers(j); ++i)
            df.segment<3>(3 * i) = (image(j, i).transpose() * df.segment<3>(3 * i)).eval();
}

void ContactEvaluation::follow_master(Index j, std::vector<Index>& nodes, std::vector<Mat3>& follow) const {
    static thread_local std::vector<Index> vertices;
    static thread_local std::vector<double> shares;
    discretisation_->follow(hit(j), points_[j], carriers(j), vertices, shares);
    nodes.clear();
    follow.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        nodes.push_back(pair_->node(vertices[i]));
        follow.emplace_back(shares[i] * pair_->image(vertices[i]));
    }
}

void ContactEvaluation::fold(Index j, Matrix& A, contact::MatrixX3& E) const {
    if (!pair_->mirrored()) return;
    for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i) {
        const Mat3& M = image(j, i); // dx_vertex = M dx_node, f_node = M^T f_vertex
        A.middleCols<3>(3 + 3 * i) = (A.middleCols<3>(3 + 3 * i) * M).eval();
        if (i < carriers(j)) E.middleRows<3>(3 * i) = (M.transpose() * E.middleRows<3>(3 * i)).eval();
    }
}

void ContactEvaluation::fold(Index j, Matrix& G) const {
    if (!pair_->mirrored()) return;
    for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i) {
        const Mat3& M = image(j, i);
        G.middleCols<3>(3 + 3 * i) = (G.middleCols<3>(3 + 3 * i) * M).eval();
        if (i < carriers(j)) G.middleRows<3>(3 * i) = (M.transpose() * G.middleRows<3>(3 * i)).eval();
    }
}

ContactEvaluations contact_evaluations(const ContactPairs& pairs) {
    ContactEvaluations evaluations;
    evaluations.reserve(pairs.size());
    for (const auto& pair : pairs) evaluations.emplace_back(*pair);
    return evaluations;
}

ContactPairs pairs_of(const std::vector<ContactHistory>& contact) {
    ContactPairs pairs;
    for (const ContactHistory& history : contact) pairs.push_back(history.pair);
    return pairs;
}

} // namespace osculate::model
