/// The mesh of an input deck, from any text.

#include "osculate/mesh/deck_mesh.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/mesh_file.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace osculate::mesh;
    try {
        const DeckMesh deck =
            read_deck_mesh(parse_deck(std::string(reinterpret_cast<const char*>(data), size), "deck"));
        MeshFileOptions options;
        options.repairs.wanted.fill(true);
        (void)make_mesh(deck.raw, options);
        (void)make_mesh(deck.raw);
    } catch (const MeshError&) { // as it should
    }
    return 0;
}
