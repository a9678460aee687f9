#pragma once
/// The paper's search, to be timed beside the one in use.

#include "osculate/contact/search.hpp"

#include <cstdint>
#include <vector>

namespace osculate::bench {

/// Position code and inside-outside test over one surface.                        [Qian 2014, secs 3.1, 4.1, 4.2]
/// Space is cut into cubic cells; a vertex has the number of its cell as its code, and vertices are sorted by it. The global
/// search takes the nearest vertex in the cells around the point and goes on from a facet of its fan; both searches walk
/// across the edge that the point is farthest beyond, until it is inside the temporary contact facet. The plane between
/// two facets goes through their edge and halves the angle between them, so a point is inside one of the two, not both.
class PositionCode {
public:
    explicit PositionCode(const mesh::HalfEdgeSurface& surface) : surface_(&surface) {}

    /// Codes of all vertices at x, sorted. O(n log n)
    void build(const std::vector<Vec3>& x);

    /// Vertex nearest to s; shells of cells around that of s until the next can hold no nearer one.
    /// @pre build() was called at these positions
    [[nodiscard]] Index nearest_vertex(const Vec3& s, const std::vector<Vec3>& x) const;
    /// Temporary contact facet of s, looked for over the whole surface.
    [[nodiscard]] Index global(const Vec3& s, const std::vector<Vec3>& x) const;
    /// Temporary contact facet of s, near `from`. Build is not needed.
    [[nodiscard]] Index track(const Vec3& s, Index from, const std::vector<Vec3>& x) const;

private:
    struct Entry {
        std::uint64_t code;
        Index vertex;
    };
    [[nodiscard]] std::uint64_t code(int i, int j, int k) const {
        return (static_cast<std::uint64_t>(k) * cells_[1] + j) * cells_[0] + i;
    }
    [[nodiscard]] std::array<int, 3> cell(const Vec3& p) const;

    const mesh::HalfEdgeSurface* surface_;
    Vec3 low_ = Vec3::Zero();
    double size_ = 1;
    std::array<int, 3> cells_{1, 1, 1};
    std::vector<Entry> sorted_;
};

} // namespace osculate::bench
