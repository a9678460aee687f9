#pragma once

#include "scene/tree.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace osculate::scene {

struct TemplateFile {
    std::filesystem::path path;
    bool shipped = false; ///< found by its name from any folder; another needs its path
};

/// Where an output template called `name` stands: the path itself when it ends in .yaml; else NAME.yaml in the scene's
/// folder, in `output_templates/` there or in a folder above, in $OSCULATE_TEMPLATES, in the folder built in.
[[nodiscard]] std::optional<TemplateFile> find_template(const std::string& name,
                                                        const std::filesystem::path& directory);

/// Names of the templates that find_template sees from a folder, sorted.
[[nodiscard]] std::vector<std::string> known_templates(const std::filesystem::path& directory);

} // namespace osculate::scene
