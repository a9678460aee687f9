#pragma once
/// What checks of several keys share.

#include "osculate/scene/scene.hpp"
#include "scene/describe_parts.hpp"
#include "scene/tree.hpp"

namespace osculate::scene {

/// Puts faults where the tree has their keys.
class Rules {
public:
    Rules(const Tree& tree, std::vector<Fault>& faults) : tree_(tree), faults_(faults) {}

    /// Whether the scene's file has a key.
    [[nodiscard]] bool has(const std::vector<std::string>& path) const {
        const Tree* node = &tree_;
        for (const std::string& part : path)
            if (node = node->find(part); node == nullptr) return false;
        return true;
    }
    void fault(const std::vector<std::string>& path, std::string expected, std::string found) {
        faults_.push_back(fault_at(deepest(path)->place, join(path, "."), std::move(expected), std::move(found)));
    }

protected:
    /// The deepest part of a path that the tree has.
    [[nodiscard]] const Tree* deepest(const std::vector<std::string>& path) const {
        const Tree* node = &tree_;
        for (const std::string& part : path) {
            const Tree* child = node->find(part);
            if (!child) break;
            node = child;
        }
        return node;
    }

    const Tree& tree_;
    std::vector<Fault>& faults_;
};

/// Rules of bodies: of their meshes, materials and rigid bodies.
void check_bodies(const Scene& scene, const Tree& tree, std::vector<Fault>& faults);
/// Rules of contact pairs and general contact.
void check_contact(const Scene& scene, const Tree& tree, std::vector<Fault>& faults);

} // namespace osculate::scene
