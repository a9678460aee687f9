// Facet search on sheets of 1e3 to 1e6 facets. Items are slave points; for the tree, facets.

#include "surfaces.hpp"

#include <benchmark/benchmark.h>

namespace osculate::bench {
namespace {

/// One sheet at a time is kept: the largest takes a gigabyte.
const Surface& kept_sheet(int n) {
    static int side = 0;
    static std::unique_ptr<Surface> kept;
    if (side != n) {
        kept = std::make_unique<Surface>(sheet(n));
        side = n;
    }
    return *kept;
}

void build(benchmark::State& state) {
    const Surface& on = kept_sheet(static_cast<int>(state.range(0)));
    contact::FacetSearch search(on.topology);
    for (auto _ : state) search.build(on.x);
    state.SetItemsProcessed(state.iterations() * on.topology.facet_count());
}

void global(benchmark::State& state) {
    const Surface& on = kept_sheet(static_cast<int>(state.range(0)));
    contact::FacetSearch search(on.topology);
    search.build(on.x);
    const std::vector<Vec3> points = slave_points(on, 4096);
    std::size_t k = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(search.global(points[k], on.x));
        k = (k + 1) % points.size();
    }
    state.SetItemsProcessed(state.iterations());
}

/// Each point has slid by half a facet since it was last seen.
void track(benchmark::State& state) {
    const Surface& on = kept_sheet(static_cast<int>(state.range(0)));
    contact::FacetSearch search(on.topology);
    search.build(on.x);
    std::vector<Vec3> points = slave_points(on, 4096);
    std::vector<Index> from;
    for (Vec3& s : points) {
        from.push_back(search.global(s, on.x).facet);
        s += Vec3(0.5, 0, 0);
    }
    constexpr double hysteresis = 0.03; // of a pair
    std::size_t k = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(search.track(points[k], from[k], on.x, hysteresis));
        k = (k + 1) % points.size();
    }
    state.SetItemsProcessed(state.iterations());
}

[[maybe_unused]] const bool registered = [] {
    for (const int side : {32, 100, 316, 1000}) { // in this order a sheet is made once
        benchmark::RegisterBenchmark("search/build", build)->Arg(side)->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark("search/global", global)->Arg(side);
        benchmark::RegisterBenchmark("search/track", track)->Arg(side);
    }
    return true;
}();

} // namespace
} // namespace osculate::bench
