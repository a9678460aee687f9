#include "mesh/coincident_points.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace osculate::mesh {

std::vector<Index> first_at_place(const std::vector<Vec3>& points, const std::vector<char>& used, double tolerance) {
    std::vector<Index> first(points.size());
    std::iota(first.begin(), first.end(), 0);
    Eigen::AlignedBox3d box;
    for (std::size_t p = 0; p < points.size(); ++p)
        if (used[p]) box.extend(points[p]);
    if (box.isEmpty()) return first;
    const double near = tolerance * box.diagonal().norm();
    if (!(near > 0) || !std::isfinite(near)) return first;

    // Hash table of cubes, far larger than what is near: nearly every point looks into one of them.
    const double side = 16 * near;
    const std::size_t mask = std::bit_ceil(2 * points.size() + 1) - 1;
    std::vector<Index> head(mask + 1, -1), next(points.size(), -1);
    const auto slot = [&](const std::array<std::int64_t, 3>& cube) {
        std::uint64_t hash = 14695981039346656037ull;
        for (const std::int64_t c : cube) {
            hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ull;
            hash ^= hash >> 29;
        }
        return hash & mask;
    };
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (!used[p]) continue;
        const Vec3 x = (points[p] - box.min()) / side;
        std::array<std::int64_t, 3> own{}, low{}, high{};
        for (int d = 0; d < 3; ++d) {
            own[d] = static_cast<std::int64_t>(std::floor(x[d]));
            low[d] = static_cast<std::int64_t>(std::floor(x[d] - 1.0 / 16));
            high[d] = static_cast<std::int64_t>(std::floor(x[d] + 1.0 / 16));
        }
        Index found = -1;
        for (auto i = low[0]; i <= high[0]; ++i)
            for (auto j = low[1]; j <= high[1]; ++j)
                for (auto k = low[2]; k <= high[2]; ++k)
                    for (Index q = head[slot({i, j, k})]; q >= 0; q = next[q])
                        if ((found < 0 || q < found) && (points[q] - points[p]).norm() <= near) found = q;
        if (found >= 0) {
            first[p] = found;
            continue;
        }
        Index& top = head[slot(own)];
        next[p] = top;
        top = static_cast<Index>(p);
    }
    return first;
}

} // namespace osculate::mesh
