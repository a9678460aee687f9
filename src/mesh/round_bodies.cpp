#include "mesh/o_grid.hpp"
#include "mesh/structured_grid.hpp"
#include "osculate/mesh/generators.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace osculate::mesh {
namespace {

void require_at_least(const char* name, double value, double least) {
    if (!(value >= least) || !std::isfinite(value))
        throw std::invalid_argument(std::string(name) + " must be finite and at least " + std::to_string(least) +
                                    ", not " + std::to_string(value));
}

void require_positive(const char* name, double value) {
    if (!(value > 0) || !std::isfinite(value))
        throw std::invalid_argument(std::string(name) + " must be positive and finite, not " + std::to_string(value));
}

/// Divisions of the core along x and y. The part of a circle between two diagonals has as many elements as a side of the
/// core; a cut through the middle of the core halves them.
std::array<int, 2> core_divisions(int around, Portion portion) {
    if (around < 2 || around % 2 != 0)
        throw std::invalid_argument("elements around a quarter must be an even number, 2 or more, not " +
                                    std::to_string(around));
    return {portion == Portion::full ? around : around / 2, portion == Portion::quarter ? around / 2 : around};
}

/// (ratio^i - 1)/(ratio^n - 1): the end of part i of n, each `ratio` times as long as the one before.
double graded(int i, int n, double ratio) {
    if (i == 0 || i == n) return i == 0 ? 0 : 1;
    const double log = std::log(ratio);
    return log == 0 ? static_cast<double>(i) / n : std::expm1(i * log) / std::expm1(n * log);
}

/// Node i of the core's n + 1 along a line, within [-1, 1], or [0, 1] where the core is cut at 0; graded away from 0.
double along_core(int i, int n, bool cut, double ratio) {
    if (cut) return graded(i, n, ratio);
    const int half = n / 2;
    return i < half ? -graded(half - i, half, ratio) : graded(i - half, half, ratio);
}

/// Equal parts become equal angles seen from the centre.
double equal_angles(double part) {
    return part == 1 || part == -1 ? part : std::tan(std::numbers::pi / 4 * part);
}

// The core's corners would be pressed into the outer surface if it were large, its elements small if it were small; its
// sides are bulged part of the way to round ones, which opens the angles at its edges.
constexpr double core_size = 0.5, bulge = 0.4;

/// Moves the unit ball conformally onto itself so that lengths at (0, 0, -1) shrink to `scale`: a translation of the
/// hyperbolic space whose Poincare model the ball is. Angles stay, and so do planes through the axis.
Vec3 towards_pole(const Vec3& x, double scale) {
    if (scale == 1) return x;
    const Vec3 a(0, 0, -(1 - scale) / (1 + scale));
    const double aa = a.squaredNorm(), ax = a.dot(x), xx = x.squaredNorm();
    return ((1 + 2 * ax + xx) * a + (1 - aa) * x) / (1 + 2 * ax + aa * xx);
}

/// Joins the two ends of a grid that goes around once in its first direction.
void close_ring(Mesh& mesh, int around) {
    const Index row = around + 1; // the last of each row of nodes is the first
    const auto closed = [&](Index node) { return node / row * around + node % row % around; };
    std::vector<Vec3> nodes(mesh.nodes.size() / static_cast<std::size_t>(row) * static_cast<std::size_t>(around));
    for (Index i = 0; i < mesh.node_count(); ++i)
        if (i % row != around) nodes[static_cast<std::size_t>(closed(i))] = mesh.nodes[static_cast<std::size_t>(i)];
    mesh.nodes = std::move(nodes);
    for (ElementBlock& block : mesh.blocks)
        for (Index& node : block.connectivity) node = closed(node);
    mesh.surfaces.erase("x_min");
    mesh.surfaces.erase("y_min");
    for (auto& [name, facets] : mesh.surfaces)
        for (Facet& facet : facets)
            for (int c = 0; c < facet.count; ++c) facet.nodes[c] = closed(facet.nodes[c]);
}

} // namespace

