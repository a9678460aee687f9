#pragma once
/// Bodies whose internal forces are no linear function of the displacements.

#include "osculate/linear/block_matrix.hpp"

namespace osculate::fe {
class ElementKernel;
struct StepMean;
} // namespace osculate::fe

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
    FiniteStrain(const std::vector<Body>& bodies, const linear::BlockMatrix& pattern);

    /// f += f_int(u). X, u, f (nodes), m, m, N.
    WorstElement add_internal_force(const std::vector<Vec3>& X, const std::vector<Vec3>& u, std::vector<Vec3>& f,
                                    int threads) const;
    /// K += df_int/du. Elements that are not admissible are left out.
    void add_tangent(const std::vector<Vec3>& X, const std::vector<Vec3>& u, linear::BlockMatrix& K, int threads) const;
    /// The forces of a step from u0 to u1, see fe::ElementKernel::step_force, and their derivative by u1.
    WorstElement add_step_force(const std::vector<Vec3>& X, const std::vector<Vec3>& u0, const std::vector<Vec3>& u1,
                                const fe::StepMean& mean, std::vector<Vec3>& f, int threads) const;
    void add_step_tangent(const std::vector<Vec3>& X, const std::vector<Vec3>& u0, const std::vector<Vec3>& u1,
                          const fe::StepMean& mean, linear::BlockMatrix& K, int threads) const;
    /// Largest diagonal entry of an undeformed element's stiffness, N/m.
    [[nodiscard]] double largest_stiffness() const { return largest_stiffness_; }
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
    /// In batches: compute(k, element) for the k-th element of the batch, on several threads; then use(k, element), in
    /// order.
    template <class Compute, class Use>
    static void for_each(const Block& block, int threads, Compute&& compute, Use&& use);
    /// (3 x n), on the stack: an element has ten nodes at the most.
    using ElementValues = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 10>;
    /// Values of the nodes of an element.
    static ElementValues gather(const Block& block, Index element, const std::vector<Vec3>& values);
    template <class Kernel> WorstElement add_forces(std::vector<Vec3>& f, int threads, Kernel&& kernel) const;
    template <class Kernel> void add_tangents(linear::BlockMatrix& K, int threads, Kernel&& kernel) const;

    std::vector<Block> blocks_;
    double largest_stiffness_ = 0;
};

} // namespace osculate::model
