#include "position_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::bench {

namespace {

/// Normal of a facet times twice its area.
Vec3 area_normal(const mesh::HalfEdgeSurface& surface, Index facet, const std::vector<Vec3>& x) {
    const auto v = surface.facet_vertices(facet);
    const Vec3 &a = x[v[0]], &b = x[v[1]], &c = x[v[2]];
    return v.size() == 3 ? Vec3((b - a).cross(c - a)) : Vec3((c - a).cross(x[v[3]] - b));
}

} // namespace

std::array<int, 3> PositionCode::cell(const Vec3& p) const {
    std::array<int, 3> at{};
    for (int k = 0; k < 3; ++k) {
        const double place = std::floor((p(k) - low_(k)) / size_);
        at[k] = static_cast<int>(std::clamp(place, 0.0, cells_[k] - 1.0)); // points beyond the grid: its outermost cell
    }
    return at;
}

void PositionCode::build(const std::vector<Vec3>& x) {
    Vec3 high = low_ = x.front();
    for (const Vec3& p : x) {
        low_ = low_.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    size_ = surface_->mean_facet_size();
    for (int k = 0; k < 3; ++k) cells_[k] = 1 + static_cast<int>((high(k) - low_(k)) / size_);
    sorted_.resize(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) {
        const auto at = cell(x[v]);
        sorted_[v] = {code(at[0], at[1], at[2]), static_cast<Index>(v)};
    }
    std::sort(sorted_.begin(), sorted_.end(), [](const Entry& a, const Entry& b) {
        return a.code < b.code || (a.code == b.code && a.vertex < b.vertex);
    });
}

Index PositionCode::nearest_vertex(const Vec3& s, const std::vector<Vec3>& x) const {
    const auto centre = cell(s);
    double nearest = std::numeric_limits<double>::max(); // squared
    Index best = -1;
    // cells of a row along the first axis have consecutive codes: one binary search a row
    const auto row = [&](int first, int last, int j, int k) {
        if (j < 0 || j >= cells_[1] || k < 0 || k >= cells_[2]) return;
        first = std::max(first, 0), last = std::min(last, cells_[0] - 1);
        if (first > last) return;
        const std::uint64_t end = code(last, j, k);
        auto entry = std::lower_bound(sorted_.begin(), sorted_.end(), code(first, j, k),
                                      [](const Entry& e, std::uint64_t value) { return e.code < value; });
        for (; entry != sorted_.end() && entry->code <= end; ++entry) {
            const double distance = (x[entry->vertex] - s).squaredNorm();
            if (distance < nearest) nearest = distance, best = entry->vertex;
        }
    };
    const int widest = std::max({cells_[0], cells_[1], cells_[2]});
    for (int shell = 1; shell <= widest; ++shell) {
        const auto [i, j, k] = centre;
        for (int dk = -shell; dk <= shell; ++dk)
            for (int dj = -shell; dj <= shell; ++dj) {
                const bool face = std::abs(dk) == shell || std::abs(dj) == shell || shell == 1;
                if (face) {
                    row(i - shell, i + shell, j + dj, k + dk);
                } else {
                    row(i - shell, i - shell, j + dj, k + dk);
                    row(i + shell, i + shell, j + dj, k + dk);
                }
            }
        // vertices of further shells are at least so far off, whether s is in its cell or beyond the grid
        const double reached = shell * size_;
        if (best >= 0 && nearest <= reached * reached) break;
    }
    return best;
}

Index PositionCode::track(const Vec3& s, Index from, const std::vector<Vec3>& x) const {
    Index facet = from, before = -1;
    for (Index moves = 0; moves < surface_->facet_count(); ++moves) {
        const auto v = surface_->facet_vertices(facet);
        const auto across = surface_->edge_neighbours(facet);
        const Vec3 own = area_normal(*surface_, facet, x).normalized();
        double farthest = 0;
        Index next = -1;
        for (std::size_t c = 0; c < v.size(); ++c) {
            if (across[c] < 0) continue;
            const Vec3 &a = x[v[c]], along = x[v[(c + 1) % v.size()]] - a;
            const Vec3 between = own + area_normal(*surface_, across[c], x).normalized();
            const Vec3 out = along.cross(between);
            const double beyond = out.dot(s - a) / out.norm();
            if (beyond > farthest) farthest = beyond, next = across[c];
        }
        if (next < 0 || next == before) break; // inside, or back and forth above a fold
        before = facet;
        facet = next;
    }
    return facet;
}

Index PositionCode::global(const Vec3& s, const std::vector<Vec3>& x) const {
    return track(s, surface_->vertex_facets(nearest_vertex(s, x)).front(), x);
}

} // namespace osculate::bench
