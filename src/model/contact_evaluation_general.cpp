/// What general contact asks of an evaluation beyond what pairs written by hand do: which facets a node may touch, where contact
/// ends, and depths that are kept.

#include "osculate/contact/near_facets.hpp"
#include "osculate/model/contact_evaluation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::model {

namespace {
/// How deep a node may be behind such a facet at the start of an attempt, in sizes of it and in thicknesses of the body behind:
/// a node that is deeper is on the body's other side.
constexpr double behind_at_start = 0.3;
/// A node that lies beside a facet rather than above it, by this sine, is above nothing; unless it is this near, in facet sizes.
constexpr double beside = 0.8, at_edge = 0.05;
/// A node that yields leaves a place to the slaves there if it is this near to a vertex or a sharp edge of theirs, in facet
/// sizes, and a face of its own lies on the facet, by this cosine.
constexpr double end = 0.04, flat = 0.98;
/// Cosine between the normal and an edge of the slave that goes into the master at 25 degrees.
constexpr double deepest_edge = -0.42;
/// What a contact in force is allowed beyond these bounds, so that it does not end where it holds and begin where it does
/// not: parts of them, and of the facet size at a boundary.
constexpr double slack = 0.5, past_end = 0.05;
/// How far a smooth surface may rise above a facet, in sizes of the largest facet around: where they turn away from each other by
/// an angle, this part of its tangent, twice what an arc would; and in any case.
constexpr double bulging = 0.25, always = 0.01;
/// The same of a filter, which flattens the master over a slave facet of area A: of the tangent, either way, times A over the size.
constexpr double flattened = 0.25;
/// Clearance of nodes that are never passed over.
constexpr double at_once = -std::numeric_limits<double>::max();
/// A node whose distance to the facet is more than this part above its plane is in front of it.
constexpr double above = 0.7;
/// One that is more than this part below it may be inside the master.
constexpr double below = 0.1;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
} // namespace

void ContactEvaluation::place_facets(const std::vector<Vec3>& x) {
    faces_.resize(inertia_.size());
    for (std::size_t j = 0; j < faces_.size(); ++j) {
        faces_[j].clear();
        for (const mesh::Facet& facet : pair_->slaves().around[j])
            faces_[j].push_back(mesh::facet_area_vector(facet, x).normalized());
    }
    const mesh::HalfEdgeSurface& surface = pair_->surface();
    const auto count = static_cast<std::size_t>(surface.facet_count());
    facets_.normal.resize(count);
    facets_.centre.resize(count);
    for (std::size_t f = 0; f < count; ++f) {
        const auto v = surface.facet_vertices(static_cast<Index>(f));
        Vec3 n = Vec3::Zero(), c = vertices_[v[0]] + vertices_[v[1]];
        for (std::size_t i = 2; i < v.size(); ++i) {
            n += (vertices_[v[i - 1]] - vertices_[v[0]]).cross(vertices_[v[i]] - vertices_[v[0]]);
            c += vertices_[v[i]];
        }
        facets_.normal[f] = n.normalized();
        facets_.centre[f] = c / static_cast<double>(v.size());
    }
    const double area = pair_->size() > 0 ? std::ranges::max(pair_->slaves().area) : 0;
    bulge_.assign(count, 0);
    for (std::size_t f = 0; f < count; ++f) {
        const Vec3& n = facets_.normal[f];
        double size = 0, away = 0, any = 0;
        for (const Index v : surface.facet_vertices(static_cast<Index>(f)))
            for (const Index g : surface.vertex_facets(v)) {
                size = std::max(size, surface.facet_size(g));
                const Vec3& m = facets_.normal[static_cast<std::size_t>(g)];
                const double tangent = n.cross(m).norm() < n.dot(m) ? n.cross(m).norm() / n.dot(m) : 1;
                any = std::max(any, tangent);
                if (n.dot(facets_.centre[static_cast<std::size_t>(g)] - facets_.centre[f]) < 0)
                    away = std::max(away, tangent);
            }
        bulge_[f] = size * (always + bulging * away);
        if (averages(pair_->options().discretisation))
            bulge_[f] += flattened * any * area / surface.facet_size(static_cast<Index>(f));
    }
}

