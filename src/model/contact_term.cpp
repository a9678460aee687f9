#include "osculate/model/contact_term.hpp"

#include "osculate/contact/facet_patch.hpp"
#include "osculate/core/parallel.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace osculate::model {

namespace {
/// Stick stiffness of held slave nodes over c: elastic slip far below the elastic displacements of the bodies.
constexpr double held_stick_stiffness = 100;

Vec3 centre(const std::vector<Vec3>& x, const std::vector<Index>& nodes) {
    Vec3 sum = Vec3::Zero();
    for (const Index node : nodes) sum += x[node];
    return sum / static_cast<double>(nodes.size());
}
} // namespace

ContactTerm::ContactTerm(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                         std::unique_ptr<mesh::HalfEdgeSurface> surface, MasterNodes master_nodes,
                         std::unique_ptr<contact::MasterSurface> master, const ContactOptions& options,
                         const contact::SmoothSlave* smooth)
    : name_(std::move(name)), slaves_(std::move(slaves)), surface_(std::move(surface)),
      master_nodes_(std::move(master_nodes)), master_(std::move(master)),
      search_(*surface_, vertices(X), centre(X, slaves_.node)), options_(options), inertia_(slaves_.node.size(), 0.0),
      held_(slaves_.node.size(), 0), facet_(slaves_.node.size(), -1), side_(slaves_.node.size(), -1),
      changes_(slaves_.node.size(), 0), hits_(slaves_.node.size()), points_(slaves_.node.size()),
      point_nodes_(slaves_.node.size()) {
    finest_ = std::numeric_limits<double>::infinity();
    for (Index f = 0; f < surface_->facet_count(); ++f)
        finest_ = std::min({finest_, surface_->facet_size(f), thickness(f)});
    if (options_.discretisation == Discretisation::mortar) {
        std::map<Index, Index> number;
        for (Index j = 0; j < size(); ++j) number[slaves_.node[j]] = j;
        std::vector<contact::SlaveFacet> facets;
        for (const mesh::Facet& facet : slaves_.facets) {
            contact::SlaveFacet& own = facets.emplace_back();
            own.count = facet.count;
            for (std::size_t c = 0; c < static_cast<std::size_t>(facet.count); ++c)
                own.node[c] = number.at(facet.nodes[c]);
        }
        mortar_ = std::make_unique<contact::Mortar>(*surface_, *master_, facets, slave_positions(X), slaves_.in_plane,
                                                    smooth);
    }
    if (master_nodes_.image.empty()) return;
    std::map<Index, Index> own; // node -> vertex
    for (std::size_t v = 0; v < master_nodes_.node.size(); ++v)
        if (master_nodes_.image[v] == 0) own[master_nodes_.node[v]] = static_cast<Index>(v);
    for (const Index node : master_nodes_.node) own_vertex_.push_back(own.at(node));
}

double ContactTerm::thickness(Index facet) const {
    double least = std::numeric_limits<double>::infinity();
    if (!master_nodes_.thickness.empty())
        for (const Index v : surface_->facet_vertices(facet)) least = std::min(least, master_nodes_.thickness[v]);
    return least;
}

std::vector<Vec3> ContactTerm::vertices(const std::vector<Vec3>& x) const {
    std::vector<Vec3> v(master_nodes_.node.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        v[i] = x[master_nodes_.node[i]];
        if (!master_nodes_.image.empty()) v[i] = master_nodes_.images[master_nodes_.image[i]](v[i]);
    }
    return v;
}

const Mat3& ContactTerm::image(Index j, Index i) const {
    const Index vertex = points_[j].nodes[i];
    const bool own = master_nodes_.image.empty() || vertex >= surface_->vertex_count();
    return master_nodes_.images[own ? 0 : master_nodes_.image[vertex]].M;
}

std::vector<Vec3> ContactTerm::slave_positions(const std::vector<Vec3>& x) const {
    std::vector<Vec3> s;
    for (const Index node : slaves_.node) s.push_back(x[node]);
    return s;
}

ContactHistory ContactTerm::initial_history() const {
    const std::size_t n = slaves_.node.size();
    return {std::vector<Vec3>(n, Vec3::Zero()), std::vector<contact::Status>(n, contact::Status::open),
            std::vector<Index>(n, -1)};
}

