#pragma once
/// From a pair of the scene to the contact term that computes it.

#include "osculate/model/model.hpp"
#include "osculate/scene/scene.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace osculate::app {

/// None: contact is exact.
[[nodiscard]] std::optional<contact::Overclosure> law_of(const scene::PressureOverclosure& law);

/// @param model          bodies' positions and all sets
/// @param slave, master  sets with facets; the slave may have loose nodes alone
/// @param loose          see loose_slaves()
/// @param exterior       of the master's body, its own node numbers, where paths are to be followed; null: they are not
/// Throws std::runtime_error naming the nodes where the master is no oriented manifold.
[[nodiscard]] std::unique_ptr<const model::ContactPair>
make_contact_pair(const scene::Scene& scene, const std::string& name, const scene::Pair& spec,
                  const model::Model& model, const model::Set& slave, const model::Set& master,
                  const std::map<Index, Vec3>& loose, const std::vector<mesh::Facet>* exterior);

/// The outer surface of a body but for what lies in symmetry planes, by the scene's name of the body.
[[nodiscard]] model::Set outer_surface(const scene::Scene& scene, const model::Model& model, Index body);

/// The general contact of a scene, which has one: the outer surfaces of all bodies, except in symmetry planes.
/// @param skins    by body: outer surfaces with nodes of a skin, where faces have midside nodes
/// @param dynamic  whether a stage is dynamic
[[nodiscard]] std::unique_ptr<const model::GeneralContact>
make_general_contact(const scene::Scene& scene, const model::Model& model, const std::map<Index, model::Set>& skins,
                     bool dynamic);

} // namespace osculate::app
