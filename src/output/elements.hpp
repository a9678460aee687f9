#pragma once
/// Elements of a body by number, and their shape functions by type.

#include "osculate/fe/with_element.hpp"
#include "osculate/model/model.hpp"

#include <span>
#include <utility>
#include <vector>

namespace osculate::output {

/// An element of a body.
struct ElementOf {
    Index block = 0, number = 0; ///< of the body's mesh; number within the block
};

/// Its nodes, local to the body.
[[nodiscard]] inline std::vector<Index> nodes_of(const model::Body& body, const ElementOf& element) {
    const mesh::ElementBlock& block = body.mesh.blocks[static_cast<std::size_t>(element.block)];
    const auto n = static_cast<std::size_t>(nodes_per_cell(block.type));
    const auto first = block.connectivity.begin() + static_cast<std::ptrdiff_t>(n) * element.number;
    return {first, first + static_cast<std::ptrdiff_t>(n)};
}

/// Reference positions of those nodes, 3 x n, m.
[[nodiscard]] inline Eigen::Matrix3Xd positions_of(const model::Body& body, const std::vector<Index>& nodes) {
    Eigen::Matrix3Xd X(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i)
        X.col(static_cast<Eigen::Index>(i)) = body.mesh.nodes[static_cast<std::size_t>(nodes[i])];
    return X;
}

/// Their displacements, 3 x n, m. @param u  of all nodes
[[nodiscard]] inline Eigen::Matrix3Xd displacements_of(const model::Body& body, const std::vector<Index>& nodes,
                                                       const std::vector<Vec3>& u) {
    Eigen::Matrix3Xd ue(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i)
        ue.col(static_cast<Eigen::Index>(i)) = u[static_cast<std::size_t>(body.first_node + nodes[i])];
    return ue;
}

/// What an element carries in a state.
[[nodiscard]] inline std::span<const double> history_of(const model::Model& model, Index body, const ElementOf& element,
                                                        const model::State& state) {
    const model::Body& own = model.bodies[static_cast<std::size_t>(body)];
    std::size_t first = model::history_place(model.bodies, static_cast<std::size_t>(body)).first;
    for (std::size_t b = 0; b < static_cast<std::size_t>(element.block); ++b)
        first += own.kernels[b]->history_size() * static_cast<std::size_t>(own.mesh.blocks[b].size());
    const std::size_t size = own.kernels[static_cast<std::size_t>(element.block)]->history_size();
    return std::span(state.material).subspan(first + static_cast<std::size_t>(element.number) * size, size);
}

/// f(element) for every element of a body, or for some.
/// @param chosen  (elements) empty: all
template <class F> void for_each_element(const model::Body& body, std::span<const char> chosen, F&& f) {
    std::size_t number = 0;
    for (std::size_t b = 0; b < body.mesh.blocks.size(); ++b)
        for (Index e = 0; e < body.mesh.blocks[b].size(); ++e, ++number)
            if (chosen.empty() || chosen[number] != 0) f(ElementOf{static_cast<Index>(b), e});
}

template <class F> void for_each_element(const model::Body& body, F&& f) {
    for_each_element(body, {}, std::forward<F>(f));
}

} // namespace osculate::output
