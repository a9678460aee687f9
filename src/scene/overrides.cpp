#include "scene/overrides.hpp"

#include "osculate/core/printable.hpp"

namespace osculate::scene {

namespace {

/// Places of an override: the file is "--set" and no line of it means anything.
void set_place(Tree& tree) {
    tree.place = tree.key_place = {override_file, 0, 0};
    for (Tree& child : tree.children) set_place(child);
}

Tree implied_map(const std::string& key) {
    Tree map{.kind = Tree::Kind::map, .key = key, .implied = true};
    set_place(map);
    return map;
}

} // namespace

std::vector<std::string> split_path(const std::string& path) {
    std::vector<std::string> parts(1);
    for (const char c : path) {
        if (c == '.')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    if (parts.size() >= 3 && parts[0] == "contact" && parts[1] != "general" && parts[2] == "surface")
        parts.insert(parts.begin() + 2, "master");
    return parts;
}

namespace {

/// A text becomes a map with that text under a key.
void make_map(Tree& tree, const char* key) {
    if (tree.kind != Tree::Kind::scalar) return;
    Tree text = tree;
    text.key = key;
    tree.kind = Tree::Kind::map;
    tree.children = {std::move(text)};
}

/// `file: part.vtu` for `file: {path: part.vtu}`, `repair: true` for `repair: [all]`.
void expand_mesh(Tree& mesh) {
    for (const char* tag : {"file", "cad"}) {
        Tree* source = mesh.find(tag);
        if (!source) continue;
        make_map(*source, "path");
        Tree* repair = source->kind == Tree::Kind::map && source->key == "file" ? source->find("repair") : nullptr;
        if (!repair || repair->kind != Tree::Kind::scalar) continue;
        if (repair->scalar != "true" && repair->scalar != "false") continue;
        Tree all = *repair;
        all.key.clear();
        all.scalar = "all";
        repair->kind = Tree::Kind::list;
        repair->children.clear();
        if (repair->scalar == "true") repair->children.push_back(std::move(all));
    }
}

/// An override that gives a pair roles takes the place of `between`, and the other way round.
void switch_sides(Tree& pair, const std::vector<std::string>& path) {
    const auto drop = [](Tree& map, const std::string& key) {
        std::erase_if(map.children, [&](const Tree& child) { return child.key == key; });
    };
    if (path[2] == "slave" || (path[2] == "master" && (path.size() == 3 || path.back() == "set")))
        drop(pair, "between");
    if (path[2] != "between") return;
    drop(pair, "slave");
    if (Tree* master = pair.find("master")) drop(*master, "set");
}

} // namespace

void expand_short_forms(Tree& scene, std::vector<Fault>& faults) {
    if (Tree* bodies = scene.find("bodies"); bodies && bodies->kind == Tree::Kind::map)
        for (Tree& body : bodies->children)
            if (Tree* mesh = body.find("mesh"); mesh && mesh->kind == Tree::Kind::map) expand_mesh(*mesh);
    if (Tree* output = scene.find("output"); output && output->kind == Tree::Kind::map)
        if (Tree* derivatives = output->find("derivatives"); derivatives && derivatives->kind == Tree::Kind::map)
            for (Tree& derivative : derivatives->children) make_map(derivative, "key");
    if (Tree* output = scene.find("output"); output && output->kind == Tree::Kind::map)
        if (Tree* gradients = output->find("gradients"); gradients && gradients->kind == Tree::Kind::map)
            for (Tree& gradient : gradients->children)
                if (Tree* by = gradient.kind == Tree::Kind::map ? gradient.find("by") : nullptr;
                    by && by->kind == Tree::Kind::map)
                    for (Tree& derivative : by->children) make_map(derivative, "key");
    Tree* pairs = scene.find("contact");
    if (!pairs || pairs->kind != Tree::Kind::map) return;
    for (Tree& pair : pairs->children) {
        if (pair.key == "general") continue; // its surface is its own
        if (Tree* master = pair.find("master")) make_map(*master, "set");
        const Tree* surface = pair.find("surface");
        if (!surface) continue;
        const Tree moved = *surface;
        std::erase_if(pair.children, [](const Tree& child) { return child.key == "surface"; });
        Tree* master = pair.find("master");
        if (!master) {
            pair.children.push_back(
                {.kind = Tree::Kind::map, .key = "master", .place = pair.place, .key_place = moved.key_place});
            master = &pair.children.back();
        }
        if (master->find("surface")) {
            faults.push_back(fault_at(moved.key_place, "contact." + pair.key + ".surface",
                                      "one surface, here or under master", "both"));
        } else if (master->kind == Tree::Kind::map) {
            master->children.push_back(moved);
        }
    }
}

void apply(const Override& change, Tree& scene, std::vector<Fault>& faults) {
    const Place place{override_file, 0, 0};
    if (find_control(change.key) != std::string::npos) {
        faults.push_back(
            fault_at(place, "", "key.path=value without control characters", "'" + printable(change.key) + "'"));
        return;
    }
    const std::vector<std::string> path = split_path(change.key);
    for (const std::string& part : path)
        if (part.empty()) {
            faults.push_back(fault_at(place, change.key, "key.path=value", "'" + change.key + "'"));
            return;
        }

    std::vector<Fault> syntax;
    Tree value = parse_yaml(change.value, override_file, syntax);
    if (!syntax.empty()) {
        faults.push_back(fault_at(place, change.key, syntax.front().expected, syntax.front().found));
        return;
    }
    set_place(value);

    if (Tree* pairs = scene.find("contact"); pairs && path.size() > 2 && path[0] == "contact")
        if (Tree* pair = pairs->find(path[1])) switch_sides(*pair, path);
    Tree* node = &scene;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (node->kind == Tree::Kind::list) {
            faults.push_back(fault_at(place, change.key, "a whole list", "a path into a list"));
            return;
        }
        if (node->kind == Tree::Kind::scalar) // a bare word stands for a map with that tag
            node->children.push_back({.key = node->scalar, .place = node->place, .key_place = node->place});
        node->kind = Tree::Kind::map;
        Tree* child = node->find(path[i]);
        if (!child) child = &node->children.emplace_back(implied_map(path[i]));
        node = child;
    }
    // A key of the file stays the file's, so that only a tag that an override brought wins over another.
    value.key = path.back();
    value.key_place = node->key_place;
    *node = value;
}

} // namespace osculate::scene
