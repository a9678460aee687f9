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
                         std::unique_ptr<contact::MasterSurface> master, const ContactOptions& options)
    : name_(std::move(name)), slaves_(std::move(slaves)), surface_(std::move(surface)),
      master_nodes_(std::move(master_nodes)), master_(std::move(master)),
      search_(*surface_, vertices(X), centre(X, slaves_.node)), options_(options), inertia_(slaves_.node.size(), 0.0),
      held_(slaves_.node.size(), 0), facet_(slaves_.node.size(), -1), changes_(slaves_.node.size(), 0),
      hits_(slaves_.node.size()), points_(slaves_.node.size()), point_nodes_(slaves_.node.size()) {
    finest_ = std::numeric_limits<double>::infinity();
    for (Index f = 0; f < surface_->facet_count(); ++f)
        finest_ = std::min({finest_, surface_->facet_size(f), thickness(f)});
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
    const Index at = master_nodes_.image.empty() ? 0 : master_nodes_.image[points_[j].nodes[i]];
    return master_nodes_.images[at].M;
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
    const ScopedTimer timer(timings, Part::search);
    vertices_ = vertices(x);
    search_.build(vertices_);
    parallel_for(threads, size(), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j)
            if (facet_[j] < 0 || !contact::is_closed(history.status[j]))
                facet_[j] = search_.global(x[slaves_.node[j]], vertices_).facet;
    });
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
            }
        });
        facet_changes_ = 0;
        for (Index j = 0; j < size(); ++j)
            if (hits_[j].facet != facet_[j]) {
                facet_[j] = hits_[j].facet;
                ++changes_[j];
                ++facet_changes_;
            }
    }
    const ScopedTimer timer(timings, Part::contact);
    master_->prepare(hits_, vertices_, threads);
    parallel_for(threads, size(), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
            contact::ContactPoint& point = points_[j];
            master_->evaluate(x[slaves_.node[j]], hits_[j], vertices_, point);
            point_nodes_[j].clear();
            if (!point.found) continue;
            for (const Index v : point.nodes) point_nodes_[j].push_back(master_nodes_.node[v]);
        }
    });
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
    return drift;
}

contact::ContactState ContactTerm::state(Index j, const std::vector<Vec3>& x, const Vec3& lambda) const {
    return {lambda, points_[j].gap, points_[j].normal, drift(j, x_start_, x)};
}

void ContactTerm::vary(Index j, const std::vector<Vec3>& x, contact::ContactVariation& variation) const {
    contact::ContactPoint again;
    master_->evaluate(x[slaves_.node[j]], hits_[j], vertices_, again, &variation);
}

void ContactTerm::drift_variation(Index j, const std::vector<Vec3>& x, const contact::ContactVariation& variation,
                                  Matrix& dd) const {
    // dd = ds - Phi_i dx_i - (x_i - x_i,start) dPhi_i
    const contact::ContactPoint& point = points_[j];
    const auto n = static_cast<Index>(point_nodes_[j].size());
    Eigen::Matrix3Xd moved(3, n);
    for (Index i = 0; i < n; ++i) moved.col(i) = image(j, i) * (x[point_nodes_[j][i]] - x_start_[point_nodes_[j][i]]);
    dd.noalias() = -moved * variation.dweights;
    dd.leftCols<3>() += Mat3::Identity();
    for (Index i = 0; i < n; ++i) dd.middleCols<3>(3 + 3 * i) -= point.weights(i) * Mat3::Identity();
}

Vec3 ContactTerm::master_force(Index j, Index i, const Vec3& lambda) const {
    const contact::ContactPoint& point = points_[j];
    const double normal = lambda.dot(point.normal);
    const Vec3 force = point.pressing.row(i).transpose() * normal - point.weights(i) * (lambda - normal * point.normal);
    return image(j, i).transpose() * force;
}

void ContactTerm::master_force_variation(Index j, const Vec3& lambda, const contact::ContactVariation& variation,
                                         MatrixX3& by_lambda, Matrix& by_y) const {
    // d f_i = dp_i L + p_i dL - dPhi_i lambda_T + Phi_i (n dL + L dn),   L = lambda . n,  lambda_T = lambda - L n
    const contact::ContactPoint& point = points_[j];
    const Vec3& n = point.normal;
    const auto count = static_cast<Index>(point_nodes_[j].size());
    const double L = lambda.dot(n);
    const Vec3 lambda_T = lambda - L * n;
    const Eigen::Matrix<double, 1, Eigen::Dynamic> dL = lambda.transpose() * variation.dn;
    by_lambda.resize(3 * count, 3);
    by_y.resize(3 * count, 3 + 3 * count);
    Eigen::Matrix3Xd along(3, count); // p_i + Phi_i n
    for (Index i = 0; i < count; ++i) {
        const double phi = point.weights(i);
        along.col(i) = point.pressing.row(i).transpose() + phi * n;
        by_lambda.middleRows<3>(3 * i) = along.col(i) * n.transpose() - phi * Mat3::Identity();
    }
    for (Index k = 0; k < by_y.cols(); ++k) {
        const Vec3 turn = L * variation.dn.col(k);
        const double* dp = variation.dpressing.col(k).data();
        const double* dphi = variation.dweights.col(k).data();
        double* out = by_y.col(k).data();
        for (Index i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c)
                out[3 * i + c] =
                    L * dp[3 * i + c] + along(c, i) * dL(k) + point.weights(i) * turn(c) - lambda_T(c) * dphi[i];
    }
}

void ContactTerm::follow_facet(Index j, std::vector<Index>& nodes, std::vector<Mat3>& follow) const {
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

void ContactTerm::fold(Index j, Matrix& A, MatrixX3& E, Matrix& G) const {
    if (master_nodes_.image.empty()) return;
    for (Index i = 0; i < static_cast<Index>(point_nodes_[j].size()); ++i) {
        const Mat3& M = image(j, i); // dx_vertex = M dx_node, f_node = M^T f_vertex
        A.middleCols<3>(3 + 3 * i) = (A.middleCols<3>(3 + 3 * i) * M).eval();
        G.middleCols<3>(3 + 3 * i) = (G.middleCols<3>(3 + 3 * i) * M).eval();
        E.middleRows<3>(3 * i) = (M.transpose() * E.middleRows<3>(3 * i)).eval();
        G.middleRows<3>(3 * i) = (M.transpose() * G.middleRows<3>(3 * i)).eval();
    }
}

} // namespace osculate::model
