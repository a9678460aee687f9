#pragma once
/// Which material is where in a body.

#include "osculate/model/model.hpp"
#include "osculate/scene/scene.hpp"

namespace osculate::app {

/// @param section  mesh::ElementBlock::section
[[nodiscard]] inline const scene::Material& material_of(const scene::Body& body, int section) {
    return section == 0 ? body.material : body.sections[static_cast<std::size_t>(section) - 1].second.material;
}

/// Young's modulus of the softest elements under facets of a body, Pa; of the body's own material without facets.
[[nodiscard]] inline double modulus_under(const scene::Body& spec, const model::Body& body,
                                          const std::vector<mesh::Facet>& facets) {
    double E = 0;
    for (const mesh::Facet& facet : facets) {
        if (facet.block < 0) continue; // of no element
        const int section = body.mesh.blocks[static_cast<std::size_t>(facet.block)].section;
        const double own = scene::elastic(material_of(spec, section)).E;
        E = E == 0 ? own : std::min(E, own);
    }
    return E == 0 ? scene::elastic(spec.material).E : E;
}

/// The same of the elements around a node. @param node  global
[[nodiscard]] inline double modulus_at(const scene::Body& spec, const model::Body& body, Index node) {
    if (spec.sections.empty()) return scene::elastic(spec.material).E;
    double E = 0;
    for (const mesh::ElementBlock& block : body.mesh.blocks) {
        if (std::ranges::find(block.connectivity, node - body.first_node) == block.connectivity.end()) continue;
        const double own = scene::elastic(material_of(spec, block.section)).E;
        E = E == 0 ? own : std::min(E, own);
    }
    return E;
}

} // namespace osculate::app
