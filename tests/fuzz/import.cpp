/// Scenes from input decks, which are then read as scenes.

#include "osculate/core/error.hpp"
#include "osculate/deck/import_deck.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/scene/reader.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

/// All but what the deck itself may have wrong: a value out of range, a file that is not there.
bool is_of_the_deck(const osculate::Fault& fault) {
    return fault.expected.find("a file that exists") != std::string::npos || !fault.key.empty();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace osculate;
    std::string text;
    try {
        const mesh::Deck deck = mesh::parse_deck(std::string(reinterpret_cast<const char*>(data), size), "deck.inp");
        text = deck::import_deck(deck, "deck.inp", deck::DeckUnits::mm).text;
    } catch (const mesh::MeshError&) { // as it should
        return 0;
    }
    try {
        (void)scene::parse_scene(text, "imported.yaml");
    } catch (const SceneError& error) {
        for (const Fault& fault : error.faults())
            if (!is_of_the_deck(fault)) std::abort(); // no YAML
    }
    return 0;
}
