/// Facets that are near each other, against a search of all pairs.

#include "osculate/contact/near_facets.hpp"

#include "osculate/mesh/generators.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

struct Cloud {
    std::vector<mesh::Facet> facets;
    std::vector<Index> group;
    std::vector<double> margin;
    std::vector<Vec3> x;
};

/// The surfaces of two balls, one block and what lies between them, with margins of all sizes.
Cloud cloud() {
    Cloud all;
    Index group = 0;
    const auto add = [&](const mesh::Mesh& m, const Vec3& by) {
        const auto first = static_cast<Index>(all.x.size());
        for (const Vec3& X : m.nodes) all.x.push_back(X + by);
        for (mesh::Facet facet : mesh::exterior_facets(m)) {
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += first;
            all.facets.push_back(facet);
            all.group.push_back(group);
            all.margin.push_back(0.02 * static_cast<double>(1 + all.facets.size() % 7) + 1e-4);
        }
        group = (group + 2) % 3; // not in the order of the facets
    };
    add(mesh::make_ball(1, {4, 2, 4}), {0, 0, 0});
    add(mesh::make_ball(1, {4, 2, 4}), {2.05, 0.3, 0});
    add(mesh::make_block({-1, -1, -1.6}, {4, 2, 0.5}, {5, 3, 1}), {0, 0, 0});
    return all;
}

TEST(NearFacets, AreThoseWhoseBoxesOverlap) {
    const Cloud all = cloud();
    const auto overlap = [&](std::size_t f, std::size_t g) {
        Eigen::AlignedBox3d a, b;
        for (const Index node : all.facets[f]) a.extend(all.x[node]);
        for (const Index node : all.facets[g]) b.extend(all.x[node]);
        const Vec3 apart = (a.min() - b.max()).cwiseMax(b.min() - a.max());
        return apart.maxCoeff() <= all.margin[f] + all.margin[g];
    };
    const auto wanted = [](Index f, Index g) { return (f + g) % 3 != 0; };
    const auto meet = [](Index a, Index b) { return a != 0 || b != 1; };
    std::vector<std::pair<Index, Index>> expected;
    for (std::size_t f = 0; f < all.facets.size(); ++f)
        for (std::size_t g = f + 1; g < all.facets.size(); ++g)
            if (wanted(static_cast<Index>(f), static_cast<Index>(g)) && overlap(f, g) &&
                meet(std::min(all.group[f], all.group[g]), std::max(all.group[f], all.group[g])))
                expected.emplace_back(f, g);
    EXPECT_GT(expected.size(), 100U);
    EXPECT_EQ(near_facets(all.facets, all.group, all.margin, all.x, meet, wanted), expected);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
