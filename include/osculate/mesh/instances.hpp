#pragma once
/// Numbers of a file's nodes and elements that belong to instances of parts.

#include <string>
#include <vector>

namespace osculate::mesh {

/// An instance of a part in a deck's assembly. Its number n is `before` + n in the mesh.
struct Instance {
    std::string name; ///< as first written
    long long before = 0;
};

/// Ascending in their numbers; empty where a file has no instances.
class Instances {
public:
    void add(Instance one) { all_.push_back(std::move(one)); }

    /// The instance that a number of the mesh belongs to, nullptr for none.
    [[nodiscard]] const Instance* of(long long id) const;
    /// A number as the file has it, for messages: "17", or "17 of instance 'Part-1-1'".
    [[nodiscard]] std::string shown(long long id) const;

private:
    std::vector<Instance> all_;
};

} // namespace osculate::mesh
