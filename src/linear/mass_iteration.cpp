#include "osculate/linear/mass_iteration.hpp"

namespace osculate::linear {
namespace {

/// (equations) 1 / M_ii, 0 where there is no mass
Vector inverse_diagonal(const BlockMatrix& M, const Constraints& constraints) {
    Field diagonal(static_cast<std::size_t>(M.rows()));
    for (Index node = 0; node < M.rows(); ++node) {
        if (M.row_begin(node) == M.row_end(node)) continue;
        const Mat3& axes = constraints.frame(node);
        diagonal[static_cast<std::size_t>(node)] =
            (axes.transpose() * M.block(M.slot(node, node)) * axes).eval().diagonal();
    }
    if (M.share() != nullptr) M.share()->replicate(diagonal);
    Vector inverse = Vector::Zero(constraints.equations());
    for (Index node = 0; node < M.rows(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const double own = diagonal[static_cast<std::size_t>(node)](k); own != 0)
                if (const Index e = constraints.equation(node, k); e >= 0) inverse(e) = 1 / own;
    return inverse;
}

} // namespace

std::optional<Vector> iterate_by_mass(const BlockMatrix& M, const Constraints& constraints, const Vector& f,
                                      int threads) {
    constexpr double tolerance = 1e-14;
    constexpr int most = 500; // some 80 with hexahedra of any shape
    const auto nodes = static_cast<std::size_t>(constraints.nodes());
    const Field still(nodes);
    Field moved(nodes), pushed(nodes);
    const auto multiply = [&](const Vector& x, Vector& y) {
        constraints.scatter(x, still, moved);
        pushed.reset(nodes);
        M.multiply_add(moved, pushed, threads);
        constraints.gather(pushed, y);
    };
    const Vector scale = inverse_diagonal(M, constraints);
    Vector a = Vector::Zero(f.size()), left = (scale.array() != 0).select(f, 0), q(f.size());
    Vector p = scale.cwiseProduct(left);
    double slope = left.dot(p);
    const double enough = tolerance * left.norm();
    for (int iteration = 0; !(left.norm() <= enough); ++iteration) { // not a number: goes on, and ends below
        multiply(p, q);
        const double curvature = p.dot(q);
        if (!(curvature > 0) || iteration == most) return std::nullopt;
        a += slope / curvature * p;
        left -= slope / curvature * q;
        const Vector z = scale.cwiseProduct(left);
        const double next = left.dot(z);
        p = z + next / slope * p;
        slope = next;
    }
    return a;
}

} // namespace osculate::linear
