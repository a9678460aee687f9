#include "gmsh/contact_size.hpp"

#include "osculate/mesh/triangle.hpp"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>

namespace osculate::mesh {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;

struct ContactSize::Tree {
    using Point = bg::model::point<double, 3, bg::cs::cartesian>;
    using Leaf = std::pair<bg::model::box<Point>, std::size_t>;

    static Point to_point(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

    std::vector<Triangle> triangles;
    bgi::rtree<Leaf, bgi::rstar<16>> leaves;
};

ContactSize::ContactSize(const CadContact& contact, const std::vector<std::array<Vec3, 3>>& triangles)
    : contact_(contact), tree_(std::make_unique<Tree>()) {
    std::vector<Tree::Leaf> leaves;
    for (const auto& [a, b, c] : triangles) {
        const Triangle& one = tree_->triangles.emplace_back(Triangle{a, b, c});
        area_ += one.normal().norm() / 2;
        leaves.push_back(
            {{Tree::to_point(a.cwiseMin(b).cwiseMin(c)), Tree::to_point(a.cwiseMax(b).cwiseMax(c))}, leaves.size()});
    }
    tree_->leaves = decltype(tree_->leaves)(leaves.begin(), leaves.end());
}

ContactSize::~ContactSize() = default;

double ContactSize::at(const Vec3& x, double largest) const {
    if (largest <= contact_.size || contact_.growth <= 1) return std::min(largest, contact_.size);
    double least =
        (largest - contact_.size) / (contact_.growth - 1); // farther away, elements are as large as they may be
    const Tree::Point p = Tree::to_point(x);
    const auto all = static_cast<unsigned>(tree_->triangles.size());
    for (auto leaf = tree_->leaves.qbegin(bgi::nearest(p, all)); leaf != tree_->leaves.qend();
         ++leaf) { // nearest boxes first
        if (!(bg::distance(p, leaf->first) < least)) break;
        least = std::min(least, (x - tree_->triangles[leaf->second].closest(x)).norm());
    }
    return contact_.size + (contact_.growth - 1) * least;
}

double ContactSize::cubes(double volume) const {
    const double whole = volume / std::pow(contact_.size, 3);
    if (contact_.growth <= 1) return whole;
    // layers of thickness and edge length size growth^k
    return std::min(whole, area_ / std::pow(contact_.size, 2) / (1 - std::pow(contact_.growth, -2)));
}

} // namespace osculate::mesh
