#include "scene/template_reader.hpp"

#include "osculate/scene/nearest.hpp"
#include "scene/describe.hpp"
#include "scene/templates.hpp"

#include <algorithm>

namespace osculate::scene {

namespace fs = std::filesystem;

namespace {

class Chain {
public:
    Chain(const KnownNames& names, Output& output, std::vector<Fault>& faults)
        : names_(names), output_(output), faults_(faults) {}

    /// Reads a template, what it extends first. @param at  where it is named, `key` its key there
    std::optional<TemplateFile> read(const std::string& name, const Place& at, const char* key,
                                     const fs::path& directory) {
        const auto file = find_template(name, directory);
        if (!file) {
            const Words known = known_templates(directory);
            faults_.push_back(fault_at(
                at, key, name.ends_with(".yaml") ? "a template file that exists" : "an output template: " + join(known),
                "'" + name + "'", nearest(name, known)));
            return {};
        }
        const bool cycle = std::ranges::count(files_, file->path) > 0;
        files_.push_back(file->path);
        if (cycle) {
            Words way;
            for (const fs::path& one : files_) way.push_back(one.filename().string());
            faults_.push_back(fault_at(at, key, "a template that does not lead back to itself", join(way, " -> ")));
            return {};
        }
        const Tree document = read_yaml(file->path.string(), faults_);
        const Tree* base = document.find("extends");
        if (base != nullptr && base->kind == Tree::Kind::scalar && !base->scalar.empty())
            (void)read(base->scalar, base->place, "extends", file->path.parent_path());
        std::string written;
        TreeReader reader(names_, faults_);
        reader.read(document, [&] { describe_template(reader, written, output_); });
        return file;
    }

private:
    const KnownNames& names_;
    Output& output_;
    std::vector<Fault>& faults_;
    std::vector<fs::path> files_; ///< from the scene's template on
};

} // namespace

std::string read_template(const Tree& scene, const fs::path& directory, const KnownNames& names, Output& output,
                          std::vector<Fault>& faults) {
    const Tree* section = scene.find("output");
    const Tree* given = section ? section->find("template") : nullptr;
    if (given && given->kind != Tree::Kind::scalar) return output.template_name; // reported by the reader
    const std::string name = given ? given->scalar : output.template_name;
    const auto file =
        Chain(names, output, faults).read(name, given ? given->place : scene.place, "output.template", directory);
    return !file || file->shipped ? name : file->path.string();
}

} // namespace osculate::scene