bool ContactEvaluation::is_left_to_slaves(Index j) const {
    const Index facet = tracking_.facet[j];
    if (facet < 0) return false;
    const Vec3& n = facets_.normal[static_cast<std::size_t>(facet)];
    const double lies = in_force_[j] != 0 ? 1 - slack * (1 - flat) : flat;
    if (std::ranges::none_of(faces_[static_cast<std::size_t>(j)], [&](const Vec3& m) { return m.dot(n) < -lies; }))
        return false;
    const mesh::HalfEdgeSurface& surface = pair_->surface();
    const double near = end * surface.facet_size(facet) * (in_force_[j] != 0 ? slack : 1);
    const auto around = surface.facet_vertices(facet);
    const Vec3& x = now_.slaves[j];
    for (std::size_t c = 0; c < around.size(); ++c) {
        const Vec3 &a = vertices_[around[c]], b = vertices_[around[(c + 1) % around.size()]];
        if ((x - a).norm() < near) return true;
        const Index edge = surface.first_half_edge(facet) + static_cast<Index>(c);
        if (!surface.is_feature_edge(edge) && !surface.is_boundary_edge(edge)) continue;
        if ((x - a).cross(b - a).norm() < near * (b - a).norm()) return true;
    }
    return false;
}

bool ContactEvaluation::looks_past(Index j) const {
    const contact::FacetHit& hit = tracking_.hits[j];
    const bool held = in_force_[j] != 0;
    return hit.facet >= 0 && hit.overhang > (held ? 1 - slack * (1 - beside) : beside) * hit.distance &&
           hit.overhang > at_edge * (held ? 1 + slack : 1) * pair_->surface().facet_size(hit.facet);
}

bool ContactEvaluation::may_touch(Index j, Index facet) const {
    const Vec3& n = facets_.normal[static_cast<std::size_t>(facet)];
    if (!watched(j)) {
        if (std::ranges::none_of(faces_[static_cast<std::size_t>(j)],
                                 [&](const Vec3& m) { return m.dot(n) < contact::facing; }))
            return false;
        const double depth = behind_at_start * std::min(pair_->surface().facet_size(facet), pair_->thickness(facet));
        if (!((start_.slaves[j] - facets_.centre[static_cast<std::size_t>(facet)]).dot(n) > -depth)) return false;
    }
    const SlaveNodes& slaves = pair_->slaves();
    if (!slaves.treated.empty()) {
        const std::vector<Index>& there = slaves.facet_treated[static_cast<std::size_t>(facet)];
        if (std::ranges::any_of(slaves.treated[static_cast<std::size_t>(j)],
                                [&](Index side) { return std::ranges::find(there, side) != there.end(); }))
            return false;
    }
    const std::optional<OwnSurface>& own = slaves.own;
    return !own || !std::ranges::binary_search(own->around[static_cast<std::size_t>(j)], facet);
}

contact::FacetSearch::Choice ContactEvaluation::choice(Index j) const {
    if (!pair_->options().in_force) return [](Index) { return false; };
    if (pair_->slaves().around.empty()) return {};
    return [this, j](Index facet) { return may_touch(j, facet); };
}

void ContactEvaluation::drop_what_is_not_pointed_at(const std::vector<Vec3>& x) {
    const SlaveNodes& slaves = pair_->slaves();
    for (Index j = 0; j < pair_->size(); ++j) {
        contact::ContactPoint& point = points_[j];
        const Vec3& s = x[slaves.node[j]];
        Vec3 n = point.normal;
        if (!point.found) { // of the facet
            n.setZero();
            const auto around =
                hit(j).facet >= 0 ? pair_->surface().facet_vertices(hit(j).facet) : std::span<const Index>{};
            for (std::size_t c = 2; c < around.size(); ++c)
                n += (vertices_[around[c - 1]] - vertices_[around[0]])
                         .cross(vertices_[around[c]] - vertices_[around[0]]);
            n.normalize();
        }
        points_at_[j] =
            watched(j) || std::ranges::all_of(slaves.along[static_cast<std::size_t>(j)], [&](Index end) {
                return (x[end] - s).normalized().dot(n) >= deepest_edge * (in_force_[j] != 0 ? 1 + 0.5 * slack : 1);
            });
        if (points_at_[j] == 0) point.found = point.behind = false;
    }
}

void ContactEvaluation::end_at_bounds(Index j) {
    contact::FacetHit& hit = tracking_.hits[j];
    if (looks_past(j))
        hit.beyond = hit.overhang;
    else if (in_force_[j] != 0 && hit.beyond > 0)
        hit.beyond = std::max(0.0, hit.beyond - past_end * pair_->surface().facet_size(hit.facet));
}

