#include "app/plan/load_spread.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <Eigen/Geometry>
#include <map>

namespace osculate::app {

LoadSpread::LoadSpread(const std::vector<mesh::SurfaceFace>& faces, const std::vector<Index>& nodes,
                       const std::vector<Vec3>& X, const Vec3* point) {
    std::map<Index, Share> shares;
    const auto place = [&](Index node) -> const Vec3& { return X[static_cast<std::size_t>(node)]; };
    const auto share = [&](Index node) -> Share& {
        Share& one = shares[node];
        one.node = node;
        return one;
    };
    std::vector<Matrix> products;
    for (const mesh::SurfaceFace& face : faces) {
        products.push_back(fe::shape_products(face, X));
        for (Index i = 0; i < products.back().rows(); ++i)
            share(face.nodes[static_cast<std::size_t>(i)]).weight += products.back().row(i).sum();
    }
    if (faces.empty())
        for (const Index node : nodes) share(node).weight = 1;
    Vec3 centre = Vec3::Zero();
    for (const auto& [node, one] : shares) {
        sum_ += one.weight;
        centre += one.weight * place(node);
    }
    centre /= sum_;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (Index i = 0; i < products[f].rows(); ++i)
            for (Index j = 0; j < products[f].cols(); ++j)
                share(faces[f].nodes[static_cast<std::size_t>(i)]).first +=
                    products[f](i, j) * (place(faces[f].nodes[static_cast<std::size_t>(j)]) - centre);
    Mat3 second = Mat3::Zero(); // sum of r r^T
    for (auto& [node, one] : shares) {
        if (faces.empty()) one.first = place(node) - centre;
        second += one.first * (place(node) - centre).transpose();
    }
    constexpr double line = 1e-10; // of second moments: a part of 1e-5 across
    const auto [extent, axes] = principal_axes(0.5 * (second + second.transpose()));
    spatial_ = extent(2) > 0 && extent(1) > line * extent(2);
    if (spatial_)
        inverse_ = (extent.sum() * Mat3::Identity() - axes * extent.asDiagonal() * axes.transpose()).inverse();
    if (point != nullptr) arm_ = *point - centre;
    for (const auto& [node, one] : shares) shares_.push_back(one);
}

void LoadSpread::add(const Vec3& force, const Vec3& moment, Field& forces) const {
    const Vec3 turn = inverse_ * (moment + arm_.cross(force));
    for (const Share& one : shares_)
        forces[static_cast<std::size_t>(one.node)] += one.weight / sum_ * force + turn.cross(one.first);
}

} // namespace osculate::app
