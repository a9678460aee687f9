#pragma once
/// Shape functions and points of slave facets, and lists of vertices, as mortar weighting needs them.

#include "osculate/contact/surface_patch.hpp"

#include <algorithm>
#include <vector>

namespace osculate::contact {

struct Shape {
    Eigen::Matrix<double, 4, 1> N = Eigen::Matrix<double, 4, 1>::Zero();
    Eigen::Matrix<double, 4, 2> N_a = Eigen::Matrix<double, 4, 2>::Zero();
};

/// Of a triangle or a quadrilateral, see FacetPatch; rows beyond its corners are zero.
[[nodiscard]] Shape shape(int corners, const Vec2& u);

struct RulePoint {
    Vec2 xi;
    double weight;
};

/// Square: n x n Gauss points. Triangle: cut into n^2 equal ones with three points each. Both keep the facet's symmetries.
[[nodiscard]] std::vector<RulePoint> facet_rule(int corners, int n);

/// Position of a vertex in an ascending list that has it.
[[nodiscard]] inline Index place_in(const std::vector<Index>& list, Index vertex) {
    return static_cast<Index>(std::lower_bound(list.begin(), list.end(), vertex) - list.begin());
}

inline void sort_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

} // namespace osculate::contact
