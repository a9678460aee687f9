#include "app/command/surface_command.hpp"

#include "app/command/surface_samples.hpp"
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
std::vector<const model::ContactPair*> chosen_pairs(const Plan& plan, const SurfaceOptions& options) {
    std::vector<const model::ContactPair*> pairs;
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
    for (const model::ContactPair* pair : pairs) {
        const double points = std::pow(options.refine + 1.0, 2) * pair->surface().facet_count();
        if (points < std::numeric_limits<Index>::max()) continue;
        fault.key = "--refine";
        fault.expected = "less on a surface of " + std::to_string(pair->surface().facet_count()) + " facets";
        fault.found = std::to_string(options.refine);
        throw SceneError({fault});
    }
    return pairs;
}

/// Per facet, whether it is one of the mesh and not a mirror image beyond a symmetry plane.
std::vector<char> own_facets(const model::ContactPair& pair) {
    const mesh::HalfEdgeSurface& surface = pair.surface();
    std::vector<char> own;
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto v = surface.facet_vertices(f);
        own.push_back(std::ranges::all_of(v, [&](Index w) { return pair.own_vertex(w) == w; }) ? 1 : 0);
    }
    return own;
}

void write_tessellation(const fs::path& path, const mesh::HalfEdgeSurface& surface, const std::vector<char>& own,
                        const SurfaceSamples& all, const Vec3& origin) {
    std::vector<Vec3> points;
    std::vector<mesh::Facet> cells;
    std::vector<output::Array> arrays{{"normal", 3, {}},     {"mean_curvature", 1, {}},    {"gauss_curvature", 1, {}},
                                      {"distance", 1, {}},   {"patch_nodes", 1, {}, true}, {"found", 1, {}, true},
                                      {"facet", 1, {}, true}};
    for (Index f = 0; f < surface.facet_count(); ++f) {
        if (own[f] == 0) continue;
        const auto first = static_cast<Index>(points.size());
        for (mesh::Facet cell : all.grid(surface.facets()[f].count).cells()) {
            for (int c = 0; c < cell.count; ++c) cell.nodes[c] += first;
            cells.push_back(cell);
        }
        for (Index k = all.first[f]; k < all.first[f + 1]; ++k) {
            const SurfaceSample& sample = all.samples[k];
            points.push_back(sample.position + origin);
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

/// Calls f(half_edge, facet, edge of that facet) for every edge of own facets once.
template <class F> void for_each_edge(const mesh::HalfEdgeSurface& surface, const std::vector<char>& own, F&& f) {
    for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h) {
        const mesh::HalfEdge& edge = surface.half_edges()[h];
        if (own[edge.facet] == 0) continue;
        const bool twin_is_own = edge.twin >= 0 && own[surface.half_edges()[edge.twin].facet] != 0;
        if (!twin_is_own || edge.twin < h) f(h, edge.facet, h - surface.first_half_edge(edge.facet));
    }
}

struct EdgeCounts {
    Index feature = 0, boundary = 0;
};

/// Boundary and feature edges, as they lie on the sampled surface. An edge on a symmetry plane is no boundary.
EdgeCounts write_edges(const fs::path& path, const mesh::HalfEdgeSurface& surface, const std::vector<char>& own,
                       const SurfaceSamples& all, int N, const Vec3& origin) {
    std::vector<Vec3> points;
    std::vector<std::vector<Index>> lines;
    output::Array feature{"feature", 1, {}, true};
    EdgeCounts counts;
    for_each_edge(surface, own, [&](Index h, Index facet, Index edge) {
        if (!surface.is_boundary_edge(h) && !surface.is_feature_edge(h)) return;
        std::vector<Index>& line = lines.emplace_back();
        const FacetGrid& grid = all.grid(surface.facets()[facet].count);
        for (int k = 0; k <= N; ++k) {
            line.push_back(static_cast<Index>(points.size()));
            points.push_back(all.samples[all.first[facet] + grid.on_edge(edge, k)].position + origin);
        }
        ++(surface.is_feature_edge(h) ? counts.feature : counts.boundary);
        feature.values.push_back(surface.is_feature_edge(h) ? 1 : 0);
    });
    output::write_lines(path, points, lines, {feature});
    return counts;
}

/// Largest angle, rad, between the normals of the samples that two facets have at the same place of a common edge.
double largest_jump(const mesh::HalfEdgeSurface& surface, const std::vector<char>& own, const SurfaceSamples& all,
                    int N) {
    double largest = 0;
    for_each_edge(surface, own, [&](Index h, Index facet, Index edge) {
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

std::string write_pair(const model::ContactPair& pair, const model::Model& model, const fs::path& folder, int N,
                       int threads) {
    const mesh::HalfEdgeSurface& surface = pair.surface();
    const std::vector<Vec3> x = pair.vertices(model.X);
    const std::vector<char> own = own_facets(pair);
    const SurfaceSamples all =
        sample_surface(surface, *pair.master(), x, N, threads); // images too: for jumps at planes
    const fs::path file = folder / (pair.name() + ".vtp"), edges = folder / (pair.name() + "_edges.vtp");
    EdgeCounts counts;
    try {
        write_tessellation(file, surface, own, all, model.origin);
        counts = write_edges(edges, surface, own, all, N, model.origin);
    } catch (const std::runtime_error& error) {
        throw RunFailure(error.what());
    }
    Index facets = 0, vertices = 0, samples = 0, found = 0;
    double farthest = 0;
    for (Index v = 0; v < surface.vertex_count(); ++v) vertices += pair.own_vertex(v) == v ? 1 : 0;
    for (Index f = 0; f < surface.facet_count(); ++f) {
        if (own[f] == 0) continue;
        ++facets;
        samples += all.first[f + 1] - all.first[f];
        for (Index k = all.first[f]; k < all.first[f + 1]; ++k) {
            found += all.samples[k].found ? 1 : 0;
            farthest = std::max(farthest, std::abs(all.samples[k].distance));
        }
    }
    const Index images = surface.facet_count() - facets;
    std::string text = fmt::format("pair {}: {} master facets, {} vertices, {} feature edge(s), {} boundary edge(s)\n",
                                   pair.name(), facets, vertices, counts.feature, counts.boundary);
    if (images > 0) text += fmt::format("  {} mirror images of facets beyond symmetry planes, not drawn\n", images);
    text += fmt::format("  {} patches had to be smaller or simpler than asked for{}\n", pair.master()->fallbacks(),
                        images > 0 ? ", those of mirror images among them" : "");
    text += fmt::format("  surface found at {} of {} samples\n", found, samples);
    text += fmt::format("  largest distance to the facets {:.4g} m\n", farthest);
    text += fmt::format("  largest jump of the normal across facet edges {:.4g} degrees, feature edges left out\n",
                        largest_jump(surface, own, all, N) * 180 / std::numbers::pi);
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
    const std::vector<const model::ContactPair*> pairs = chosen_pairs(loaded.plan, options);
    std::vector<std::string> names;
    for (const model::ContactPair* pair : pairs)
        names.insert(names.end(), {pair->name() + ".vtp", pair->name() + "_edges.vtp"});
    output::OutputFolder files(chosen_folder(folder, options.folder), entry_of(options.folder), names);
    files.claim(names);
    std::string text;
    for (const model::ContactPair* pair : pairs)
        text += write_pair(*pair, loaded.plan.model, files.path(), options.refine, options.threads);
    return text;
}

} // namespace osculate::app
