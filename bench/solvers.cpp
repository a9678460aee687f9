// Assembly, products, factors and cycles of one elastic block that stands on its foot. Items are unknowns.

#include "osculate/fe/element_block.hpp"
#include "osculate/linear/body_compliance.hpp"
#include "osculate/linear/penalty_stiffness.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/model/nodal_unknowns.hpp"

#include <benchmark/benchmark.h>

namespace osculate::bench {
namespace {

/// n elements along each edge; the nodes of its top are those contact may reach.
struct Block {
    explicit Block(int n) {
        mesh::Mesh mesh = mesh::make_block(Vec3::Zero(), Vec3::Ones(), {n, n, n});
        std::vector<linear::NodeConstraint> held;
        for (Index node = 0; node < mesh.node_count(); ++node) {
            const double z = mesh.nodes[node].z(), edge = 1e-9;
            if (z > 1 - edge) top.push_back(node);
            for (int k = 0; k < 3 && z < edge; ++k)
                held.emplace_back().node = node, held.back().direction = Vec3::Unit(k);
        }
        model.X = mesh.nodes;
        model::Body& body = model.bodies.emplace_back();
        body.mesh = std::move(mesh);
        body.kernels.push_back(fe::make_kernel(mesh::CellType::hex8, HexFormulation::full, {1e8, 0.3}));
        model.K = model::assemble_stiffness(model.bodies, model.nodes());
        constraints = std::make_unique<linear::Constraints>(model.nodes(), held);
        stiffness = std::make_unique<linear::PenaltyStiffness>(*constraints, model.K);
        stiffness->set_springs({});
    }

    model::Model model;
    std::vector<Index> top;
    std::unique_ptr<linear::Constraints> constraints;
    std::unique_ptr<linear::PenaltyStiffness> stiffness;
};

template <class Work> void measure(benchmark::State& state, const Block& block, Work&& work) {
    for (auto _ : state) {
        work();
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * block.constraints->equations());
}

void assemble(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    measure(state, block,
            [&] { benchmark::DoNotOptimize(model::assemble_stiffness(block.model.bodies, block.model.nodes())); });
}

void residual(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    const Field u(block.model.X.size(), Vec3::Ones());
    Field f(u.size());
    measure(state, block, [&] { block.model.K.multiply_add(u, f, 1); });
}

void factor_cholesky(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    measure(state, block, [&] { (void)solve::make_cholesky()->factorise(block.stiffness->matrix()); });
}

void factor_condensing(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    measure(state, block, [&] {
        linear::BodyCompliance compliance(*block.constraints, 0, block.model.nodes(), block.top, {});
        (void)compliance.factorise(block.stiffness->matrix(), 0);
    });
}

void factor_multigrid(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    const auto unknowns = model::nodal_unknowns(block.model, *block.constraints);
    measure(state, block, [&] {
        const auto multigrid = solve::make_multigrid(unknowns);
        multigrid->coarsen(block.model.K.view());
        (void)multigrid->couple({});
    });
}

void apply_cholesky(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    const auto solver = solve::make_cholesky();
    (void)solver->factorise(block.stiffness->matrix());
    const Vector b = Vector::Ones(block.constraints->equations());
    Vector x(b.size());
    measure(state, block, [&] { solver->solve(b.data(), x.data()); });
}

void apply_condensed(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    linear::BodyCompliance compliance(*block.constraints, 0, block.model.nodes(), block.top, {});
    (void)compliance.factorise(block.stiffness->matrix(), 0);
    const Vector f = Vector::Ones(compliance.W().rows());
    Vector u(f.size());
    measure(state, block, [&] { u.noalias() = compliance.W().selfadjointView<Eigen::Lower>() * f; });
}

void apply_multigrid(benchmark::State& state) {
    const Block block(static_cast<int>(state.range(0)));
    const auto solver = solve::make_multigrid(model::nodal_unknowns(block.model, *block.constraints));
    solver->coarsen(block.model.K.view());
    (void)solver->couple({});
    const Vector b = Vector::Ones(block.constraints->equations());
    Vector x(b.size());
    measure(state, block, [&] { solver->cycle(b.data(), x.data()); });
}

BENCHMARK(residual)->Name("block/residual")->Arg(16)->Arg(24);
BENCHMARK(assemble)->Name("block/assemble")->Arg(16)->Arg(24);
BENCHMARK(factor_cholesky)->Name("factor/cholesky")->Arg(16)->Arg(24);
BENCHMARK(factor_condensing)->Name("factor/condensing")->Arg(16)->Arg(24);
BENCHMARK(factor_multigrid)->Name("factor/multigrid")->Arg(16)->Arg(24);
BENCHMARK(apply_cholesky)->Name("apply/cholesky")->Arg(16)->Arg(24);
BENCHMARK(apply_condensed)->Name("apply/condensed")->Arg(16)->Arg(24);
BENCHMARK(apply_multigrid)->Name("apply/multigrid")->Arg(16)->Arg(24);

} // namespace
} // namespace osculate::bench
