/// Contact geometry without scenes: points above a sphere of quadrilaterals, on its facets and on the smooth surface through
/// the same nodes.

#include <cmath>
#include <cstdio>
#include <osculate/contact/contact.hpp>

int main() {
    namespace contact = osculate::contact;
    using osculate::Index, osculate::Vec3;

    // a cap of radius 1 m, 10 x 10 facets
    constexpr Index n = 10;
    constexpr double half = 0.5;
    std::vector<Vec3> X;
    std::vector<osculate::mesh::Facet> facets;
    for (Index j = 0; j <= n; ++j)
        for (Index i = 0; i <= n; ++i)
            X.push_back(Vec3(half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), 1).normalized());
    for (Index j = 0; j < n; ++j)
        for (Index i = 0; i < n; ++i) {
            const Index first = j * (n + 1) + i;
            facets.push_back({.nodes = {first, first + 1, first + n + 2, first + n + 1}, .count = 4});
        }
    const osculate::mesh::HalfEdgeSurface mesh(facets, X);
    contact::FacetSearch search(mesh);
    search.build(X); // positions of the surface's vertices: here all nodes, in their order

    const auto smooth = contact::make_blend_surface(mesh, X, {});
    const auto flat = contact::make_facets_surface(mesh);
    double of_smooth = 0, of_facets = 0;
    for (int k = 0; k <= 20; ++k) { // points 1 cm above the sphere
        const Vec3 s = 1.01 * Vec3(0.03 * k - 0.3, 0.013 * k - 0.1, 1).normalized();
        const contact::FacetHit hit = search.global(s, X);
        for (const auto& [surface, worst] : {std::pair(smooth.get(), &of_smooth), std::pair(flat.get(), &of_facets)}) {
            contact::ContactPoint point;
            surface->evaluate(s, hit, X, point);
            if (!point.found) return 1;
            *worst = std::max(*worst, std::abs(point.gap - 0.01));
        }
    }
    std::printf("largest errors of gaps: %.1e m smooth, %.1e m on facets\n", of_smooth, of_facets);
    return of_smooth < 0.01 * of_facets ? 0 : 1;
}
