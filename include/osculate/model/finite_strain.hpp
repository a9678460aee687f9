#pragma once
/// Bodies whose internal forces are no linear function of the displacements.

#include "osculate/model/block_matrix.hpp"

namespace osculate::fe {
class ElementKernel;
}

namespace osculate::model {

struct Body;

/// The element that is worst off, and how. Where it is not admissible the forces of that element are missing.
struct WorstElement {
    double J = 1; ///< least det F; <= 0: turned inside out, the displacements have no forces
    Index body = -1, element = -1;

    [[nodiscard]] bool admissible() const { return J > 0; }
};

/// Every element at finite strain, with its global nodes and its place in the stiffness.
/// Sums are in the order of the elements: bitwise the same for any number of threads.
class FiniteStrain {
public:
    /// @param pattern  holds every pair of nodes of an element; matrices of add_tangent() must have the same
    FiniteStrain(const std::vector<Body>& bodies, const BlockMatrix& pattern);

    /// f += f_int(u). X, u, f (nodes), m, m, N
    WorstElement add_internal_force(const std::vector<Vec3>& X, const std::vector<Vec3>& u, std::vector<Vec3>& f,
                                    int threads) const;
    /// K += factor df_int/du. Elements that are not admissible are left out.
    void add_tangent(const std::vector<Vec3>& X, const std::vector<Vec3>& u, double factor, BlockMatrix& K,
                     int threads) const;
    /// Strain energy, J.
    [[nodiscard]] double energy(const std::vector<Vec3>& X, const std::vector<Vec3>& u, int threads) const;

private:
    /// A block of equal elements.
    struct Block {
        const fe::ElementKernel* kernel = nullptr;
        Index body = -1, first_element = 0, size = 0; ///< first_element: number in its body
        std::vector<Index> node;                      ///< (size x n) global
        std::vector<Index> slot;                      ///< (size x n x n) of block (i, j) in the pattern, row by row
    };
    /// In batches: compute(k, X, u) for the k-th element of the batch, on several threads; then use(k, element), in order.
    template <class Compute, class Use>
    void for_each(const Block& block, const std::vector<Vec3>& X, const std::vector<Vec3>& u, int threads,
                  Compute&& compute, Use&& use) const;

    std::vector<Block> blocks_;
};

} // namespace osculate::model
