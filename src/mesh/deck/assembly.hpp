#pragma once
/// Decks of Abaqus with parts, instances and an assembly.

#include "osculate/mesh/deck.hpp"

namespace osculate::mesh {

/// Writes out the instances of a deck's parts; a deck without any is returned as it is. Nodes and elements of the assembly
/// keep their numbers; those of the instances follow, by default from a power of ten times 1, 2, ... on. Throws MeshError with
/// all faults.
[[nodiscard]] Deck without_parts(Deck deck);

} // namespace osculate::mesh
