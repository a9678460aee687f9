#pragma once
/// A pair of surfaces without bodies around them, for tests of discretisations.

#include "contact/surfaces.hpp"
#include "osculate/contact/dual_weights.hpp"

#include <gtest/gtest.h>
#include <map>

namespace osculate::contact::fixtures {

/// Underside of a block above z = 0, as slave facets with their own numbering.
struct Slave {
    std::vector<SlaveFacet> facets;
    std::vector<Vec3> X;
    std::vector<double> area; ///< consistent forces of a unit pressure

    Slave(const Vec3& origin, const Vec3& size, std::array<int, 2> n, mesh::BlockPattern pattern) {
        const mesh::Mesh mesh = mesh::make_block(origin, size, {n[0], n[1], 1}, mesh::CellType::hex8, pattern);
        std::map<Index, Index> number;
        for (const mesh::Facet& facet : mesh.surfaces.at("z_min")) {
            SlaveFacet& own = facets.emplace_back();
            own.count = facet.count;
            for (int c = 0; c < facet.count; ++c) {
                const auto [at, fresh] = number.try_emplace(facet.nodes[c], static_cast<Index>(X.size()));
                if (fresh) X.push_back(mesh.nodes[facet.nodes[c]]);
                own.node[c] = at->second;
            }
        }
        area.assign(X.size(), 0.0);
        for (const SlaveFacet& facet : facets) { // parallelograms and triangles: equal shares
            std::vector<Vec3> corner;
            for (const Index k : facet) corner.push_back(X[k]);
            for (const Index k : facet) area[k] += SlavePlane(corner).area() / facet.count;
        }
    }
};

/// A discretisation evaluated at its reference positions, or at others.
struct Pairing {
    const Surface& master;
    std::unique_ptr<MasterSurface> shape;
    Slave slave;
    std::unique_ptr<Discretisation> discretisation;
    FacetSearch search;
    FacetTracking tracking;
    std::vector<ContactPoint> points;

    /// @param make  the discretisation for slave facets and slave nodes
    template <class Make>
    Pairing(const Surface& surface, std::unique_ptr<MasterSurface> geometry, Slave above, const Make& make)
        : master(surface), shape(std::move(geometry)), slave(std::move(above)), discretisation(make(slave)),
          search(surface.topology), points(slave.X.size()) {
        search.build(master.x);
        tracking.changes_before_latch = 4;
        tracking.changes.assign(slave.X.size(), 0);
        for (const Vec3& s : slave.X) {
            tracking.hits.push_back(search.global(s, master.x));
            tracking.facet.push_back(tracking.hits.back().facet);
        }
        evaluate(slave.X, master.x);
    }
    [[nodiscard]] PairPositions at(const std::vector<Vec3>& s, const std::vector<Vec3>& x) const {
        return {*shape, search, s, x};
    }
    void evaluate(const std::vector<Vec3>& s, const std::vector<Vec3>& x) {
        discretisation->begin(at(s, x), tracking, 1);
        move(s, x);
    }
    /// Evaluates other positions of the same attempt.
    void move(const std::vector<Vec3>& s, const std::vector<Vec3>& x) {
        (void)discretisation->evaluate(at(s, x), tracking, points, 1);
    }
    [[nodiscard]] Index carriers(Index j) const {
        return discretisation->carriers(j, points[static_cast<std::size_t>(j)]);
    }
};

/// Expects that vary() of slave j is the difference of the points around slaves at s, vertices at x.
/// @param every  of the nodes on which the point depends is tried: evaluating the whole pairing takes its time
inline void expect_variations(Pairing& pairing, const std::vector<Vec3>& s, const std::vector<Vec3>& x, Index j,
                              std::size_t every = 5) {
    pairing.evaluate(s, x);
    pairing.discretisation->prepare_variations(pairing.at(s, x), std::vector<char>(s.size(), 1), 1);
    const Index V = pairing.master.topology.vertex_count();
    ContactVariation variation;
    const ContactPoint point = pairing.points[j];
    ASSERT_TRUE(point.found) << j;
    pairing.discretisation->vary(j, pairing.at(s, x), pairing.tracking.hits[j], point, variation);
    std::vector<Index> nodes{V + j};
    nodes.insert(nodes.end(), point.nodes.begin(), point.nodes.end());
    const Index carried = pairing.carriers(j);
    constexpr double h = 1e-5, truncation = 1e-7; // h^2 over the facets' size, round-off / h
    for (std::size_t k = 0; k < nodes.size(); k += every)
        for (int c = 0; c < 3; ++c) {
            std::array<ContactPoint, 2> moved;
            for (const int side : {0, 1}) {
                auto moved_s = s, moved_x = x;
                (nodes[k] < V ? moved_x[nodes[k]] : moved_s[nodes[k] - V])(c) += side == 0 ? h : -h;
                pairing.move(moved_s, moved_x);
                moved[static_cast<std::size_t>(side)] = pairing.points[j];
            }
            const auto column = 3 * static_cast<Index>(k) + c;
            EXPECT_NEAR((moved[0].gap - moved[1].gap) / (2 * h), variation.dg(column), truncation);
            EXPECT_LT(((moved[0].normal - moved[1].normal) / (2 * h) - variation.dn.col(column)).norm(),
                      truncation * 100); // curvatures of shaken patches are large
            ASSERT_EQ(pairing.carriers(j), carried);
            const Vector dweights = column < variation.dweights.cols() ? Vector(variation.dweights.col(column))
                                                                       : Vector(Vector::Zero(carried));
            EXPECT_LT(((moved[0].weights - moved[1].weights).head(carried) / (2 * h) - dweights).cwiseAbs().maxCoeff(),
                      truncation * 10);
        }
}

} // namespace osculate::contact::fixtures
