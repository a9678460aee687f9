#include "osculate/contact/path_crossing.hpp"

#include "contact/box_tree.hpp"
#include "contact/cubic.hpp"

#include <algorithm>
#include <boost/geometry/geometries/segment.hpp>
#include <cmath>
#include <iterator>
#include <limits>

namespace osculate::contact {

namespace {
int count(const MovingFacets::Corners& facet) {
    return facet[3] < 0 ? 3 : 4;
}

} // namespace

struct MovingFacets::Tree {
    bgi::rtree<Leaf, bgi::rstar<16>> boxes;
};

MovingFacets::MovingFacets(std::vector<Corners> facets, const std::vector<Vec3>& x0, const std::vector<Vec3>& x1)
    : facets_(std::move(facets)), x0_(x0), x1_(x1), tree_(std::make_unique<Tree>()) {
    for (std::size_t i = 0; i < x0.size(); ++i) mean_ += (x1[i] - x0[i]) / static_cast<double>(x0.size());
    for (Vec3& x : x1_) x -= mean_;
    constexpr double margin = 1e-6; // of the box: more than round-off
    std::vector<Leaf> leaves;
    leaves.reserve(facets_.size());
    for (std::size_t f = 0; f < facets_.size(); ++f) {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
        for (int c = 0; c < count(facets_[f]); ++c)
            for (const auto* x : {&x0_, &x1_}) {
                const Vec3& v = (*x)[facets_[f][static_cast<std::size_t>(c)]];
                low = low.cwiseMin(v);
                high = high.cwiseMax(v);
            }
        const Vec3 wider = Vec3::Constant(margin * (high - low).norm());
        leaves.emplace_back(Box(to_point(low - wider), to_point(high + wider)), static_cast<Index>(f));
    }
    tree_->boxes = decltype(tree_->boxes)(leaves.begin(), leaves.end());
}

MovingFacets::~MovingFacets() = default;
MovingFacets::MovingFacets(MovingFacets&&) noexcept = default;
MovingFacets& MovingFacets::operator=(MovingFacets&&) noexcept = default;

void MovingFacets::cross(const Corners& triangle, Index facet, const Vec3& s0, const Vec3& s1,
                         std::vector<Crossing>& found) const {
    const auto at = [](const std::vector<Vec3>& x, Index v) { return x[static_cast<std::size_t>(v)]; };
    const auto [a, b, c, none] = triangle;
    const Vec3 a0 = at(x0_, a), e0 = s0 - a0, p0 = at(x0_, b) - a0, q0 = at(x0_, c) - a0;
    const Vec3 a1 = at(x1_, a), e1 = s1 - a1, p1 = at(x1_, b) - a1, q1 = at(x1_, c) - a1;
    const Cubic f = triple_product(e0, e1 - e0, p0, p1 - p0, q0, q1 - q0);
    const std::vector<double> ends = f.pieces();
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double from = f(ends[k]), to = f(ends[k + 1]);
        const bool inward = from > 0 && to <= 0, outward = from <= 0 && to > 0;
        if (!inward && !outward) continue;
        if (ends[k] == 0 && from == 0) continue; // starts on it
        Crossing crossing;
        crossing.time = f.root(ends[k], ends[k + 1]);
        const double t = crossing.time;
        const Vec3 e = e0 + t * (e1 - e0), p = p0 + t * (p1 - p0), q = q0 + t * (q1 - q0), n = p.cross(q);
        const double area = n.squaredNorm();
        if (area == 0) continue;
        constexpr double edge =
            1e-9; // shares of corners: a path through an edge meets both its facets rather than none
        const double u = e.cross(q).dot(n) / area, v = p.cross(e).dot(n) / area;
        if (u < -edge || v < -edge || u + v > 1 + edge) continue;
        crossing.facet = facet;
        crossing.inward = inward;
        crossing.normal = n / std::sqrt(area);
        crossing.before = p0.cross(q0).normalized().dot(e0);
        crossing.after = p1.cross(q1).normalized().dot(e1);
        found.push_back(crossing);
    }
}

std::vector<Crossing> MovingFacets::crossings(const Vec3& s0, const Vec3& s1) const {
    const Vec3 end = s1 - mean_;
    std::vector<Leaf> near;
    tree_->boxes.query(bgi::intersects(bg::model::segment<Point>(to_point(s0), to_point(end))),
                       std::back_inserter(near));
    std::vector<Crossing> found;
    for (const auto& [box, facet] : near) {
        const Corners& v = facets_[static_cast<std::size_t>(facet)];
        cross({v[0], v[1], v[2], -1}, facet, s0, end, found);
        if (v[3] >= 0) cross({v[0], v[2], v[3], -1}, facet, s0, end, found);
    }
    // entries before exits at the same time, but for round-off: to touch an edge from outside is in and out, not out and in
    const auto instant = [](double time) { return std::llround(1e9 * time); };
    std::sort(found.begin(), found.end(), [&](const Crossing& a, const Crossing& b) {
        if (instant(a.time) != instant(b.time)) return a.time < b.time;
        return a.inward != b.inward ? a.inward : a.facet < b.facet;
    });
    return found;
}

std::vector<double> thickness_behind(const std::vector<MovingFacets::Corners>& facets,
                                     const std::vector<MovingFacets::Corners>& exterior, const std::vector<Vec3>& X) {
    Vec3 low = X.front(), high = low;
    for (const Vec3& x : X) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    const double far = 2 * (high - low).norm();
    const MovingFacets body(exterior, X, X);
    std::vector<double> thickness;
    for (const MovingFacets::Corners& facet : facets) {
        const auto n = static_cast<std::size_t>(count(facet));
        Vec3 centre = Vec3::Zero(), area = Vec3::Zero();
        for (std::size_t c = 0; c < n; ++c) {
            const Vec3 &here = X[facet[c]], &next = X[facet[(c + 1) % n]];
            centre += here / static_cast<double>(n);
            area += (here - X[facet[0]]).cross(next - X[facet[0]]);
        }
        const Vec3 inward = -area.normalized();
        const double size = std::sqrt(0.5 * area.norm());
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c <= n; ++c) {
            constexpr double to_corner = 0.75, above = 1e-3; // fraction of the way; of the facet's size
            const Vec3 start = c < n ? Vec3(centre + to_corner * (X[facet[c]] - centre)) : centre;
            const Vec3 from = start - above * size * inward;
            for (const Crossing& crossing : body.crossings(from, from + far * inward)) {
                const double away = crossing.time * far - above * size;
                if (crossing.inward || away <= above * size) continue;
                least = std::min(least, away);
                break;
            }
        }
        thickness.push_back(least);
    }
    return thickness;
}

} // namespace osculate::contact
