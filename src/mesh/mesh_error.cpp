#include "osculate/mesh/mesh_error.hpp"

#include <utility>

namespace osculate::mesh {
namespace {

std::string join(const std::vector<std::string>& reasons) {
    std::string text;
    for (const std::string& reason : reasons) text += (text.empty() ? "" : "\n") + reason;
    return text;
}

} // namespace

MeshError::MeshError(std::vector<std::string> reasons)
    : std::runtime_error(join(reasons)), reasons_(std::move(reasons)) {}

MeshError::MeshError(const std::string& file, const std::string& reason)
    : MeshError(std::vector<std::string>{file + ": " + reason}) {}

} // namespace osculate::mesh
