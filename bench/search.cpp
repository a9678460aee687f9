// Facet search on sheets of 1e3 to 1e6 facets. Items are slave points; for the tree, facets.

#include "surfaces.hpp"

#include <benchmark/benchmark.h>

namespace osculate::bench {
namespace {

/// A sheet and its search tree.
struct Searched {
    Surface on;
    contact::FacetSearch search;
    std::vector<SlavePoint> points;

    explicit Searched(int n) : on(sheet(n)), search(on.topology), points(slave_points(on, 4096)) { search.build(on.x); }
};

/// One sheet at a time is kept: the largest takes most of a gigabyte.
Searched& kept(int n) {
    static int side = 0;
    static std::unique_ptr<Searched> last;
    if (side != n) {
        last.reset();
        last = std::make_unique<Searched>(n);
        side = n;
    }
    return *last;
}

void build(benchmark::State& state) {
    Searched& sheet = kept(static_cast<int>(state.range(0)));
    for (auto _ : state) sheet.search.build(sheet.on.x);
    state.SetItemsProcessed(state.iterations() * sheet.on.topology.facet_count());
}

void global(benchmark::State& state) {
    const Searched& sheet = kept(static_cast<int>(state.range(0)));
    std::size_t k = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(sheet.search.global(sheet.points[k].s, sheet.on.x));
        k = (k + 1) % sheet.points.size();
    }
    state.SetItemsProcessed(state.iterations());
}

/// Each point has slid by half a facet since it was last seen.
void track(benchmark::State& state) {
    const Searched& sheet = kept(static_cast<int>(state.range(0)));
    constexpr double hysteresis = 0.03; // of a pair
    std::size_t k = 0;
    for (auto _ : state) {
        const SlavePoint& point = sheet.points[k];
        benchmark::DoNotOptimize(sheet.search.track(point.s + Vec3(0.5, 0, 0), point.facet, sheet.on.x, hysteresis));
        k = (k + 1) % sheet.points.size();
    }
    state.SetItemsProcessed(state.iterations());
}

[[maybe_unused]] const bool registered = [] {
    for (const int side : {32, 100, 316, 1000}) { // in this order a sheet is made once
        benchmark::RegisterBenchmark("search/build", build)->Arg(side)->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark("search/track", track)->Arg(side);
        // a global search among 1e6 facets takes many seconds
        if (side < 1000) benchmark::RegisterBenchmark("search/global", global)->Arg(side);
    }
    return true;
}();

} // namespace
} // namespace osculate::bench
