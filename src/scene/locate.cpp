#include "osculate/scene/locate.hpp"

#include "scene/overrides.hpp"
#include "scene/tree.hpp"

namespace osculate::scene {

std::vector<Fault> locate(std::vector<Fault> faults, const std::string& path, const std::vector<Override>& overrides) {
    std::vector<Fault> ignored; // the scene has been read before
    Tree tree = read_yaml(path, ignored);
    expand_short_forms(tree, ignored);
    for (const Override& change : overrides) apply(change, tree, ignored);
    for (Fault& fault : faults) {
        if (!fault.file.empty()) continue;
        Place place{path, 0, 0};
        const Tree* node = &tree;
        for (const std::string& name : split_path(fault.key)) {
            node = node->find(name);
            if (node == nullptr) break;
            const bool in_place = node->kind == Tree::Kind::scalar || node->place.file == override_file;
            place = in_place ? node->place : node->key_place; // a map or list starts at its key, for a reader
        }
        fault.file = place.file;
        fault.line = place.line;
        fault.column = place.column;
    }
    return faults;
}

} // namespace osculate::scene
