#include "app/surface_command.hpp"

#include "app/surface_samples.hpp"
#include "osculate/app/load.hpp"
#include "osculate/core/error.hpp"
#include "osculate/output/vtk_lines.hpp"
#include "osculate/scene/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

/// Pairs to be written. Throws SceneError when there is none, or one has too many samples to number.
std::vector<const model::ContactTerm*> chosen_pairs(const Plan& plan, const SurfaceOptions& options) {
    std::vector<const model::ContactTerm*> pairs;
    std::vector<std::string> names;
    for (const auto& pair : plan.model.pairs) {
        names.push_back(pair->name());
        if (options.pair.empty() || pair->name() == options.pair) pairs.push_back(pair.get());
    }
    Fault fault;
    if (pairs.empty()) {
        fault.key = options.pair.empty() ? "contact" : "--pair";
        fault.expected = options.pair.empty() ? "a contact pair" : "a contact pair of the scene";
        fault.found = options.pair.empty() ? "none" : "'" + options.pair + "'";
        fault.nearest = scene::nearest(options.pair, names);
        throw SceneError({fault});
    }
    for (const model::ContactTerm* pair : pairs) {
        const double points = std::pow(options.refine + 1.0, 2) * pair->surface().facet_count();
        if (points < std::numeric_limits<Index>::max()) continue;
        fault.key = "--refine";
        fault.expected = "less on a surface of " + std::to_string(pair->surface().facet_count()) + " facets";
        fault.found = std::to_string(options.refine);
        throw SceneError({fault});
    }
    return pairs;
}

void write_tessellation(const fs::path& path, const mesh::HalfEdgeSurface& surface, const SurfaceSamples& all) {
    std::vector<Vec3> points;
    std::vector<mesh::Facet> cells;
    std::vector<output::Array> arrays{{"normal", 3, {}},     {"mean_curvature", 1, {}},    {"gauss_curvature", 1, {}},
                                      {"distance", 1, {}},   {"patch_nodes", 1, {}, true}, {"found", 1, {}, true},
                                      {"facet", 1, {}, true}};
    for (Index f = 0; f < surface.facet_count(); ++f) {
        for (mesh::Facet cell : all.grid(surface.facets()[f].count).cells()) {
            for (int c = 0; c < cell.count; ++c) cell.nodes[c] += all.first[f];
            cells.push_back(cell);
        }
        for (Index k = all.first[f]; k < all.first[f + 1]; ++k) {
            const SurfaceSample& sample = all.samples[k];
            points.push_back(sample.position);
            for (const double component : sample.normal) arrays[0].values.push_back(component);
            arrays[1].values.push_back(sample.mean_curvature);
            arrays[2].values.push_back(sample.gauss_curvature);
            arrays[3].values.push_back(sample.distance);
            arrays[4].values.push_back(sample.nodes);
            arrays[5].values.push_back(sample.found ? 1 : 0);
            arrays[6].values.push_back(f);
        }
    }
    output::write_vtp(path, points, cells, arrays, 0);
}

/// Calls f(half_edge, facet, edge of that facet) for every edge once.
template <class F> void for_each_edge(const mesh::HalfEdgeSurface& surface, F&& f) {
    for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h) {
        const mesh::HalfEdge& edge = surface.half_edges()[h];
        if (edge.twin < h) f(h, edge.facet, h - surface.first_half_edge(edge.facet)); // -1 on the boundary
    }
}

