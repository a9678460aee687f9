#include "mesh/o_grid.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace osculate::mesh {
namespace {

using Point = std::array<int, 4>; ///< i, j, k, l

class Builder {
public:
    explicit Builder(const OGrid& grid) : grid_(grid) {}

    Mesh run() {
        add_core();
        for (int side = 0; side < 6; ++side)
            if (grid_.grown[static_cast<std::size_t>(side)]) add_layers(side);
        for (const auto& [point, index] : index_of_) {
            mesh_.nodes[index] = grid_.position(point[0], point[1], point[2], point[3]);
            point_of_[index] = point;
        }
        mesh_.blocks.push_back(std::move(hexes_));
        name_surfaces();
        return std::move(mesh_);
    }

private:
    Index node(const Point& point) {
        const auto [found, added] = index_of_.emplace(point, mesh_.node_count());
        if (added) {
            mesh_.nodes.emplace_back();
            point_of_.emplace_back();
        }
        return found->second;
    }

    void add_core() {
        const auto& n = grid_.core;
        for (int k = 0; k < n[2]; ++k)
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i)
                    for (int up = 0; up < 2; ++up)
                        for (const auto& [a, b] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                            hexes_.connectivity.push_back(node({i + a, j + b, k + up, 0}));
    }

    void add_layers(int side) {
        const int d = side / 2;
        const bool high = side % 2 != 0;
        // p, q and the outward direction are right-handed
        const int p = high ? (d + 1) % 3 : (d + 2) % 3, q = high ? (d + 2) % 3 : (d + 1) % 3;
        for (int l = 0; l < grid_.layers; ++l)
            for (int b = 0; b < grid_.core[q]; ++b)
                for (int a = 0; a < grid_.core[p]; ++a)
                    for (int out = 0; out < 2; ++out)
                        for (const auto& [da, db] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                            Point point{};
                            point[d] = high ? grid_.core[d] : 0;
                            point[p] = a + da;
                            point[q] = b + db;
                            point[3] = l + out;
                            hexes_.connectivity.push_back(node(point));
                        }
    }

    void name_surfaces() {
        for (const Facet& facet : exterior_facets(mesh_)) {
            const auto all = [&](int d, int value) {
                return std::all_of(facet.begin(), facet.end(), [&](Index n) { return point_of_[n][d] == value; });
            };
            const char* name = all(3, grid_.layers) ? "outer" : nullptr;
            for (int side = 0; side < 6 && name == nullptr; ++side)
                if (!grid_.grown[side] && all(side / 2, side % 2 != 0 ? grid_.core[side / 2] : 0))
                    name = grid_.sides[side];
            mesh_.surfaces[name].push_back(facet);
        }
    }

    const OGrid& grid_;
    Mesh mesh_;
    ElementBlock hexes_{CellType::hex8, {}};
    std::map<Point, Index> index_of_;
    std::vector<Point> point_of_;
};

} // namespace

Mesh mesh_o_grid(const OGrid& grid) {
    const auto& n = grid.core;
    if (std::min({n[0], n[1], n[2], grid.layers}) < 1) throw std::invalid_argument("divisions must be 1 or more");
    // in floating point products cannot overflow; the connectivity of the hexahedra is the largest array
    const double sides = (n[0] + 1.0) * (n[1] + 1.0) + (n[1] + 1.0) * (n[2] + 1.0) + (n[2] + 1.0) * (n[0] + 1.0);
    if (8 * ((n[0] + 1.0) * (n[1] + 1.0) * (n[2] + 1.0) + 2 * sides * grid.layers) > std::numeric_limits<Index>::max())
        throw std::invalid_argument("too many divisions: the mesh cannot be numbered");
    return Builder(grid).run();
}

} // namespace osculate::mesh
