#include "osculate/app/load.hpp"

#include "osculate/core/error.hpp"
#include "osculate/scene/locate.hpp"

namespace osculate::app {

LoadedScene load(const std::string& path, const std::vector<scene::Override>& overrides, int threads, Timings& timings,
                 const std::shared_ptr<Ranks>& ranks) {
    LoadedScene loaded{scene::read_scene(path, overrides), {}, path};
    try {
        loaded.plan = compile(loaded.scene, threads, timings, ranks);
    } catch (const SceneError& error) {
        throw SceneError(scene::locate(error.faults(), path, overrides));
    }
    return loaded;
}

} // namespace osculate::app
