#include "osculate/mesh/quality.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

namespace osculate::mesh {
namespace {

double triple(const Vec3& a, const Vec3& b, const Vec3& c) {
    return a.cross(b).dot(c);
}

class FaultList {
public:
    explicit FaultList(std::size_t limit) : limit_(limit) {}

    void add(std::string fault) {
        if (faults_.size() < limit_) faults_.push_back(std::move(fault));
        ++count_;
    }

    [[nodiscard]] std::vector<std::string> finish() {
        if (count_ > faults_.size()) faults_.push_back("and " + std::to_string(count_ - faults_.size()) + " more");
        return std::move(faults_);
    }

private:
    std::size_t limit_, count_ = 0;
    std::vector<std::string> faults_;
};

/// Jacobian of a tet10 at the point with barycentric coordinates L, from the derivatives
/// dx/dL_k = (4 L_k - 1) x_k + 4 sum_l L_l m_kl, m_kl the node midway between corners k and l.
double tet10_jacobian(std::span<const Index> nodes, const std::vector<Vec3>& positions,
                      const std::array<double, 4>& L) {
    constexpr int mid[4][4] = {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}};
    std::array<Vec3, 4> dL;
    for (int k = 0; k < 4; ++k) {
        dL[k] = (4 * L[k] - 1) * positions[nodes[k]];
        for (int l = 0; l < 4; ++l)
            if (l != k) dL[k] += 4 * L[l] * positions[nodes[mid[k][l]]];
    }
    return triple(dL[1] - dL[0], dL[2] - dL[0], dL[3] - dL[0]);
}

/// First node of a tet10 with a Jacobian that is not positive (NaN included), or -1.
int bad_tet10_node(std::span<const Index> nodes, const std::vector<Vec3>& positions) {
    constexpr int ends[10][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (int a = 0; a < 10; ++a) {
        std::array<double, 4> L{};
        for (const int end : ends[a]) L[end] += 0.5;
        if (!(tet10_jacobian(nodes, positions, L) > 0)) return a;
    }
    return -1;
}

} // namespace

int bad_corner(CellType type, std::span<const Index> nodes, const std::vector<Vec3>& positions) {
    if (type == CellType::tet10) return bad_tet10_node(nodes, positions);
    const CellInfo& info = cell_info(type);
    const auto corners = info.corner_neighbours;
    for (int c = 0; c < static_cast<int>(corners.size()); ++c) {
        // the tangent of an edge at the corner, if it has a midside node that of the parabola through its three nodes
        const auto edge = [&](int i) -> Vec3 {
            const Vec3 &from = positions[nodes[c]], &to = positions[nodes[corners[c][i]]];
            const int middle = info.midway(c, corners[c][i]);
            return middle < 0 ? Vec3(to - from) : Vec3(4 * positions[nodes[middle]] - 3 * from - to);
        };
        if (!(triple(edge(0), edge(1), edge(2)) > 0)) return c;
    }
    return -1;
}

double cell_volume(CellType type, std::span<const Index> nodes, const std::vector<Vec3>& positions) {
    // Divergence theorem about the first node. A bilinear face encloses the mean of its two splits into triangles.
    const Vec3& origin = positions[nodes[0]];
    double sixfold = 0;
    for (const LocalFace& face : cell_info(type).facets) {
        const auto at = [&](int i) -> Vec3 { return positions[nodes[face.nodes[i]]] - origin; };
        if (face.count == 3)
            sixfold += triple(at(0), at(1), at(2));
        else
            sixfold += 0.5 * (triple(at(0), at(1), at(2)) + triple(at(0), at(2), at(3)) + triple(at(0), at(1), at(3)) +
                              triple(at(1), at(2), at(3)));
    }
    return sixfold / 6;
}

std::vector<std::string> faults(const Mesh& mesh, std::size_t limit) {
    FaultList list(limit);
    for (Index n = 0; n < mesh.node_count(); ++n)
        if (!mesh.nodes[n].allFinite()) list.add("node " + std::to_string(n) + ": position is not finite");

    std::vector<char> used(mesh.nodes.size(), 0);
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        const ElementBlock& block = mesh.blocks[b];
        const auto stride = static_cast<std::size_t>(nodes_per_cell(block.type));
        for (Index e = 0; e < block.size(); ++e) {
            const std::span<const Index> nodes(block.connectivity.data() + e * stride, stride);
            const auto name = [&] {
                return std::string(cell_info(block.type).name) + " element " + std::to_string(e) + " of block " +
                       std::to_string(b);
            };
            if (std::any_of(nodes.begin(), nodes.end(), [&](Index n) { return n < 0 || n >= mesh.node_count(); })) {
                list.add(name() + ": a node number is out of range");
                continue;
            }
            for (const Index n : nodes) used[n] = 1;
            if (!std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return mesh.nodes[n].allFinite(); })) continue;
            if (const int corner = bad_corner(block.type, nodes, mesh.nodes); corner >= 0)
                list.add(name() + ": Jacobian is not positive at node " + std::to_string(nodes[corner]));
        }
    }
    for (Index n = 0; n < mesh.node_count(); ++n)
        if (!used[n]) list.add("node " + std::to_string(n) + ": no element uses it");
    return list.finish();
}

} // namespace osculate::mesh