/// Boundary and feature edges, as they lie on the sampled surface. @returns the number of feature edges
Index write_edges(const fs::path& path, const mesh::HalfEdgeSurface& surface, const SurfaceSamples& all, int N) {
    std::vector<Vec3> points;
    std::vector<std::vector<Index>> lines;
    output::Array feature{"feature", 1, {}, true};
    Index features = 0;
    for_each_edge(surface, [&](Index h, Index facet, Index edge) {
        if (!surface.is_boundary_edge(h) && !surface.is_feature_edge(h)) return;
        std::vector<Index>& line = lines.emplace_back();
        const FacetGrid& grid = all.grid(surface.facets()[facet].count);
        for (int k = 0; k <= N; ++k) {
            line.push_back(static_cast<Index>(points.size()));
            points.push_back(all.samples[all.first[facet] + grid.on_edge(edge, k)].position);
        }
        features += surface.is_feature_edge(h) ? 1 : 0;
        feature.values.push_back(surface.is_feature_edge(h) ? 1 : 0);
    });
    output::write_lines(path, points, lines, {feature});
    return features;
}

/// Largest angle, rad, between the normals of the samples that two facets have at the same place of a common edge.
double largest_jump(const mesh::HalfEdgeSurface& surface, const SurfaceSamples& all, int N) {
    double largest = 0;
    for_each_edge(surface, [&](Index h, Index facet, Index edge) {
        if (surface.is_boundary_edge(h) || surface.is_feature_edge(h)) return;
        const Index twin = surface.half_edges()[h].twin, other = surface.half_edges()[twin].facet;
        const Index other_edge = twin - surface.first_half_edge(other);
        const FacetGrid &here = all.grid(surface.facets()[facet].count),
                        &there = all.grid(surface.facets()[other].count);
        for (int k = 0; k <= N; ++k) {
            const SurfaceSample& a = all.samples[all.first[facet] + here.on_edge(edge, k)];
            const SurfaceSample& b = all.samples[all.first[other] + there.on_edge(other_edge, N - k)];
            if (!a.found || !b.found) continue;
            largest = std::max(largest, std::atan2(a.normal.cross(b.normal).norm(), a.normal.dot(b.normal)));
        }
    });
    return largest;
}

std::string write_pair(const model::ContactTerm& pair, const std::vector<Vec3>& X, const fs::path& folder, int N,
                       int threads) {
    const mesh::HalfEdgeSurface& surface = pair.surface();
    const std::vector<Vec3> x = pair.vertices(X);
    const SurfaceSamples all = sample_surface(surface, pair.master(), x, N, threads);
    const fs::path file = folder / (pair.name() + ".vtp"), edges = folder / (pair.name() + "_edges.vtp");
    Index features = 0;
    try {
        write_tessellation(file, surface, all);
        features = write_edges(edges, surface, all, N);
    } catch (const std::runtime_error& error) {
        throw RunFailure(error.what());
    }
    Index found = 0;
    double farthest = 0;
    for (const SurfaceSample& sample : all.samples) {
        found += sample.found ? 1 : 0;
        farthest = std::max(farthest, std::abs(sample.distance));
    }
    std::string text =
        fmt::format("pair {}: {} master facets, {} vertices, {} feature edge(s), {} boundary loop(s)\n", pair.name(),
                    surface.facet_count(), surface.vertex_count(), features, surface.boundary_loop_count());
    text += fmt::format("  {} patches had to be smaller or simpler than asked for\n", pair.master().fallbacks());
    text += fmt::format("  surface found at {} of {} samples\n", found, all.samples.size());
    text += fmt::format("  largest distance to the facets {:.4g} m\n", farthest);
    text += fmt::format("  largest jump of the normal across facet edges {:.4g} degrees, feature edges left out\n",
                        largest_jump(surface, all, N) * 180 / std::numbers::pi);
    text += fmt::format("  see {} and {}\n", file.string(), edges.string());
    return text;
}

} // namespace

std::string write_surfaces(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                           const SurfaceOptions& options) {
    Timings unused;
    const LoadedScene loaded = load(scene_path, overrides, options.threads, unused);
    const fs::path folder =
        options.directory.empty() ? fs::path("out") / loaded.scene.name / "surface" : options.directory;
    std::string text;
    for (const model::ContactTerm* pair : chosen_pairs(loaded.plan, options))
        text += write_pair(*pair, loaded.plan.model.X, folder, options.refine, options.threads);
    return text;
}

} // namespace osculate::app
