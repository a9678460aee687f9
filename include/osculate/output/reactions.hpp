#pragma once
/// Forces of supports and driven motions at nodes.

#include "osculate/linear/constraints.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace osculate::output {

/// The unbalanced force along the held directions of a node, N. A view computes it where it is asked for: few nodes are held.
class Reactions {
public:
    /// Of no step: 0 at every node.
    Reactions() = default;
    /// Both must outlive this object. @param unbalanced  (nodes) N
    Reactions(const linear::Constraints& constraints, const std::vector<Vec3>& unbalanced)
        : constraints_(&constraints), unbalanced_(&unbalanced) {}
    /// Those that nodal_reactions() gave: (nodes) N.
    Reactions(std::vector<Vec3> values) : own_(std::make_shared<const std::vector<Vec3>>(std::move(values))) {}

    [[nodiscard]] Vec3 operator[](Index node) const {
        const auto i = static_cast<std::size_t>(node);
        if (constraints_ != nullptr) return constraints_->reaction(node, (*unbalanced_)[i]);
        return own_ ? (*own_)[i] : Vec3::Zero();
    }

private:
    const linear::Constraints* constraints_ = nullptr;
    const std::vector<Vec3>* unbalanced_ = nullptr;
    std::shared_ptr<const std::vector<Vec3>> own_;
};

} // namespace osculate::output
