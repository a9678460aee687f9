// Facet search on sheets of 1e3 to 1e6 facets: the R-tree and the walk over closest facets in use, and the paper's position
// code. Items are slave points; for build, facets.

#include "position_code.hpp"
#include "surfaces.hpp"

#include <benchmark/benchmark.h>
#include <memory>

namespace osculate::bench {
namespace {

/// A sheet, searched in both ways.
struct Searched {
    Surface on;
    contact::FacetSearch tree;
    PositionCode code;
    std::vector<SlavePoint> near, far; ///< on the surface; five facets above it

    explicit Searched(int n) : on(sheet(n)), tree(on.topology), code(on.topology), near(slave_points(on, 4096)) {
        tree.build(on.x);
        code.build(on.x);
        for (const SlavePoint& point : near) far.push_back({point.s + Vec3(0, 0, 5), point.facet});
    }
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

/// Both end in the same question, what the point is to the facet found.
struct Tree {
    static auto& of(Searched& sheet) { return sheet.tree; }
    static contact::FacetHit global(const Searched& sheet, const Vec3& s) { return sheet.tree.global(s, sheet.on.x); }
    static contact::FacetHit track(const Searched& sheet, const Vec3& s, Index from) {
        return sheet.tree.track(s, from, sheet.on.x, 0);
    }
};
struct Code {
    static auto& of(Searched& sheet) { return sheet.code; }
    static contact::FacetHit global(const Searched& sheet, const Vec3& s) {
        return sheet.tree.closest_on(sheet.code.global(s, sheet.on.x), s, sheet.on.x);
    }
    static contact::FacetHit track(const Searched& sheet, const Vec3& s, Index from) {
        return sheet.tree.closest_on(sheet.code.track(s, from, sheet.on.x), s, sheet.on.x);
    }
};

/// The position code's facet, then the closest one around it by exact distances, as tracking finds it.
struct FinishedCode : Code {
    static contact::FacetHit global(const Searched& sheet, const Vec3& s) {
        return sheet.tree.track(s, sheet.code.global(s, sheet.on.x), sheet.on.x, 0);
    }
};

template <class Method> void build(benchmark::State& state) {
    Searched& sheet = kept(static_cast<int>(state.range(0)));
    for (auto _ : state) Method::of(sheet).build(sheet.on.x);
    state.SetItemsProcessed(state.iterations() * sheet.on.topology.facet_count());
}

/// Queries one after the other, and the share of them that do not name the closest facet.
void query(benchmark::State& state, const Searched& sheet, std::size_t count, const auto& hit, const auto& point) {
    std::size_t k = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(hit(k));
        k = (k + 1) % count;
    }
    state.SetItemsProcessed(state.iterations());
    int missed = 0;
    for (k = 0; k < count; ++k)
        missed += hit(k).distance > sheet.tree.global(point(k), sheet.on.x).distance + 1e-6; // of facets of size 1
    state.counters["not_closest"] = missed / static_cast<double>(count);
}

template <class Method> void global(benchmark::State& state, bool above) {
    const Searched& sheet = kept(static_cast<int>(state.range(0)));
    const auto& points = above ? sheet.far : sheet.near;
    const auto point = [&](std::size_t k) { return points[k].s; };
    query(
        state, sheet, points.size(), [&](std::size_t k) { return Method::global(sheet, point(k)); }, point);
}

/// Each point has slid by half a facet since it was last seen.
template <class Method> void track(benchmark::State& state) {
    const Searched& sheet = kept(static_cast<int>(state.range(0)));
    const auto point = [&](std::size_t k) -> Vec3 { return sheet.near[k].s + Vec3(0.5, 0, 0); };
    query(
        state, sheet, sheet.near.size(),
        [&](std::size_t k) { return Method::track(sheet, point(k), sheet.near[k].facet); }, point);
}

template <class Method> void enter(const std::string& name, int side) {
    benchmark::RegisterBenchmark(("search/build/" + name).c_str(), build<Method>)
        ->Arg(side)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("search/global/near/" + name).c_str(), global<Method>, false)->Arg(side);
    benchmark::RegisterBenchmark(("search/global/far/" + name).c_str(), global<Method>, true)->Arg(side);
    benchmark::RegisterBenchmark(("search/track/" + name).c_str(), track<Method>)->Arg(side);
}

[[maybe_unused]] const bool registered = [] {
    for (const int side : {32, 100, 316, 1000}) { // in this order a sheet is made once
        enter<Tree>("tree", side);
        enter<Code>("position_code", side);
        for (const bool above : {false, true})
            benchmark::RegisterBenchmark(above ? "search/global/far/position_code_finished"
                                               : "search/global/near/position_code_finished",
                                         global<FinishedCode>, above)
                ->Arg(side);
    }
    return true;
}();

} // namespace
} // namespace osculate::bench
