#include "mesh/face_cells.hpp"

#include "mesh/sort_few.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace osculate::mesh {
std::vector<FaceOfCell> faces_side_by_side(const std::vector<RawCell>& cells, std::size_t point_count) {
    const auto visit = [&](const auto& act) {
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const auto faces = cell_info(cells[c].type).faces;
            for (std::size_t f = 0; f < faces.size(); ++f) {
                FaceOfCell face{{-1, -1, -1, -1}, static_cast<Index>(c), static_cast<int>(f)};
                for (int i = 0; i < faces[f].count; ++i) face.corners[i] = cells[c].nodes[faces[f].nodes[i]];
                sort_few(face.corners.begin(), face.corners.begin() + faces[f].count);
                act(face);
            }
        }
    };
    // A counting sort by the lowest node, then a sort of the few faces of each.
    std::vector<std::size_t> start(point_count + 1, 0);
    visit([&](const FaceOfCell& face) { ++start[face.corners[0] + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<FaceOfCell> all(start.back());
    std::vector<std::size_t> place(start.begin(), start.end() - 1);
    visit([&](const FaceOfCell& face) { all[place[face.corners[0]]++] = face; });
    for (std::size_t n = 0; n < point_count; ++n)
        std::sort(all.begin() + static_cast<std::ptrdiff_t>(start[n]),
                  all.begin() + static_cast<std::ptrdiff_t>(start[n + 1]),
                  [](const FaceOfCell& a, const FaceOfCell& b) {
                      return std::tie(a.corners, a.cell, a.face) < std::tie(b.corners, b.cell, b.face);
                  });
    return all;
}

} // namespace osculate::mesh
