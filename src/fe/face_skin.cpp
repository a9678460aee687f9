#include "osculate/fe/face_skin.hpp"

#include "fe/piece_points.hpp"
#include "osculate/fe/with_element.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace osculate::fe {
namespace {

/// int psi_c dA and int psi_c N_k dA over a piece of a face, c its corners, k the face's nodes.
struct PieceIntegrals {
    Eigen::VectorXd D;
    Eigen::MatrixXd P;
};

PieceIntegrals integrals(const mesh::SurfaceFace& face, const mesh::LocalFace& piece, const std::vector<Vec3>& X) {
    const Index n = piece.count;
    std::array<Vec3, 4> corner{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(n); ++c)
        corner[c] = X[static_cast<std::size_t>(face.nodes[static_cast<std::size_t>(piece.nodes[c])])];
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n), P = Eigen::MatrixXd::Zero(n, face.count);
    for (const PiecePoint& q : piece_points(face.shape(), piece)) {
        Vec3 a = Vec3::Zero(), b = Vec3::Zero();
        for (std::size_t c = 0; c < static_cast<std::size_t>(n); ++c) {
            a += q.by_s[c] * corner[c];
            b += q.by_t[c] * corner[c];
        }
        const double dA = q.weight * a.cross(b).norm();
        const Eigen::Map<const Eigen::VectorXd> phi(q.phi.data(), n), N(q.N.data(), face.count);
        M += dA * phi * phi.transpose();
        P += dA * phi * N.transpose();
    }
    PieceIntegrals result{M.rowwise().sum(), {}};
    result.P = result.D.asDiagonal() * M.inverse() * P; // psi = diag(D) M^-1 phi
    return result;
}

using Weights = std::map<Index, double>;

/// Adds share F d to a point, with the deformation gradient F at the centre of an element by its corners: dN_a/dX . d of
/// every corner a.
void add_turned(const mesh::ElementBlock& block, Index element, Index first_node, const std::vector<Vec3>& X,
                const Vec3& d, double share, Weights& point) {
    const mesh::CellInfo& info = mesh::cell_info(block.type);
    const Index* cell = &block.connectivity[static_cast<std::size_t>(element) * static_cast<std::size_t>(info.nodes)];
    with_element(mesh::without_midside_nodes(info).type, [&]<class E>() {
        Eigen::Matrix<double, 3, E::nodes> corner;
        for (int a = 0; a < E::nodes; ++a) corner.col(a) = X[static_cast<std::size_t>(cell[a] + first_node)];
        const auto dN = E::gradient(E::node_positions().rowwise().mean());
        const Mat3 J = corner * dN;
        const Vec3 along = share * J.inverse() * d;
        for (int a = 0; a < E::nodes; ++a) point[cell[a] + first_node] += dN.row(a).dot(along);
    });
}

} // namespace

std::vector<SkinWeights> skin_weights(const mesh::Mesh& mesh, const std::vector<mesh::Facet>& facets, Index first_node,
                                      const std::vector<Vec3>& X) {
    const std::vector<mesh::SurfaceFace> faces = mesh::surface_faces(mesh, facets, first_node);
    if (std::ranges::all_of(faces, [](const mesh::SurfaceFace& face) { return face.count == face.shape().corners; }))
        return {};
    std::map<Index, Weights> points;
    std::map<Index, double> areas;
    for (const mesh::SurfaceFace& face : faces)
        for (std::size_t k = 0; k < face.shape().pieces.size(); ++k) {
            if (!face.pieces[k]) continue;
            const mesh::LocalFace& piece = face.shape().pieces[k];
            const PieceIntegrals at = integrals(face, piece, X);
            for (Index c = 0; c < piece.count; ++c) {
                const Index node = face.nodes[static_cast<std::size_t>(piece.nodes[static_cast<std::size_t>(c)])];
                areas[node] += at.D(c);
                for (Index i = 0; i < face.count; ++i)
                    points[node][face.nodes[static_cast<std::size_t>(i)]] += at.P(c, i);
            }
        }
    std::map<Index, std::set<std::pair<Index, Index>>> elements;
    for (const mesh::Facet& facet : facets)
        for (const Index node : facet) elements[node].insert({facet.block, facet.element});

    constexpr double round_off = 1e-13;
    std::vector<SkinWeights> skin;
    for (auto& [node, point] : points) {
        const double area = areas[node];
        Vec3 d = X[static_cast<std::size_t>(node)];
        for (auto& [carrier, weight] : point) {
            weight /= area;
            d -= weight * X[static_cast<std::size_t>(carrier)];
        }
        if (d.norm() > round_off * (std::sqrt(area) + X[static_cast<std::size_t>(node)].norm()))
            for (const auto& [block, element] : elements[node])
                add_turned(mesh.blocks[static_cast<std::size_t>(block)], element, first_node, X, d,
                           1 / static_cast<double>(elements[node].size()), point);
        SkinWeights& one = skin.emplace_back(SkinWeights{node, {}});
        for (const auto& [carrier, weight] : point)
            if (carrier == node || std::abs(weight) > round_off) one.carriers.emplace_back(carrier, weight);
    }
    return skin;
}

} // namespace osculate::fe