Mesh make_ball(double radius, const std::array<int, 3>& divisions, Portion portion, double grading,
               double pole_refinement) {
    require_positive("radius", radius);
    require_at_least("grading", grading, 1);
    require_at_least("pole_refinement", pole_refinement, 1);
    const auto [nx, ny] = core_divisions(divisions[0], portion);
    const int layers = divisions[1], nz = divisions[2];
    const bool cut_x = portion != Portion::full, cut_y = portion == Portion::quarter;
    OGrid grid;
    grid.core = {nx, ny, nz};
    grid.layers = layers;
    grid.grown = {!cut_x, true, !cut_y, true, true, true};
    grid.sides = {"x_min", nullptr, "y_min", nullptr, nullptr, nullptr};
    grid.position = [=, nx = nx, ny = ny](int i, int j, int k, int l) -> Vec3 {
        const Vec3 cube(equal_angles(along_core(i, nx, cut_x, grading)),
                        equal_angles(along_core(j, ny, cut_y, grading)), equal_angles(2. * k / nz - 1));
        const double size = cube.lpNorm<Eigen::Infinity>();
        const Vec3 round = size > 0 ? Vec3(size / cube.norm() * cube) : cube;
        const Vec3 core = core_size * ((1 - bulge) * cube + bulge * round);
        const double out = 1 - graded(layers - l, layers, grading);
        const Vec3 x = towards_pole((1 - out) * core + out * round, 1 / pole_refinement);
        return l == layers ? Vec3(radius * x.normalized()) : Vec3(radius * x);
    };
    return mesh_o_grid(grid);
}

Mesh make_cylinder(double radius, double length, const std::array<int, 3>& divisions, Portion portion, double grading) {
    require_positive("radius", radius);
    require_positive("length", length);
    require_positive("grading", grading);
    const auto [nx, ny] = core_divisions(divisions[0], portion);
    const int layers = divisions[1], nz = divisions[2];
    const bool cut_x = portion != Portion::full, cut_y = portion == Portion::quarter;
    OGrid grid;
    grid.core = {nx, ny, nz};
    grid.layers = layers;
    grid.grown = {!cut_x, true, !cut_y, true, false, false};
    grid.sides = {"x_min", nullptr, "y_min", nullptr, "z_min", "z_max"};
    grid.position = [=, nx = nx, ny = ny](int i, int j, int k, int l) -> Vec3 {
        const Vec3 square(equal_angles(along_core(i, nx, cut_x, 1)), equal_angles(along_core(j, ny, cut_y, 1)), 0);
        const double size = square.lpNorm<Eigen::Infinity>();
        const Vec3 round = size > 0 ? Vec3(size / square.norm() * square) : square;
        const Vec3 core = core_size * ((1 - bulge) * square + bulge * round);
        const double out = static_cast<double>(l) / layers;
        Vec3 x = radius * (l == layers ? round.normalized() : Vec3((1 - out) * core + out * round));
        x.z() = length * graded(k, nz, grading);
        return x;
    };
    return mesh_o_grid(grid);
}

Mesh make_tube(double inner_radius, double thickness, double length, const std::array<int, 3>& divisions,
               Portion portion) {
    require_positive("inner_radius", inner_radius);
    require_positive("thickness", thickness);
    require_positive("length", length);
    const auto [around, along, through] = divisions;
    if (around < 3) throw std::invalid_argument("elements around must be 3 or more, not " + std::to_string(around));
    if (portion != Portion::full && around % 4 != 0)
        throw std::invalid_argument("elements around a tube that is cut must be a multiple of 4, not " +
                                    std::to_string(around));
    const int first = portion == Portion::half ? -around / 4 : 0;
    const int count = portion == Portion::full ? around : portion == Portion::half ? around / 2 : around / 4;
    // around, along z and outward are right-handed
    const auto position = [&, around = around, along = along, through = through](int i, int j, int k) -> Vec3 {
        const int step = first + i;
        const double angle = 2 * std::numbers::pi * step / around, r = inner_radius + thickness * k / through;
        // cos(pi/2) is not quite zero: cuts lie in their planes exactly
        const double cosine = 4 * std::abs(step) == around ? 0.0 : std::cos(angle);
        return {r * cosine, r * std::sin(angle), length * j / along};
    };
    const std::array<const char*, 6> sides{
        portion == Portion::half ? "x_min" : "y_min", "x_min", "z_min", "z_max", "inner", "outer"};
    Mesh mesh = mesh_grid({{count, along, through}, sides, position}, CellType::hex8, BlockPattern::quad);
    if (portion == Portion::full) close_ring(mesh, around);
    return mesh;
}

} // namespace osculate::mesh
