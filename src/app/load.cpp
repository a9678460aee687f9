#include "osculate/app/load.hpp"

#include "osculate/core/error.hpp"
#include "osculate/scene/locate.hpp"

namespace osculate::app {

LoadedScene load(const std::string& path, const std::vector<scene::Override>& overrides, int threads,
                 Timings& timings) {
    LoadedScene loaded{scene::read_scene(path, overrides), {}, path};
    try {
        std::vector<std::string> notes;
        loaded.plan = compile(loaded.scene, build_meshes(loaded.scene, &notes), threads, timings);
        loaded.plan.mesh_notes = std::move(notes);
    } catch (const SceneError& error) {
        throw SceneError(scene::locate(error.faults(), path, overrides));
    }
    return loaded;
}

} // namespace osculate::app