void ContactTerm::begin_step(const std::vector<Vec3>& x, const ContactHistory& history, Timings& timings, int threads) {
    x_start_ = x;
    facet_ = history.facet;
    lambda_start_ = history.lambda;
    std::fill(changes_.begin(), changes_.end(), 0);
    std::fill(side_.begin(), side_.end(), -1);
    const ScopedTimer timer(timings, Part::search);
    vertices_ = vertices(x);
    search_.build(vertices_);
    parallel_for(threads, size(), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j)
            if (facet_[j] < 0 || !contact::is_closed(history.status[j]))
                facet_[j] = search_.global(x[slaves_.node[j]], vertices_).facet;
    });
    if (mortar_) mortar_->begin(slave_positions(x), vertices_, search_, facet_, threads);
}

void ContactTerm::evaluate(const std::vector<Vec3>& x, Timings& timings, int threads) {
    {
        const ScopedTimer timer(timings, Part::search);
        vertices_ = vertices(x);
        parallel_for(threads, size(), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) {
                const Vec3& s = x[slaves_.node[j]];
                hits_[j] = changes_[j] < options_.changes_before_latch
                               ? search_.track(s, facet_[j], vertices_, options_.hysteresis)
                               : search_.closest_on(facet_[j], s, vertices_);
                hits_[j].latched = changes_[j] >= options_.changes_before_latch;
            }
        });
        facet_changes_ = 0;
        for (Index j = 0; j < size(); ++j)
            if (hits_[j].facet != facet_[j]) {
                changes_[j] += facet_[j] < 0 || hits_[j].facet < 0 || master_->tells_apart(facet_[j], hits_[j].facet);
                facet_[j] = hits_[j].facet;
                ++facet_changes_;
            }
    }
    const ScopedTimer timer(timings, Part::contact);
    if (mortar_)
        facet_changes_ += mortar_->evaluate(slave_positions(x), vertices_, search_, options_.hysteresis,
                                            options_.changes_before_latch, facet_, points_, threads);
    else
        evaluate_nodes(x, threads);
    for (Index j = 0; j < size(); ++j) {
        point_nodes_[j].clear();
        if (!points_[j].found) continue;
        for (const Index v : points_[j].nodes)
            point_nodes_[j].push_back(v < surface_->vertex_count() ? master_nodes_.node[v]
                                                                   : slaves_.node[v - surface_->vertex_count()]);
    }
}

void ContactTerm::evaluate_nodes(const std::vector<Vec3>& x, int threads) {
    master_->prepare(hits_, vertices_, threads);
    parallel_for(threads, size(), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) master_->evaluate(x[slaves_.node[j]], hits_[j], vertices_, points_[j]);
    });
    // a point in a crease may see now one side, now the other, above the same facet
    for (Index j = 0; j < size(); ++j) {
        const Index now = points_[j].found ? points_[j].side : -1;
        if (now >= 0 && side_[j] >= 0 && now != side_[j] && master_->tells_apart(side_[j], now) &&
            ++changes_[j] >= options_.changes_before_latch)
            facet_[j] = now;
        side_[j] = now;
    }
}

double ContactTerm::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const contact::ContactPoint& point : points_)
        if (point.found) least = std::min(least, point.gap);
    return least;
}

double ContactTerm::unseen_gap(Index j, const std::vector<Vec3>& x) const {
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    if (!mortar_ || points_[j].found || hits_[j].facet < 0) return nowhere;
    contact::ContactPoint point;
    master_->evaluate(x[slaves_.node[j]], hits_[j], vertices_, point);
    return point.found || point.behind ? point.gap : nowhere;
}

contact::Coulomb ContactTerm::law(Index j) const {
    const double c = stiffness(j);
    if (held_[j] == 0) return {options_.friction, c};
    return contact::Coulomb::elastic(options_.friction, c, held_stick_stiffness * c, lambda_start_[j]);
}

std::vector<Index> ContactTerm::patch_nodes(Index facet) const {
    std::vector<Index> nodes;
    for (const Index v : master_->patch_vertices(facet)) nodes.push_back(master_nodes_.node[v]);
    return nodes;
}