double ContactEvaluation::height(Index j, Index facet) const {
    const auto around = pair_->surface().facet_vertices(facet);
    Vec3 n = Vec3::Zero();
    for (std::size_t c = 2; c < around.size(); ++c)
        n += (vertices_[around[c - 1]] - vertices_[around[0]]).cross(vertices_[around[c]] - vertices_[around[0]]);
    return (now_.slaves[j] - vertices_[around[0]]).dot(n.normalized());
}

void ContactEvaluation::pass_over_clear_nodes() {
    for (Index j = 0; j < pair_->size(); ++j) {
        contact::FacetHit& hit = tracking_.hits[j];
        if (is_far(j) || hit.facet < 0 || clearance_[j] == at_once) continue;
        const double clear = hit.distance - bulge_[hit.facet];
        if (!(clear > 0) || !(height(j, hit.facet) > above * hit.distance)) continue;
        left_[j] = clear;
        tracking_.far[j] = 1;
        hit = {};
        hit.distance = clear;
    }
}

void ContactEvaluation::find_clearances(const ContactHistory& history) {
    const SlaveNodes& slaves = pair_->slaves();
    // averages of gaps look for facets by themselves
    if (slaves.around.empty() || pair_->options().discretisation == Discretisation::mortar) return;
    for (Index j = 0; j < pair_->size(); ++j) {
        const contact::FacetHit& hit = closest_[j];
        const bool closed = contact::is_closed(history.status[j]), none = hit.facet < 0;
        if (closed || watched(j) || (!none && height(j, hit.facet) < -below * hit.distance))
            clearance_.push_back(at_once);
        else
            clearance_.push_back(none ? reach() : hit.distance - bulge_[hit.facet]);
    }
    left_ = clearance_;
    vertices_start_ = vertices_;
}

void ContactEvaluation::find_far_nodes() {
    Vec3 mean = Vec3::Zero(); // motion of the master
    for (std::size_t v = 0; v < vertices_.size(); ++v)
        mean += (vertices_[v] - vertices_start_[v]) / static_cast<double>(vertices_.size());
    double farthest = 0;
    for (std::size_t v = 0; v < vertices_.size(); ++v)
        farthest = std::max(farthest, (vertices_[v] - vertices_start_[v] - mean).norm());
    tracking_.far.assign(clearance_.size(), 0);
    for (std::size_t j = 0; j < clearance_.size(); ++j) {
        left_[j] = clearance_[j] - farthest - (now_.slaves[j] - start_.slaves[j] - mean).norm();
        tracking_.far[j] = left_[j] > 0;
    }
}

void ContactEvaluation::drop_what_is_beside() {
    for (Index j = 0; j < pair_->size(); ++j) { // averages look past edges
        if (looks_past(j) || (yields(j) && is_left_to_slaves(j))) points_[j].found = points_[j].behind = false;
        in_force_[j] = points_[j].found;
    }
}

void ContactEvaluation::keep_depths(double part, const std::vector<Vec3>& x, Timings& timings, int threads,
                                    const std::vector<Vec3>& tails) {
    const SlaveNodes& slaves = pair_->slaves();
    if (!slaves.edges && slaves.around.empty()) return; // not of general contact
    evaluate(x, timings, threads, tails);
    std::vector<double> depth(points_.size(), unknown);
    for (Index j = 0; j < pair_->size(); ++j) {
        const contact::ContactPoint& point = points_[j];
        // edges that cross beyond their ends may come to cross within them, as deep as their lines are
        if (!point.found && !slaves.edges) continue;
        const Vec3& lambda = lambda_start_[j];
        depth[j] = part * std::min(0.0, distance(j, lambda));
    }
    depth_ = std::move(depth);
    kept_part_ = part;
    vertices_start_ = vertices_;
    forget_path();
}

double ContactEvaluation::kept_depth(Index j) const {
    if (depth_.empty() || !points_[j].found) return 0;
    if (!std::isnan(depth_[j])) return depth_[j];
    if (pair_->slaves().edges || points_[j].gap >= 0) return 0;
    // it comes to lie over a facet from beside it: where it was already lower, nothing pushes it up at once
    contact::FacetHit hit = search_.closest_on(tracking_.facet[j], start_.slaves[j], vertices_start_);
    hit.beyond = 0;
    contact::ContactPoint before;
    master_->evaluate(start_.slaves[j], hit, vertices_start_, before);
    return before.found || before.behind ? kept_part_ * std::min(0.0, before.gap) : 0;
}

} // namespace osculate::model
