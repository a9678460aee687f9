#include "scene/study_samples.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdint>
#include <numeric>
#include <utility>

namespace osculate::scene {

namespace {

// Boost's distributions, as those of the standard differ between libraries.
using Engine = boost::random::mt19937_64;

std::vector<std::vector<double>> latin_hypercube(int runs, int variables, Engine& engine) {
    std::vector<std::vector<double>> points(static_cast<std::size_t>(runs));
    std::vector<int> slices(points.size());
    for (int v = 0; v < variables; ++v) {
        std::iota(slices.begin(), slices.end(), 0);
        for (std::size_t i = slices.size(); i > 1; --i) {
            boost::random::uniform_int_distribution<std::size_t> any(0, i - 1);
            std::swap(slices[i - 1], slices[any(engine)]);
        }
        boost::random::uniform_01<double> within;
        for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back((slices[i] + within(engine)) / runs);
    }
    return points;
}

std::vector<std::vector<double>> sobol(int runs, int variables, Engine& engine) {
    boost::random::sobol sequence(static_cast<std::size_t>(variables));
    std::vector<std::uint64_t> shift;
    for (int v = 0; v < variables; ++v) shift.push_back(engine());
    std::vector<std::vector<double>> points(static_cast<std::size_t>(runs));
    constexpr int unused = 64 - 53; // bits that a double does not hold
    constexpr double unit = 1.0 / (std::uint64_t{1} << 53);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const std::uint64_t s : shift) {
            // Boost's sequence begins behind the origin, without which slices are not filled evenly
            const std::uint64_t bits = i == 0 ? 0 : sequence();
            points[i].push_back(static_cast<double>((bits ^ s) >> unused) * unit);
        }
    return points;
}

} // namespace

std::vector<std::vector<double>> unit_samples(SampleRule rule, int runs, int variables, int seed) {
    Engine engine(static_cast<std::uint64_t>(seed));
    return rule == SampleRule::sobol ? sobol(runs, variables, engine) : latin_hypercube(runs, variables, engine);
}

} // namespace osculate::scene
