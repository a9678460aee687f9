#pragma once
/// Points of the unit cube that a sampled axis of a study takes.

#include <vector>

namespace osculate::scene {

enum class SampleRule { latin_hypercube, sobol };

/// `runs` points of `variables` coordinates in [0, 1), the same for the same arguments on every machine.
/// - latin_hypercube: one point in each of `runs` equal slices of every coordinate (McKay, Beckman, Conover 1979)
/// - sobol: Sobol's sequence with a digital shift; every coordinate has one point in each slice where `runs` is a power of two
/// @throws std::range_error  more variables than the tables of directions have
[[nodiscard]] std::vector<std::vector<double>> unit_samples(SampleRule rule, int runs, int variables, int seed);

} // namespace osculate::scene