Vec3 ContactTerm::drift(Index j, const std::vector<Vec3>& from, const std::vector<Vec3>& to) const {
    // d = (s - s_start) - sum_i Phi_i (x_i - x_i,start)                                   [Qian 2014, eq (8)]
    Vec3 drift = to[slaves_.node[j]] - from[slaves_.node[j]];
    for (std::size_t i = 0; i < point_nodes_[j].size(); ++i) {
        const Index node = point_nodes_[j][i];
        drift -=
            points_[j].weights(static_cast<Index>(i)) * (image(j, static_cast<Index>(i)) * (to[node] - from[node]));
    }
    // averages over half of a node's facets, those on this side of a symmetry plane, lack what the others would cancel
    if (!slaves_.in_plane.empty()) drift = slaves_.in_plane[j] * drift;
    return drift;
}

double ContactTerm::gap_rounded_off(Index j, const std::vector<Vec3>& tails) const {
    if (mortar_)
        return mortar_->gap_rounded_off(
            j, [&](Index slave) { return tails[slaves_.node[slave]]; },
            [&](Index vertex) -> Vec3 {
                const Vec3& tail = tails[master_nodes_.node[vertex]];
                if (!mirrored()) return tail;
                return master_nodes_.images[master_nodes_.image[vertex]].M * tail;
            });
    // the variation of the gap is the work of a unit normal force
    const Vec3& n = points_[j].normal;
    double lost = n.dot(tails[slaves_.node[j]]);
    for (Index i = 0; i < carriers(j); ++i) lost += master_force(j, i, n).dot(tails[point_nodes_[j][i]]);
    return lost;
}

contact::ContactState ContactTerm::state(Index j, const std::vector<Vec3>& x, const Vec3& lambda) const {
    return {lambda, points_[j].gap, points_[j].normal, options_.friction > 0 ? drift(j, x) : Vec3(Vec3::Zero())};
}

Index ContactTerm::carriers(Index j) const {
    return mortar_ ? mortar_->carriers(j) : static_cast<Index>(point_nodes_[j].size());
}

void ContactTerm::prepare_variations(const std::vector<Vec3>& x, std::span<const char> wanted, int threads) {
    if (mortar_) mortar_->prepare_variations(slave_positions(x), vertices_, wanted, threads);
}

void ContactTerm::vary(Index j, const std::vector<Vec3>& x, contact::ContactVariation& variation) const {
    variation.patches.clear();
    if (mortar_) return mortar_->vary(j, points_[j], variation);
    master_->vary(x[slaves_.node[j]], hits_[j], vertices_, points_[j], variation);
}

void ContactTerm::drift_variation(Index j, const std::vector<Vec3>& x, const contact::ContactVariation& variation,
                                  Matrix& dd) const {
    if (!(options_.friction > 0)) {
        dd.setZero(3, variation.dg.cols());
        return;
    }
    // dd = ds - Phi_i dx_i - (x_i - x_i,start) dPhi_i
    const contact::ContactPoint& point = points_[j];
    const auto n = static_cast<Index>(point_nodes_[j].size());
    Eigen::Matrix3Xd moved(3, carriers(j));
    for (Index i = 0; i < moved.cols(); ++i)
        moved.col(i) = image(j, i) * (x[point_nodes_[j][i]] - x_start_[point_nodes_[j][i]]);
    variation.weights_times(point, -moved, dd);
    dd.leftCols<3>() += Mat3::Identity();
    for (Index i = 0; i < n; ++i) dd.middleCols<3>(3 + 3 * i) -= point.weights(i) * Mat3::Identity();
    if (!slaves_.in_plane.empty()) dd = (slaves_.in_plane[j] * dd).eval();
}

Vec3 ContactTerm::master_force(Index j, Index i, const Vec3& lambda) const {
    const contact::ContactPoint& point = points_[j];
    const double normal = lambda.dot(point.normal);
    const Vec3 force = point.pressing.row(i).transpose() * normal - point.weights(i) * (lambda - normal * point.normal);
    return image(j, i).transpose() * force;
}

