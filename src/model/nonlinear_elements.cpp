#include "osculate/model/nonlinear_elements.hpp"

#include "osculate/core/parallel.hpp"
#include "osculate/model/model.hpp"

#include <algorithm>
#include <array>

namespace osculate::model {

namespace {
/// Elements computed before they are added up: 1 MB of tangents of eight nodes.
constexpr Index most_at_once = 256;

/// (3 x n), on the stack.
using ElementValues = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, mesh::most_nodes_per_cell>;

/// Values of the nodes of an element.
ElementValues gather(const Index* nodes, Index n, const Field& values) {
    ElementValues local(3, n);
    for (Index i = 0; i < n; ++i) local.col(i) = values[static_cast<std::size_t>(nodes[i])];
    return local;
}
} // namespace

HistoryPlace history_place(const std::vector<Body>& bodies, std::size_t body) {
    HistoryPlace place;
    for (std::size_t b = 0; b <= body; ++b) {
        place.first += place.size;
        place.size = 0;
        for (std::size_t k = 0; k < bodies[b].kernels.size(); ++k)
            place.size +=
                bodies[b].kernels[k]->history_size() * static_cast<std::size_t>(bodies[b].mesh.blocks[k].size());
    }
    return place;
}

std::span<const double> NonlinearElements::Block::history(const MaterialHistory& all, Index element) const {
    if (history_size == 0) return {};
    return std::span(all).subspan(history_first + static_cast<std::size_t>(element) * history_size, history_size);
}

NonlinearElements::NonlinearElements(const std::vector<Body>& bodies, const linear::BlockMatrix& pattern,
                                     std::shared_ptr<const Share> share)
    : share_(std::move(share)) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        Index first = 0;
        std::size_t history = history_place(bodies, b).first;
        for (std::size_t k = 0; k < bodies[b].mesh.blocks.size(); ++k) {
            const mesh::ElementBlock& elements = bodies[b].mesh.blocks[k];
            const Index begin = first;
            first += elements.size();
            if (bodies[b].kernels[k]->linear()) continue;
            Block& block = blocks_.emplace_back();
            block.kernel = bodies[b].kernels[k].get();
            block.body = static_cast<Index>(b);
            block.first_element = begin;
            block.expansion = block.kernel->heated() ? bodies[b].expansion[k] : 0;
            block.size = elements.size();
            block.history_first = history;
            block.history_size = block.kernel->history_size();
            history += block.history_size * static_cast<std::size_t>(block.size);
            for (const Index local : elements.connectivity) block.node.push_back(bodies[b].first_node + local);
            const Index n = block.kernel->nodes();
            Matrix Ke(3 * n, 3 * n);
            for (Index e = 0; e < block.size; ++e) {
                const std::span nodes(&block.node[static_cast<std::size_t>(e * n)], static_cast<std::size_t>(n));
                if (std::ranges::none_of(nodes, [&](Index node) { return pattern.has_row(node); })) continue;
                block.here.push_back(e);
                Eigen::Matrix3Xd X(3, n);
                for (Index i = 0; i < n; ++i)
                    X.col(i) = bodies[b].mesh.nodes[static_cast<std::size_t>(elements.connectivity[e * n + i])];
                block.kernel->stiffness(X, Ke);
                largest_stiffness_ = std::max(largest_stiffness_, Ke.diagonal().maxCoeff());
                for (const Index row : nodes)
                    for (const Index column : nodes)
                        block.slot.push_back(pattern.has_row(row) ? pattern.slot(row, column) : -1);
            }
        }
    }
}

template <class Compute, class Use>
void NonlinearElements::for_each(Index count, int threads, Compute&& compute, Use&& use) {
    for (Index first = 0; first < count; first += most_at_once) {
        const Index batch = std::min(most_at_once, count - first);
        parallel_for(threads, batch, [&](Index begin, Index end) {
            for (Index k = begin; k < end; ++k) compute(k, first + k);
        });
        for (Index k = 0; k < batch; ++k) use(k, first + k);
    }
}

template <class Act>
decltype(auto) NonlinearElements::with_step(const Block& block, Index element, const Field& X, const BodyStep& step,
                                            Act&& act) {
    const Index n = block.kernel->nodes();
    const Index* nodes = &block.node[static_cast<std::size_t>(element) * static_cast<std::size_t>(n)];
    const ElementValues local_X = gather(nodes, n, X), u = gather(nodes, n, step.u);
    // where nothing of an element lasts, its forces at the end do not ask for the start
    const bool starts = step.mean.has_value() || block.history_size > 0;
    const ElementValues u_start = starts ? gather(nodes, n, step.u_start) : ElementValues(3, 0);
    return act(fe::ElementStep{local_X, u_start, u, block.history(step.history_start, element), step.mean});
}

WorstElement NonlinearElements::add_force(const Field& X, const BodyStep& step, Field& f, int threads) const {
    if (share_ == nullptr) return add_own_force(X, step, f, threads);
    Field own(f.size());
    const WorstElement here = add_own_force(X, step, own, threads);
    share_->replicate(own);
    f.add(1, own);
    const double found[] = {here.J, static_cast<double>(here.body), static_cast<double>(here.element)};
    const auto ranks = static_cast<std::size_t>(share_->ranks().count());
    std::vector<double> all(std::size(found) * ranks);
    share_->ranks().gather(found, std::vector<int>(ranks, std::size(found)), all.data());
    std::array<double, 3> worst{all[0], all[1], all[2]};
    for (std::size_t r = 1; r < ranks; ++r) worst = std::min(worst, {all[3 * r], all[3 * r + 1], all[3 * r + 2]});
    return {worst[0], static_cast<Index>(worst[1]), static_cast<Index>(worst[2])};
}

