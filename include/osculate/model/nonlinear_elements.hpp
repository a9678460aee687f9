#pragma once
/// Elements whose internal forces are a nonlinear function of the displacements.

#include "osculate/core/field.hpp"
#include "osculate/fe/element_block.hpp"
#include "osculate/linear/block_matrix.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::model {

struct Body;

/// The element with the least det F. If it is not admissible, the forces of this element are missing.
struct WorstElement {
    double J = 1; ///< least det F; <= 0: inside out, no forces exist for these displacements
    Index body = -1, element = -1;

    [[nodiscard]] bool admissible() const { return J > 0; }
};

/// Histories of all elements from step to step: as many numbers as their kernels say, in the order of bodies, blocks
/// and elements. Zeros in the undeformed initial state; empty if no element has a history.
using MaterialHistory = std::vector<double>;

/// A step of all bodies; or a state, as a step of zero length from itself.
struct BodyStep {
    const Field &u_start, &u; ///< (nodes) displacements at its two ends, m
    const MaterialHistory& history_start;
    std::optional<fe::StepMean> mean{}; ///< forces averaged over the step, in dynamics; none: forces at its end
};

/// The nonlinear elements of all bodies, with their global nodes and their positions in the stiffness. Sums are made in
/// the order of the elements: bitwise the same for any number of threads. Where processes share the rows of the stiffness, each
/// computes the forces and tangents of elements at its own nodes; forces are of all nodes on all processes.
class NonlinearElements {
public:
    /// @param pattern  contains every pair of nodes of an element; matrices of add_tangent() must have the same pattern
    /// @param share    of the pattern's rows; null: there is one process
    NonlinearElements(const std::vector<Body>& bodies, const linear::BlockMatrix& pattern,
                      std::shared_ptr<const Share> share = nullptr);

    /// f += internal forces of a step, see fe::ElementKernel::update. X (nodes) m, f (nodes) N.
    WorstElement add_force(const Field& X, const BodyStep& step, Field& f, int threads) const;
    /// K += derivative of these forces by the displacements at the step's end, without elements that are not
    /// admissible.
    void add_tangent(const Field& X, const BodyStep& step, linear::BlockMatrix& K, int threads) const;
    /// The histories at the step's end; empty if no element has a history.
    [[nodiscard]] MaterialHistory history(const Field& X, const BodyStep& step, int threads) const;
    /// Energy stored in a state, J.
    [[nodiscard]] double energy(const Field& X, const Field& u, const MaterialHistory& history, int threads) const;
    /// Work that materials have dissipated until a state, J.
    [[nodiscard]] double dissipated(const Field& X, const MaterialHistory& history) const;
    /// Gives elements the thermal strains of temperatures, in a history of theirs.
    /// @param temperature  (nodes) above that without thermal strain, K
    void heat(const std::vector<double>& temperature, MaterialHistory& history) const;
    /// Largest diagonal entry of the stiffness of an undeformed element on this process, N/m.
    [[nodiscard]] double largest_stiffness() const { return largest_stiffness_; }

private:
    /// A block of elements of the same kind.
    struct Block {
        const fe::ElementKernel* kernel = nullptr;
        double expansion = 0;                            ///< thermal, 1/K
        Index body = -1, first_element = 0, size = 0;    ///< first_element: number in its body
        std::size_t history_first = 0, history_size = 0; ///< start for the first element; numbers per element
        std::vector<Index> node;                         ///< (size x n) global
        std::vector<Index> here;                         ///< elements of nodes with a row on this process, ascending
        std::vector<Index>
            slot; ///< (here x n x n) of block (i, j) in the pattern, row by row; -1: the row is elsewhere

        [[nodiscard]] std::span<const double> history(const MaterialHistory& all, Index element) const;
    };
    /// In batches: calls compute(k, number) for the k-th of the batch of `count` numbers, on several threads; then use(k, number), in
    /// order.
    template <class Compute, class Use> static void for_each(Index count, int threads, Compute&& compute, Use&& use);
    /// Calls act(fe::ElementStep) for an element of a step.
    template <class Act>
    static decltype(auto) with_step(const Block& block, Index element, const Field& X, const BodyStep& step, Act&& act);

    /// f += forces at one's own nodes.
    WorstElement add_own_force(const Field& X, const BodyStep& step, Field& f, int threads) const;

    std::vector<Block> blocks_;
    std::shared_ptr<const Share> share_; ///< of rows; null: there is one process
    double largest_stiffness_ = 0;
};

/// Position and count of the history numbers of a body's elements in a MaterialHistory.
struct HistoryPlace {
    std::size_t first = 0, size = 0;
};
[[nodiscard]] HistoryPlace history_place(const std::vector<Body>& bodies, std::size_t body);

} // namespace osculate::model
