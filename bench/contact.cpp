// Evaluations of a master surface, and what they are made of. Items are slave points, patches or projections.

#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/projection.hpp"
#include "osculate/contact/rpim_patch.hpp"
#include "surfaces.hpp"

#include <benchmark/benchmark.h>

namespace osculate::bench {
namespace {

/// Radial functions as with the default discretisation, chosen patch by patch; "multiquadric" as with the others.
std::unique_ptr<contact::MasterSurface> make(const Surface& surface, const std::string& kind) {
    if (kind == "facets") return contact::make_facets_surface(surface.topology);
    if (kind == "rpim") return contact::make_rpim_surface(surface.topology, surface.x, {.basis = std::nullopt});
    if (kind == "multiquadric") return contact::make_blend_surface(surface.topology, surface.x, {});
    return contact::make_blend_surface(surface.topology, surface.x, {.basis = std::nullopt});
}

/// What a Newton iteration asks of a master: patches are placed at the nodes of the configuration, then every slave point
/// is evaluated. Four points a facet, as many as in the foundation. The surface moves to and fro by 0.1 % of a facet.
void evaluate(benchmark::State& state, const std::string& shape, const std::string& kind,
              std::optional<contact::VariationForm> form) {
    const Surface& on = surface(shape);
    const auto master = make(on, kind);
    contact::FacetSearch search(on.topology);
    search.build(on.x);
    const std::vector<SlavePoint> slaves = slave_points(on, static_cast<int>(4 * on.topology.facet_count()));
    std::vector<contact::FacetHit> hits;
    for (const SlavePoint& slave : slaves) hits.push_back(search.global(slave.s, on.x));
    std::vector<Vec3> moved = on.x;
    for (std::size_t v = 0; v < moved.size(); ++v)
        moved[v] += 1e-3 * on.topology.facet_size(0) * Vec3(std::sin(3.0 * v), std::cos(5.0 * v), std::sin(7.0 * v));
    std::vector<contact::ContactPoint> points(slaves.size());
    contact::ContactVariation variation;
    std::unique_ptr<contact::Placement> placement;
    bool there = false;
    for (auto _ : state) {
        there = !there;
        const std::vector<Vec3>& x = there ? moved : on.x;
        master->place(hits, x, 1, placement);
        for (std::size_t k = 0; k < points.size(); ++k) {
            master->evaluate(slaves[k].s, hits[k], x, points[k], nullptr, placement.get());
            benchmark::DoNotOptimize(points[k].gap);
            if (!form || !points[k].found) continue;
            variation.form = *form;
            variation.patches.clear();
            master->vary(slaves[k].s, hits[k], x, points[k], variation);
            benchmark::DoNotOptimize(variation.dg.data());
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<Index>(points.size()));
}

/// Placing all patches of a surface in one configuration; an item is a vertex.
void place(benchmark::State& state, const std::string& shape) {
    const Surface& on = surface(shape);
    const auto master = make(on, "blend");
    std::vector<contact::FacetHit> hits(static_cast<std::size_t>(on.topology.facet_count()));
    for (std::size_t f = 0; f < hits.size(); ++f) hits[f].facet = static_cast<Index>(f);
    std::unique_ptr<contact::Placement> placement;
    for (auto _ : state) master->place(hits, on.x, 1, placement);
    state.SetItemsProcessed(state.iterations() * on.topology.vertex_count());
}

/// Fitting all patches of a surface; an item is a facet (rpim) or a vertex (blend).
void fit(benchmark::State& state, const std::string& shape, const std::string& kind) {
    const Surface& on = surface(shape);
    for (auto _ : state) benchmark::DoNotOptimize(make(on, kind));
    state.SetItemsProcessed(state.iterations() *
                            (kind == "rpim" ? on.topology.facet_count() : on.topology.vertex_count()));
}

/// A square patch of side x side nodes, gently curved.
struct SquarePatch {
    contact::MatrixX2 u;
    contact::MatrixX3 x;

    explicit SquarePatch(int side) : u(side * side, 2), x(side * side, 3) {
        for (Index i = 0; i < u.rows(); ++i) {
            u.row(i) << i % side - 0.5 * (side - 1), static_cast<double>(i / side) - 0.5 * (side - 1);
            x.row(i) << u.row(i), 0.05 * u.row(i).squaredNorm();
        }
    }
};

void fit_one(benchmark::State& state) {
    const SquarePatch square(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(contact::RpimPatch::fit(square.u, {}, 6));
    state.SetItemsProcessed(state.iterations());
}

template <class Patch> void project_on(benchmark::State& state, const Patch& patch, const contact::MatrixX3& x) {
    const contact::MatrixX3 coefficients = patch.coefficients(x);
    const Vec2 start = Vec2::Constant(0.1);
    const contact::PatchPoint above = patch.point(Vec2(0.35, 0.2), coefficients);
    const Vec3 s = above.X + 0.05 * above.normal();
    for (auto _ : state) benchmark::DoNotOptimize(contact::project(patch, coefficients, s, start));
    state.SetItemsProcessed(state.iterations());
}

void project_facet(benchmark::State& state) {
    const SquarePatch square(2);
    contact::MatrixX3 corners(4, 3);
    corners << square.x.row(0), square.x.row(1), square.x.row(3), square.x.row(2);
    corners(2, 2) += 0.1; // twisted
    project_on(state, contact::FacetPatch(4), corners);
}

void project_rpim(benchmark::State& state) {
    const SquarePatch square(static_cast<int>(state.range(0)));
    project_on(state, contact::RpimPatch::fit(square.u, {}, 6).value(), square.x);
}

/// What an evaluation asks of a patch besides the projection.
void rpim_coefficients(benchmark::State& state) {
    const SquarePatch square(static_cast<int>(state.range(0)));
    const auto patch = contact::RpimPatch::fit(square.u, {}, 6).value();
    for (auto _ : state) benchmark::DoNotOptimize(patch.coefficients(square.x));
    state.SetItemsProcessed(state.iterations());
}

void rpim_weights(benchmark::State& state) {
    const SquarePatch square(static_cast<int>(state.range(0)));
    const auto patch = contact::RpimPatch::fit(square.u, {}, 6).value();
    Vector phi(patch.size());
    contact::MatrixX2 phi_a(patch.size(), 2);
    for (auto _ : state) {
        patch.weights(Vec2(0.35, 0.2), phi, phi_a);
        benchmark::DoNotOptimize(phi.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations());
}

// sides: nodes of a 1-ring facet patch, a 2-ring vertex patch and a 2-ring facet patch
BENCHMARK(fit_one)->Name("patch/fit")->Arg(4)->Arg(5)->Arg(6);
BENCHMARK(rpim_coefficients)->Name("patch/coefficients")->Arg(4)->Arg(5)->Arg(6);
BENCHMARK(rpim_weights)->Name("patch/weights")->Arg(4)->Arg(5)->Arg(6);
BENCHMARK(project_facet)->Name("project/facet");
BENCHMARK(project_rpim)->Name("project/rpim")->Arg(4)->Arg(5)->Arg(6);

[[maybe_unused]] const bool registered = [] {
    const std::pair<const char*, std::optional<contact::VariationForm>> forms[] = {
        {"values", std::nullopt},
        {"variation_gap", contact::VariationForm::gap},
        {"variation_products", contact::VariationForm::products},
        {"variation_matrices", contact::VariationForm::matrices}};
    for (const char* shape : {"half_tube", "block"}) {
        for (const auto& [name, form] : forms)
            for (const char* kind : {"facets", "rpim", "blend", "multiquadric"})
                benchmark::RegisterBenchmark((std::string("evaluate/") + shape + "/" + name + "/" + kind).c_str(),
                                             evaluate, shape, kind, form);
        benchmark::RegisterBenchmark((std::string("prepare/") + shape).c_str(), place, shape);
        for (const char* kind : {"rpim", "blend"})
            benchmark::RegisterBenchmark((std::string("build/") + shape + "/" + kind).c_str(), fit, shape, kind)
                ->Unit(benchmark::kMillisecond);
    }
    return true;
}();

} // namespace
} // namespace osculate::bench
