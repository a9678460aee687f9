#pragma once
/// A mesh that cannot be read or used.

#include <stdexcept>
#include <string>
#include <vector>

namespace osculate::mesh {

/// Contains every reason found, each with the file and the numbers used in the file.
class MeshError : public std::runtime_error {
public:
    explicit MeshError(std::vector<std::string> reasons);
    /// `file: reason`
    MeshError(const std::string& file, const std::string& reason);
    [[nodiscard]] const std::vector<std::string>& reasons() const noexcept { return reasons_; }

private:
    std::vector<std::string> reasons_;
};

} // namespace osculate::mesh