WorstElement NonlinearElements::add_own_force(const Field& X, const BodyStep& step, Field& f, int threads) const {
    WorstElement worst;
    for (const Block& block : blocks_) {
        const auto count = static_cast<Index>(block.here.size());
        const Index n = block.kernel->nodes(), batch = std::min(most_at_once, count);
        std::vector<Eigen::Matrix3Xd> forces(batch, Eigen::Matrix3Xd(3, n));
        std::vector<fe::Deformation> deformation(batch);
        MaterialHistory unused(batch * block.history_size);
        for_each(
            count, threads,
            [&](Index k, Index number) {
                const std::span history(unused.data() + k * block.history_size, block.history_size);
                deformation[k] = with_step(block, block.here[number], X, step, [&](const fe::ElementStep& element) {
                    return block.kernel->update(element, history, forces[k]);
                });
            },
            [&](Index k, Index number) {
                const Index e = block.here[number];
                for (Index i = 0; i < n; ++i) f[static_cast<std::size_t>(block.node[e * n + i])] += forces[k].col(i);
                if (deformation[k].smallest_J < worst.J)
                    worst = {deformation[k].smallest_J, block.body, block.first_element + e};
            });
    }
    return worst;
}

void NonlinearElements::add_tangent(const Field& X, const BodyStep& step, linear::BlockMatrix& K, int threads) const {
    for (const Block& block : blocks_) {
        const auto count = static_cast<Index>(block.here.size());
        const Index n = block.kernel->nodes(), batch = std::min(most_at_once, count);
        std::vector<Matrix> tangent(batch, Matrix(3 * n, 3 * n));
        for_each(
            count, threads,
            [&](Index k, Index number) {
                (void)with_step(block, block.here[number], X, step, [&](const fe::ElementStep& element) {
                    return block.kernel->tangent(element, tangent[k]);
                });
            },
            [&](Index k, Index number) {
                const Index* slot = &block.slot[static_cast<std::size_t>(number) * static_cast<std::size_t>(n * n)];
                for (Index i = 0; i < n; ++i)
                    for (Index j = 0; j < n && slot[i * n] >= 0; ++j)
                        K.block(slot[i * n + j]) += tangent[k].block<3, 3>(3 * i, 3 * j);
            });
    }
}

MaterialHistory NonlinearElements::history(const Field& X, const BodyStep& step, int threads) const {
    MaterialHistory end(step.history_start.size());
    for (const Block& block : blocks_) {
        if (block.history_size == 0) continue;
        parallel_for(threads, block.size, [&](Index begin, Index stop) {
            Eigen::Matrix3Xd f(3, block.kernel->nodes());
            for (Index e = begin; e < stop; ++e) {
                const std::span own =
                    std::span(end).subspan(block.history_first + e * block.history_size, block.history_size);
                (void)with_step(block, e, X, step,
                                [&](const fe::ElementStep& element) { return block.kernel->update(element, own, f); });
            }
        });
    }
    return end;
}

double NonlinearElements::energy(const Field& X, const Field& u, const MaterialHistory& history, int threads) const {
    double sum = 0;
    for (const Block& block : blocks_) {
        const Index n = block.kernel->nodes();
        std::vector<double> W(std::min(most_at_once, block.size));
        for_each(
            block.size, threads,
            [&](Index k, Index e) {
                const Index* nodes = &block.node[static_cast<std::size_t>(e) * static_cast<std::size_t>(n)];
                (void)block.kernel->energy({gather(nodes, n, X), gather(nodes, n, u), block.history(history, e)}, W[k]);
            },
            [&](Index k, Index) { sum += W[k]; });
    }
    return sum;
}

void NonlinearElements::heat(const std::vector<double>& temperature, MaterialHistory& history) const {
    for (const Block& block : blocks_) {
        if (block.expansion == 0) continue;
        const auto n = static_cast<std::size_t>(block.kernel->nodes());
        std::vector<double> strain(n);
        for (Index e = 0; e < block.size; ++e) {
            for (std::size_t i = 0; i < n; ++i)
                strain[i] = block.expansion *
                            temperature[static_cast<std::size_t>(block.node[static_cast<std::size_t>(e) * n + i])];
            block.kernel->heat(
                strain, std::span(history).subspan(block.history_first + e * block.history_size, block.history_size));
        }
    }
}

double NonlinearElements::dissipated(const Field& X, const MaterialHistory& history) const {
    double sum = 0;
    for (const Block& block : blocks_) {
        if (block.history_size == 0) continue;
        const Index n = block.kernel->nodes();
        for (Index e = 0; e < block.size; ++e) {
            const ElementValues at =
                gather(&block.node[static_cast<std::size_t>(e) * static_cast<std::size_t>(n)], n, X);
            sum += block.kernel->dissipated({at, at, block.history(history, e)});
        }
    }
    return sum;
}

} // namespace osculate::model
