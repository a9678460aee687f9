#include "osculate/model/finite_strain.hpp"

#include "osculate/core/parallel.hpp"
#include "osculate/model/model.hpp"

namespace osculate::model {

namespace {
constexpr Index batch = 256; ///< elements computed before they are added up: 1 MB of hexahedral tangents
}

FiniteStrain::FiniteStrain(const std::vector<Body>& bodies, const linear::BlockMatrix& pattern) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        Index first = 0;
        for (std::size_t k = 0; k < bodies[b].mesh.blocks.size(); ++k) {
            const mesh::ElementBlock& elements = bodies[b].mesh.blocks[k];
            const Index begin = first;
            first += elements.size();
            if (bodies[b].kernels[k]->linear()) continue;
            Block& block = blocks_.emplace_back();
            block.kernel = bodies[b].kernels[k].get();
            block.body = static_cast<Index>(b);
            block.first_element = begin;
            block.size = elements.size();
            for (const Index local : elements.connectivity) block.node.push_back(bodies[b].first_node + local);
            const Index n = block.kernel->nodes();
            Matrix Ke(3 * n, 3 * n);
            for (Index e = 0; e < block.size; ++e) {
                Eigen::Matrix3Xd X(3, n);
                for (Index i = 0; i < n; ++i)
                    X.col(i) = bodies[b].mesh.nodes[static_cast<std::size_t>(elements.connectivity[e * n + i])];
                block.kernel->stiffness(X, Ke);
                largest_stiffness_ = std::max(largest_stiffness_, Ke.diagonal().maxCoeff());
                for (Index i = 0; i < n; ++i)
                    for (Index j = 0; j < n; ++j)
                        block.slot.push_back(pattern.slot(block.node[static_cast<std::size_t>(e * n + i)],
                                                          block.node[static_cast<std::size_t>(e * n + j)]));
            }
        }
    }
}

template <class Compute, class Use>
void FiniteStrain::for_each(const Block& block, int threads, Compute&& compute, Use&& use) {
    for (Index first = 0; first < block.size; first += batch) {
        const Index count = std::min(batch, block.size - first);
        parallel_for(threads, count, [&](Index begin, Index end) {
            for (Index k = begin; k < end; ++k) compute(k, first + k);
        });
        for (Index k = 0; k < count; ++k) use(k, first + k);
    }
}

FiniteStrain::ElementValues FiniteStrain::gather(const Block& block, Index element, const std::vector<Vec3>& values) {
    const Index n = block.kernel->nodes();
    ElementValues local(3, n);
    for (Index i = 0; i < n; ++i) local.col(i) = values[static_cast<std::size_t>(block.node[element * n + i])];
    return local;
}

template <class Kernel>
WorstElement FiniteStrain::add_forces(std::vector<Vec3>& f, int threads, Kernel&& kernel) const {
    WorstElement worst;
    for (const Block& block : blocks_) {
        const Index n = block.kernel->nodes();
        std::vector<Eigen::Matrix3Xd> forces(batch, Eigen::Matrix3Xd(3, n));
        std::vector<fe::Deformation> deformation(batch);
        for_each(
            block, threads, [&](Index k, Index e) { deformation[k] = kernel(block, e, forces[k]); },
            [&](Index k, Index e) {
                for (Index i = 0; i < n; ++i) f[static_cast<std::size_t>(block.node[e * n + i])] += forces[k].col(i);
                if (deformation[k].smallest_J < worst.J)
                    worst = {deformation[k].smallest_J, block.body, block.first_element + e};
            });
    }
    return worst;
}

template <class Kernel> void FiniteStrain::add_tangents(linear::BlockMatrix& K, int threads, Kernel&& kernel) const {
    for (const Block& block : blocks_) {
        const Index n = block.kernel->nodes();
        std::vector<Matrix> tangent(batch, Matrix(3 * n, 3 * n));
        for_each(
            block, threads, [&](Index k, Index e) { (void)kernel(block, e, tangent[k]); },
            [&](Index k, Index e) {
                const Index* slot = &block.slot[static_cast<std::size_t>(e * n * n)];
                for (Index i = 0; i < n; ++i)
                    for (Index j = 0; j < n; ++j) K.block(slot[i * n + j]) += tangent[k].block<3, 3>(3 * i, 3 * j);
            });
    }
}

WorstElement FiniteStrain::add_internal_force(const std::vector<Vec3>& X, const std::vector<Vec3>& u,
                                              std::vector<Vec3>& f, int threads) const {
    return add_forces(f, threads, [&](const Block& block, Index e, Eigen::Matrix3Xd& fe) {
        return block.kernel->internal_force(gather(block, e, X), gather(block, e, u), fe);
    });
}

void FiniteStrain::add_tangent(const std::vector<Vec3>& X, const std::vector<Vec3>& u, linear::BlockMatrix& K,
                               int threads) const {
    add_tangents(K, threads, [&](const Block& block, Index e, Matrix& Ke) {
        return block.kernel->tangent(gather(block, e, X), gather(block, e, u), Ke);
    });
}

WorstElement FiniteStrain::add_step_force(const std::vector<Vec3>& X, const std::vector<Vec3>& u0,
                                          const std::vector<Vec3>& u1, const fe::StepMean& mean, std::vector<Vec3>& f,
                                          int threads) const {
    return add_forces(f, threads, [&](const Block& block, Index e, Eigen::Matrix3Xd& fe) {
        return block.kernel->step_force(gather(block, e, X), gather(block, e, u0), gather(block, e, u1), mean, fe);
    });
}

void FiniteStrain::add_step_tangent(const std::vector<Vec3>& X, const std::vector<Vec3>& u0,
                                    const std::vector<Vec3>& u1, const fe::StepMean& mean, linear::BlockMatrix& K,
                                    int threads) const {
    add_tangents(K, threads, [&](const Block& block, Index e, Matrix& Ke) {
        return block.kernel->step_tangent(gather(block, e, X), gather(block, e, u0), gather(block, e, u1), mean, Ke);
    });
}

double FiniteStrain::energy(const std::vector<Vec3>& X, const std::vector<Vec3>& u, int threads) const {
    double sum = 0;
    for (const Block& block : blocks_) {
        std::vector<double> W(batch);
        for_each(
            block, threads,
            [&](Index k, Index e) { (void)block.kernel->energy(gather(block, e, X), gather(block, e, u), W[k]); },
            [&](Index k, Index) { sum += W[k]; });
    }
    return sum;
}

} // namespace osculate::model
