/// Scenes from any text.

#include "osculate/core/error.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/scene/writer.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace osculate;
    try {
        const scene::Scene read =
            scene::parse_scene(std::string(reinterpret_cast<const char*>(data), size), "scene.yaml");
        (void)scene::write_scene(read);
    } catch (const SceneError&) { // as it should
    }
    return 0;
}
