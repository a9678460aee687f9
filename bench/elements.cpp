// Element stiffness. Items are elements.

#include "osculate/fe/element_block.hpp"
#include "osculate/mesh/generators.hpp"

#include <benchmark/benchmark.h>

namespace osculate::bench {
namespace {

void stiffness(benchmark::State& state, mesh::CellType type, HexFormulation formulation) {
    const auto kernel = fe::make_kernel(type, formulation, {30e6, 0.2});
    const mesh::Mesh mesh = mesh::make_half_tube(3, 1, 12, {13, 12, 1}, type);
    const mesh::ElementBlock& block = mesh.blocks.at(0);
    const int n = kernel->nodes();
    Eigen::Matrix3Xd X(3, n);
    for (int k = 0; k < n; ++k) X.col(k) = mesh.nodes[block.connectivity[k]];
    Matrix K(3 * n, 3 * n);
    for (auto _ : state) {
        kernel->stiffness(X, K);
        benchmark::DoNotOptimize(K.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations());
}

using mesh::CellType;
using enum HexFormulation;
BENCHMARK_CAPTURE(stiffness, hex8_full, CellType::hex8, full);
BENCHMARK_CAPTURE(stiffness, hex8_b_bar, CellType::hex8, b_bar);
BENCHMARK_CAPTURE(stiffness, hex8_incompatible_modes, CellType::hex8, incompatible_modes);
BENCHMARK_CAPTURE(stiffness, wedge6, CellType::wedge6, full);
BENCHMARK_CAPTURE(stiffness, tet4, CellType::tet4, full);

} // namespace
} // namespace osculate::bench