contact::MatrixX3 ContactTerm::master_force_by_lambda(Index j) const {
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

void ContactTerm::master_force_by_y(Index j, const Vec3& lambda, const contact::ContactVariation& variation,
                                    Matrix& by_y) const {
    const Index count = carriers(j);
    by_y.resize(3 * count, variation.dg.cols());
    for (Index k = 0; k < by_y.cols(); ++k) {
        const auto dpressing = variation.dpressing.cols() > 0 && !mortar_ ? variation.dpressing.col(k).data() : nullptr;
        turn_forces(j, lambda, variation.dn.col(k), variation.dweights.col(k).data(), dpressing, by_y.col(k).data());
    }
}

void ContactTerm::turn_forces(Index j, const Vec3& lambda, const Vec3& dn, const double* dweights,
                              const double* dpressing, double* df) const {
    // df_i = dp_i L + p_i dL - dPhi_i lambda_T + Phi_i (n dL + L dn)
    const contact::ContactPoint& point = points_[j];
    const Index count = carriers(j);
    if (mortar_) { // p_i = -W_i n: what is left is f_i = -W_i lambda
        for (Index i = 0; i < count; ++i) Eigen::Map<Vec3>(df + 3 * i) = -dweights[i] * lambda;
        return;
    }
    const Vec3& n = point.normal;
    const double L = lambda.dot(n), dL = lambda.dot(dn);
    const Vec3 lambda_T = lambda - L * n, turn = dL * n + L * dn;
    for (Index i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            df[3 * i + c] = L * dpressing[3 * i + c] + point.pressing(i, c) * dL + point.weights(i) * turn(c) -
                            lambda_T(c) * dweights[i];
}

void ContactTerm::master_force_along(Index j, const Vec3& lambda, const contact::ContactVariation& variation,
                                     Vector& dy, Vector& df) const {
    if (mirrored()) // dx_vertex = M dx_node
        for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i)
            dy.segment<3>(3 + 3 * i) = (image(j, i) * dy.segment<3>(3 + 3 * i)).eval();
    static thread_local Vector dweights, dpressing;
    df.resize(3 * carriers(j));
    if (mortar_)
        dweights.noalias() = variation.dweights * dy;
    else
        variation.along(points_[j], dy, dweights, dpressing);
    turn_forces(j, lambda, variation.dn * dy, dweights.data(), dpressing.data(), df.data());
    if (mirrored())
        for (Index i = 0; i < carriers(j); ++i)
            df.segment<3>(3 * i) = (image(j, i).transpose() * df.segment<3>(3 * i)).eval();
}

void ContactTerm::follow_master(Index j, std::vector<Index>& nodes, std::vector<Mat3>& follow) const {
    if (mortar_) {
        nodes.assign(point_nodes_[j].begin(), point_nodes_[j].begin() + carriers(j));
        follow.clear();
        for (Index i = 0; i < carriers(j); ++i) follow.emplace_back(points_[j].weights(i) * image(j, i));
        return;
    }
    const auto vertices = surface_->facet_vertices(hits_[j].facet);
    const contact::FacetPatch facet(static_cast<int>(vertices.size()));
    Vector weights(facet.size());
    contact::MatrixX2 slopes(facet.size(), 2);
    facet.weights(hits_[j].u, weights, slopes);
    nodes.clear();
    follow.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        nodes.push_back(master_nodes_.node[vertices[i]]);
        const Index image = master_nodes_.image.empty() ? 0 : master_nodes_.image[vertices[i]];
        follow.emplace_back(weights(static_cast<Index>(i)) * master_nodes_.images[image].M);
    }
}

void ContactTerm::fold(Index j, Matrix& A, contact::MatrixX3& E) const {
    if (!mirrored()) return;
    for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i) {
        const Mat3& M = image(j, i); // dx_vertex = M dx_node, f_node = M^T f_vertex
        A.middleCols<3>(3 + 3 * i) = (A.middleCols<3>(3 + 3 * i) * M).eval();
        if (i < carriers(j)) E.middleRows<3>(3 * i) = (M.transpose() * E.middleRows<3>(3 * i)).eval();
    }
}

void ContactTerm::fold(Index j, Matrix& G) const {
    if (!mirrored()) return;
    for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i) {
        const Mat3& M = image(j, i);
        G.middleCols<3>(3 + 3 * i) = (G.middleCols<3>(3 + 3 * i) * M).eval();
        if (i < carriers(j)) G.middleRows<3>(3 * i) = (M.transpose() * G.middleRows<3>(3 * i)).eval();
    }
}

} // namespace osculate::model
