#include "osculate/time/collision_check.hpp"

#include "osculate/contact/path_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::time {

namespace {
/// Cosine of the turn of the normal within a step.
constexpr double same_side = 0.5;

std::vector<contact::MovingFacets::Corners> corners(const mesh::HalfEdgeSurface& surface) {
    std::vector<contact::MovingFacets::Corners> facets;
    for (Index f = 0; f < surface.facet_count(); ++f) {
        facets.push_back({-1, -1, -1, -1});
        std::ranges::copy(surface.facet_vertices(f), facets.back().begin());
    }
    return facets;
}
} // namespace

CollisionCheck::CollisionCheck(const model::Model& model, model::ContactEvaluations& contact, const StepLimits& limits,
                               bool paths, Timings& timings, int threads)
    : model_(model), contact_(contact), limits_(limits), paths_(paths), timings_(timings), threads_(threads) {}

void CollisionCheck::begin_step(const model::State& state) {
    u_ = &state.u;
    x_ = sum(model_.X, state.u);
    starts_.clear();
    for (std::size_t p = 0; p < contact_.size(); ++p) {
        model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        evaluation.pass_over_far_nodes(paths_); // without paths, their gaps at the start tell what they went through
        evaluation.begin_step(x_, state.contact[p], timings_, threads_);
        evaluation.evaluate(x_, timings_, threads_);
        evaluation.pass_over_far_nodes(true);
        auto& list = starts_.emplace_back(static_cast<std::size_t>(pair.size()));
        for (Index j = 0; j < pair.size(); ++j) {
            const contact::ContactPoint& point = evaluation.point(j);
            const contact::FacetHit& hit = evaluation.hit(j);
            Start& start = list[j];
            start.closed = contact::is_closed(state.contact[p].status[j]);
            start.facet = hit.facet;
            start.distance = hit.distance; // none: farther than anything may move
            if (hit.facet < 0) continue;
            start.distance = hit.distance - pair.options().hysteresis * pair.surface().facet_size(hit.facet);
            start.found = point.found;
            if (!point.found) continue;
            start.gap = point.gap;
            start.normal = point.normal;
            start.facet = point.facet;
        }
    }
    x_ = {}; // nobody needs it while the step is solved
}

double CollisionCheck::length(std::size_t p, Index facet) const {
    const model::ContactPair& pair = contact_[p].pair();
    const double unit = limits_.in_metres ? 1 : pair.surface().facet_size(facet);
    return std::min(unit, deepest * pair.thickness(facet) / limits_.allowed_interpenetration);
}

double CollisionCheck::allowed(std::size_t p, Index facet) const {
    return limits_.allowed_interpenetration * length(p, facet);
}

bool CollisionCheck::speaks_by_normal(std::size_t p, const Start& start) const {
    // facets of a smooth surface, which turn by 40 degrees at most, leave an arc by less than this part of their size
    constexpr double hollow = 0.1;
    return start.found && (!paths_ || start.closed || start.gap < allowed(p, start.facet) ||
                           start.distance < hollow * contact_[p].pair().surface().facet_size(start.facet));
}

bool CollisionCheck::sheet_lost(std::size_t p, Index j, const Field& x) const {
    const contact::ContactPoint& point = contact_[p].point(j);
    const Start& start = starts_[p][j];
    if (!point.found || point.normal.dot(start.normal) <= same_side) return true;
    // the gap from one sheet changes by no more than the nodes there move
    constexpr double reserve = 2, round_off = 1e-9; // factor; facet sizes
    const model::ContactPair& pair = contact_[p].pair();
    const auto motion = [&](Index node) { return (x[node] - x_[node]).norm(); };
    double master = 0;
    for (const Index node : contact_[p].point_nodes(j)) master = std::max(master, motion(node));
    return std::abs(point.gap - start.gap) >
           reserve * (motion(pair.slaves().node[j]) + master) + round_off * pair.surface().facet_size(point.facet);
}

void CollisionCheck::add_trial(const Field& u, StepEvidence& evidence) {
    const Field x = sum(model_.X, u);
    x_ = sum(model_.X, *u_);
    add_normal_motions(x, evidence);
    for (std::size_t p = 0; p < starts_.size(); ++p)
        for (Index j = 0; j < contact_[p].pair().size(); ++j) {
            const Start& start = starts_[p][j];
            const contact::ContactPoint& point = contact_[p].point(j);
            if (start.closed || !start.found || !(point.found || point.behind)) continue;
            if (paths_ && sheet_lost(p, j, x)) continue; // of another sheet: told by motion or path
            // an initial overlap: no step is short enough, and the equilibrium with contact lifts it
            if (start.gap <= -allowed(p, start.facet)) continue;
            evidence.gaps.push_back({start.gap, point.gap, static_cast<Index>(p), j, length(p, point.facet)});
        }
    if (paths_) add_paths(x, evidence);
    x_ = {};
}

void CollisionCheck::add_solution(const Field& u, StepEvidence& evidence) {
    const Field x = sum(model_.X, u);
    x_ = sum(model_.X, *u_);
    add_normal_motions(x, evidence);
    if (paths_) add_paths(x, evidence);
    x_ = {};
}

