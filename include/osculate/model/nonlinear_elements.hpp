#pragma once
/// Elements whose internal forces are no linear function of the displacements.

#include "osculate/core/field.hpp"
#include "osculate/fe/element_block.hpp"
#include "osculate/linear/block_matrix.hpp"

#include <optional>
#include <span>
#include <vector>

namespace osculate::model {

struct Body;

/// The element that is worst off, and how. Where it is not admissible the forces of that element are missing.
struct WorstElement {
    double J = 1; ///< least det F; <= 0: turned inside out, the displacements have no forces
    Index body = -1, element = -1;

    [[nodiscard]] bool admissible() const { return J > 0; }
};

/// What elements carry from step to step: so many numbers each, as their kernels say, in the order of bodies, blocks and
/// elements. Zeros before anything has happened; empty where no element has a past.
using MaterialHistory = std::vector<double>;

/// A step of all bodies, or a state: a step of no length, from itself.
struct BodyStep {
    const Field &u_start, &u; ///< (nodes) displacements at its two ends, m
    const MaterialHistory& history_start;
    std::optional<fe::StepMean> mean{}; ///< forces averaged over the step, in dynamics; none: those at its end
};

/// The nonlinear elements of all bodies, with their global nodes and their places in the stiffness.
/// Sums are in the order of the elements: bitwise the same for any number of threads.
class NonlinearElements {
public:
    /// @param pattern  holds every pair of nodes of an element; matrices of add_tangent() must have the same
    NonlinearElements(const std::vector<Body>& bodies, const linear::BlockMatrix& pattern);

    /// f += internal forces of a step, see fe::ElementKernel::update. X (nodes) m, f (nodes) N.
    WorstElement add_force(const Field& X, const BodyStep& step, Field& f, int threads) const;
    /// K += their derivative by the displacements at its end. Elements that are not admissible are left out.
    void add_tangent(const Field& X, const BodyStep& step, linear::BlockMatrix& K, int threads) const;
    /// The histories at its end; empty where no element has a past.
    [[nodiscard]] MaterialHistory history(const Field& X, const BodyStep& step, int threads) const;
    /// Energy stored in a state, J.
    [[nodiscard]] double energy(const Field& X, const Field& u, const MaterialHistory& history, int threads) const;
    /// Largest diagonal entry of an undeformed element's stiffness, N/m.
    [[nodiscard]] double largest_stiffness() const { return largest_stiffness_; }

private:
    /// A block of equal elements.
    struct Block {
        const fe::ElementKernel* kernel = nullptr;
        Index body = -1, first_element = 0, size = 0;    ///< first_element: number in its body
        std::size_t history_first = 0, history_size = 0; ///< of its first element, and of each
        std::vector<Index> node;                         ///< (size x n) global
        std::vector<Index> slot;                         ///< (size x n x n) of block (i, j) in the pattern, row by row

        [[nodiscard]] std::span<const double> history(const MaterialHistory& all, Index element) const;
    };
    /// In batches: compute(k, element) for the k-th element of the batch, on several threads; then use(k, element), in
    /// order.
    template <class Compute, class Use>
    static void for_each(const Block& block, int threads, Compute&& compute, Use&& use);
    /// Calls act(fe::ElementStep) for an element of a step.
    template <class Act>
    static decltype(auto) with_step(const Block& block, Index element, const Field& X, const BodyStep& step, Act&& act);

    std::vector<Block> blocks_;
    double largest_stiffness_ = 0;
};

/// Numbers that a body's elements carry, and where they are in a MaterialHistory.
struct HistoryPlace {
    std::size_t first = 0, size = 0;
};
[[nodiscard]] HistoryPlace history_place(const std::vector<Body>& bodies, std::size_t body);

} // namespace osculate::model
