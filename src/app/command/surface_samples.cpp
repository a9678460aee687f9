#include "app/command/surface_samples.hpp"

#include "osculate/contact/facet_patch.hpp"
#include "osculate/core/parallel.hpp"

#include <cmath>

namespace osculate::app {

FacetGrid::FacetGrid(int corners, int N) : corners_(corners), N_(N) {
    const auto cell = [&](std::array<Index, 4> nodes) { cells_.push_back({nodes, nodes[3] < 0 ? 3 : 4, -1, -1}); };
    for (int j = 0; j <= N; ++j)
        for (int i = 0; i <= (corners == 3 ? N - j : N); ++i) {
            const Vec2 u(static_cast<double>(i) / N, static_cast<double>(j) / N);
            points_.push_back(corners == 3 ? u : Vec2(2 * u - Vec2::Ones()));
            if (corners == 4 && i < N && j < N) cell({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            if (corners == 3 && i + j < N) cell({at(i, j), at(i + 1, j), at(i, j + 1), -1});
            if (corners == 3 && i + j < N - 1) cell({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), -1});
        }
}

Index FacetGrid::at(int i, int j) const {
    return corners_ == 3 ? j * (N_ + 1) - j * (j - 1) / 2 + i : j * (N_ + 1) + i;
}

Index FacetGrid::on_edge(int edge, int k) const {
    if (corners_ == 3) return edge == 0 ? at(k, 0) : edge == 1 ? at(N_ - k, k) : at(0, N_ - k);
    return edge == 0 ? at(k, 0) : edge == 1 ? at(N_, k) : edge == 2 ? at(N_ - k, N_) : at(0, N_ - k);
}

namespace {

/// Samples one facet after another; scratch is kept from sample to sample.
class Sampler {
public:
    Sampler(const mesh::HalfEdgeSurface& surface, const contact::MasterSurface& master, const std::vector<Vec3>& x)
        : surface_(surface), master_(master), x_(x), search_(surface) {}

    SurfaceSample sample(Index facet, const Vec3& q, const Vec3& facet_normal) {
        constexpr int most_iterations = 20;
        constexpr double target = 1e-12; // of the facet size
        constexpr double enough = 1e-6;  // of the facet size: what a picture would show, far above round-off
        const double size = surface_.facet_size(facet);
        SurfaceSample sample;
        sample.position = q;
        sample.normal = facet_normal;
        Vec3 s = q;
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            if (!evaluate(facet, s)) return sample;
            if (std::abs(point_.gap) < target * size) break;
            s -= point_.gap * point_.normal;
        }
        if (!evaluate(facet, s, &variation_) || std::abs(point_.gap) > enough * size) return sample;
        sample.found = true;
        sample.position = s;
        sample.normal = point_.normal;
        sample.distance = std::copysign(search_.closest_on(facet, s, x_).distance, (s - q).dot(point_.normal));
        sample.nodes = static_cast<Index>(point_.nodes.size());
        // shape operator: the variation of the normal with s, in the tangent plane
        contact::Matrix32 tangents;
        tangents.col(0) = point_.normal.unitOrthogonal();
        tangents.col(1) = point_.normal.cross(tangents.col(0));
        const Mat2 shape = tangents.transpose() * variation_.dn.leftCols<3>() * tangents;
        sample.mean_curvature = shape.trace() / 2;
        sample.gauss_curvature = shape.determinant();
        return sample;
    }

private:
    bool evaluate(Index facet, const Vec3& s, contact::ContactVariation* variation = nullptr) {
        master_.evaluate(s, search_.closest_on(facet, s, x_), x_, point_, variation);
        return point_.found;
    }

    const mesh::HalfEdgeSurface& surface_;
    const contact::MasterSurface& master_;
    const std::vector<Vec3>& x_;
    contact::FacetSearch search_;
    contact::ContactPoint point_;
    contact::ContactVariation variation_;
};

} // namespace

SurfaceSamples sample_surface(const mesh::HalfEdgeSurface& surface, const contact::MasterSurface& master,
                              const std::vector<Vec3>& x, int N, int threads) {
    SurfaceSamples result{{3, N}, {4, N}, {0}, {}};
    for (const mesh::Facet& facet : surface.facets())
        result.first.push_back(result.first.back() + result.grid(facet.count).size());
    result.samples.resize(static_cast<std::size_t>(result.first.back()));
    parallel_for(threads, surface.facet_count(), [&](Index begin, Index end) {
        Sampler sampler(surface, master, x);
        for (Index f = begin; f < end; ++f) {
            const auto vertices = surface.facet_vertices(f);
            const contact::FacetPatch patch(static_cast<int>(vertices.size()));
            contact::MatrixX3 corners(patch.size(), 3);
            for (Index c = 0; c < patch.size(); ++c) corners.row(c) = x[vertices[c]].transpose();
            const std::vector<Vec2>& points = result.grid(patch.size()).points();
            for (std::size_t k = 0; k < points.size(); ++k) {
                const contact::PatchPoint on_facet = patch.point(points[k], corners);
                result.samples[static_cast<std::size_t>(result.first[f]) + k] =
                    sampler.sample(f, on_facet.X, on_facet.normal());
            }
        }
    });
    return result;
}

} // namespace osculate::app