void CollisionCheck::add_normal_motions(const Field& x, StepEvidence& evidence) const {
    for (std::size_t p = 0; p < starts_.size(); ++p) {
        const model::ContactPair& pair = contact_[p].pair();
        if (pair.slaves().edges) continue;
        for (Index j = 0; j < pair.size(); ++j) {
            const Start& start = starts_[p][j];
            if (!speaks_by_normal(p, start) || !sheet_lost(p, j, x)) continue;
            if (start.gap <= -allowed(p, start.facet)) continue; // as in add_trial()
            const auto moved = [&](Index node) -> Vec3 { return x[node] - x_[node]; };
            const auto around = pair.surface().facet_vertices(start.facet);
            Vec3 motion = moved(pair.slaves().node[j]);
            for (const Index v : around) motion -= moved(pair.master_nodes()[v]) / static_cast<double>(around.size());
            evidence.gaps.push_back(
                {start.gap, start.gap + start.normal.dot(motion), static_cast<Index>(p), j, length(p, start.facet)});
        }
    }
}

void CollisionCheck::add_paths(const Field& x, StepEvidence& evidence) {
    for (std::size_t p = 0; p < starts_.size(); ++p) {
        const model::ContactPair& pair = contact_[p].pair();
        if (pair.slaves().edges) {
            add_edge_paths(p, x, evidence);
            continue;
        }
        // motion relative to the mean of the master's
        const std::vector<Vec3> v0 = pair.vertices(x_), v1 = pair.vertices(x);
        Vec3 mean = Vec3::Zero();
        for (std::size_t v = 0; v < v0.size(); ++v) mean += (v1[v] - v0[v]) / static_cast<double>(v0.size());
        double farthest = 0;
        for (std::size_t v = 0; v < v0.size(); ++v) farthest = std::max(farthest, (v1[v] - v0[v] - mean).norm());

        std::vector<Index> slaves;
        for (Index j = 0; j < pair.size(); ++j) {
            const Start& start = starts_[p][j];
            const Index node = pair.slaves().node[j];
            const double motion = (x[node] - x_[node] - mean).norm() + farthest;
            if (start.closed || motion < start.distance) continue;
            const bool far = motion > reach * pair.finest(), lost = !start.found || sheet_lost(p, j, x);
            if (far || (lost && !speaks_by_normal(p, start))) slaves.push_back(j);
        }
        if (!slaves.empty()) follow(p, slaves, x, evidence);
    }
}

void CollisionCheck::add_edge_paths(std::size_t p, const Field& x, StepEvidence& evidence) const {
    const model::ContactPair& pair = contact_[p].pair();
    const std::vector<Vec3> v0 = pair.vertices(x_), v1 = pair.vertices(x);
    for (Index j = 0; j < pair.size(); ++j) {
        const contact::EdgesThatMeet& edge = pair.slaves().edges->meet[static_cast<std::size_t>(j)];
        const Start &start = starts_[p][j], &reverse = starts_[p][edge.reverse];
        if (edge.reverse < j || start.found || reverse.found) continue;
        const auto [a0, b0] = pair.edges(j, x_, v0);
        const auto [a1, b1] = pair.edges(j, x, v1);
        const auto passage = contact::first_passage(a0, b0, a1, b1);
        if (!passage) continue;
        const double least = allowed(p, pair.surface().half_edges()[static_cast<std::size_t>(edge.half_edge)].facet);
        if (passage->after >= -least) continue;
        const double fraction = passage->before >= least
                                    ? passage->time
                                    : limits_.reserve * reduction_factor(passage->before, passage->after, least);
        if (fraction >= evidence.collision) continue;
        evidence.collision = fraction;
        evidence.collision_pair = static_cast<Index>(p);
        evidence.collision_slave = j;
    }
}

void CollisionCheck::follow(std::size_t p, const std::vector<Index>& slaves, const Field& x, StepEvidence& evidence) {
    const ScopedTimer timer(timings_, Part::search);
    const model::ContactPair& pair = contact_[p].pair();
    const contact::MovingFacets facets(corners(pair.surface()), pair.vertices(x_), pair.vertices(x));
    const std::optional<model::OwnSurface>& own = pair.slaves().own;
    for (const Index j : slaves) {
        ++followed_;
        const auto tolerated = [&](Index facet) { // a node of the surface does not leave its own neighbourhood
            const bool near = own && std::ranges::binary_search(own->around[static_cast<std::size_t>(j)], facet);
            return near ? std::numeric_limits<double>::infinity() : allowed(p, facet);
        };
        const Index node = pair.slaves().node[j];
        const auto passage = facets.first_passage(x_[node], x[node], tolerated);
        if (!passage) continue;
        const contact::Crossing& entry = passage->entry;
        const contact::ContactPoint& point = contact_[p].point(j);
        if (!passage->left && point.found && point.normal.dot(entry.normal) > same_side) {
            // it ends behind facets of a sheet that it sees: what counts is the gap, that of a smooth surface perhaps
            const std::vector<Index> around = pair.surface().vertex_neighbours(entry.facet);
            const bool here = point.facet == entry.facet || std::ranges::count(around, point.facet) > 0;
            const bool told = starts_[p][j].found && !sheet_lost(p, j, x);
            if (here && (told || point.gap >= -tolerated(entry.facet))) continue;
        }
        // as (27) and (28): on to the surface, or from near it to what is allowed
        const double least = tolerated(entry.facet);
        const double fraction =
            entry.before >= least ? entry.time : limits_.reserve * reduction_factor(entry.before, entry.after, least);
        if (fraction >= evidence.collision) continue;
        evidence.collision = fraction;
        evidence.collision_pair = static_cast<Index>(p);
        evidence.collision_slave = j;
    }
}

} // namespace osculate::time
