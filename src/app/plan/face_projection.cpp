#include "app/plan/face_projection.hpp"

#include "osculate/core/error.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace osculate::app {

namespace {
/// Faces count by their part above the master if it determines their shape functions well.
constexpr double covered_face = 0.2, covered_linear_face = 1e-3;
/// Integrals of a shape function below this share of the area are zero but for curvature.
constexpr double no_share = 0.02;

std::array<Index, 4> ascending(std::array<Index, 4> nodes) {
    std::ranges::sort(nodes);
    return nodes;
}
} // namespace

FaceProjection::Pieces::Pieces(const std::vector<mesh::Facet>& facets, const std::vector<mesh::SurfaceFace>& all)
    : faces(all) {
    std::map<std::array<Index, 4>, std::size_t> face_of;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < faces[f].shape().pieces.size(); ++k) {
            if (!faces[f].pieces[k]) continue;
            const mesh::LocalFace& piece = faces[f].shape().pieces[k];
            std::array<Index, 4> nodes{-1, -1, -1, -1};
            for (std::size_t c = 0; c < static_cast<std::size_t>(piece.count); ++c)
                nodes[c] = faces[f].nodes[static_cast<std::size_t>(piece.nodes[c])];
            face_of.emplace(ascending(nodes), f);
        }
    for (const mesh::Facet& facet : facets) {
        std::array<Index, 4> nodes{-1, -1, -1, -1};
        std::copy(facet.begin(), facet.end(), nodes.begin());
        const auto found = face_of.find(ascending(nodes));
        if (found == face_of.end()) throw InternalError("a facet of a tie belongs to no face");
        face.push_back(found->second);
        const mesh::SurfaceFace& own = faces[found->second];
        Numbers& numbers = corner.emplace_back();
        for (std::size_t c = 0; c < static_cast<std::size_t>(facet.count); ++c)
            numbers[c] = static_cast<int>(std::find(own.begin(), own.end(), nodes[c]) - own.begin());
    }
}

Vector FaceProjection::Pieces::at(std::size_t facet, const contact::DualFunctions::Row4& phi,
                                  const std::vector<Vec3>& X) const {
    const mesh::SurfaceFace& own = faces[face[facet]];
    Vec2 place = Vec2::Zero();
    Vec3 x = Vec3::Zero();
    for (std::size_t c = 0; c < 4; ++c)
        if (const double share = phi(static_cast<Index>(c)); share != 0) {
            place += share * fe::natural_coordinates(own.shape(), corner[facet][c]);
            x += share * X[static_cast<std::size_t>(own.nodes[static_cast<std::size_t>(corner[facet][c])])];
        }
    fe::FacePoint at = fe::face_point(own, place, X);
    if (own.count == own.shape().corners) return Eigen::Map<const Vector>(at.N.data(), own.count);
    // the facet is plane and its coordinates are linear, the face is neither: its foot of x
    constexpr int most = 20;
    constexpr double round_off = 1e-14;
    for (int i = 0; i < most; ++i) {
        const Eigen::Matrix<double, 3, 2> tangents = (Eigen::Matrix<double, 3, 2>() << at.x_xi, at.x_eta).finished();
        const Vec2 step = (tangents.transpose() * tangents).inverse() * (tangents.transpose() * (x - at.x));
        place += step;
        at = fe::face_point(own, place, X);
        if (!(step.norm() > round_off)) break;
    }
    return Eigen::Map<const Vector>(at.N.data(), own.count);
}

FaceProjection::FaceProjection(const std::vector<mesh::Facet>& facets, const std::vector<mesh::SurfaceFace>& faces,
                               const std::vector<mesh::Facet>& master,
                               const std::vector<mesh::SurfaceFace>& master_faces, const std::vector<Vec3>& X)
    : X_(X), slave_(facets, faces), master_(master, master_faces) {
    for (const mesh::SurfaceFace& face : faces)
        sums_.push_back({Matrix::Zero(face.count, face.count), Vector::Zero(face.count), 0, 0, {}});
}

void FaceProjection::add(const contact::DualWeights& weights, Index facet) {
    const auto f = static_cast<std::size_t>(facet);
    Sum& sum = sums_[slave_.face[f]];
    sum.area += weights.area(facet);
    weights.for_each_point(facet, [&](Index over, double area, const contact::DualFunctions::Row4& phi,
                                      const contact::DualFunctions::Row4& of_master) {
        const auto g = static_cast<std::size_t>(over);
        const Vector N = slave_.at(f, phi, X_), N_master = master_.at(g, of_master, X_);
        sum.M += area * N * N.transpose();
        sum.w += area * N;
        sum.covered += area;
        const mesh::SurfaceFace& face = master_.faces[master_.face[g]];
        for (Index i = 0; i < N_master.size(); ++i) {
            const auto [P, fresh] = sum.P.try_emplace(face.nodes[static_cast<std::size_t>(i)], Vector::Zero(N.size()));
            P->second += area * N_master(i) * N;
        }
    });
}

std::map<Index, std::map<Index, double>> FaceProjection::weights() const {
    struct Share {
        std::size_t face;
        Index number;
        double w, area;
    };
    std::map<Index, std::vector<Share>> shares;
    std::vector<Eigen::LDLT<Matrix>> solve(sums_.size());
    for (std::size_t f = 0; f < sums_.size(); ++f) {
        const Sum& sum = sums_[f];
        const mesh::SurfaceFace& face = slave_.faces[f];
        const bool linear = face.count == face.shape().corners;
        if (!(sum.covered > (linear ? covered_linear_face : covered_face) * sum.area)) continue;
        solve[f].compute(sum.M);
        for (Index k = 0; k < sum.w.size(); ++k) {
            const bool none = std::abs(sum.w(k)) < no_share * sum.covered;
            shares[face.nodes[static_cast<std::size_t>(k)]].push_back({f, k, none ? 0 : sum.w(k), sum.covered});
        }
    }
    std::map<Index, std::map<Index, double>> result;
    for (const auto& [node, own] : shares) {
        const bool positive = std::ranges::any_of(own, [](const Share&s) { return s.w > 0; }),
                   negative = std::ranges::any_of(own, [](const Share&s) { return s.w < 0; });
        const bool by_w = positive != negative;
        std::map<Index, double>& at = result[node];
        double all = 0;
        for (const Share& share : own) {
            const double w = by_w ? share.w : share.area;
            if (w == 0) continue;
            // row k of M^-1 P
            const Vector row = solve[share.face].solve(Vector::Unit(sums_[share.face].w.size(), share.number));
            for (const auto& [master, P] : sums_[share.face].P) at[master] += w * row.dot(P);
            all += w;
        }
        for (auto& [master, weight] : at) weight /= all;
    }
    return result;
}

} // namespace osculate::app
