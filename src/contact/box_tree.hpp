#pragma once
/// Boost's R-tree over boxes with numbers.

#include "osculate/core/types.hpp"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <utility>

namespace osculate::contact {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Leaf = std::pair<Box, Index>;

inline Point to_point(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

} // namespace osculate::contact
