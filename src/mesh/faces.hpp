#pragma once
#include "osculate/mesh/mesh.hpp"

#include <algorithm>
#include <vector>

namespace osculate::mesh {

/// The faces of all elements of a mesh that outlives it, numbered by block, element and local face. Each is made when it is asked for, as
/// there are many.
class Faces {
public:
    explicit Faces(const Mesh& mesh) : mesh_(mesh) {
        for (const ElementBlock& block : mesh.blocks)
            first_.push_back(first_.back() + static_cast<std::size_t>(block.size()) * per_element(block));
    }
    [[nodiscard]] std::size_t size() const { return first_.back(); }
    [[nodiscard]] Facet operator[](std::size_t number) const {
        const auto b = static_cast<std::size_t>(std::ranges::upper_bound(first_, number) - first_.begin()) - 1;
        const std::size_t in_block = number - first_[b], per = per_element(mesh_.blocks[b]);
        return face(b, static_cast<Index>(in_block / per), in_block % per);
    }
    /// use(number, facet)
    template <class F> void for_each(F&& use) const {
        std::size_t number = 0;
        for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
            for (Index e = 0; e < mesh_.blocks[b].size(); ++e)
                for (std::size_t local = 0; local < per_element(mesh_.blocks[b]); ++local)
                    use(number++, face(b, e, local));
    }

private:
    [[nodiscard]] static std::size_t per_element(const ElementBlock& block) {
        return cell_info(block.type).facets.size();
    }
    [[nodiscard]] Facet face(std::size_t b, Index element, std::size_t number) const {
        const ElementBlock& block = mesh_.blocks[b];
        const LocalFace& local = cell_info(block.type).facets[number];
        const Index* const nodes =
            block.connectivity.data() + static_cast<std::ptrdiff_t>(element) * nodes_per_cell(block.type);
        Facet facet{{-1, -1, -1, -1}, local.count, static_cast<Index>(b), element};
        for (int i = 0; i < local.count; ++i) facet.nodes[i] = nodes[local.nodes[i]];
        return facet;
    }

    const Mesh& mesh_;
    std::vector<std::size_t> first_{0}; ///< by block
};

} // namespace osculate::mesh
