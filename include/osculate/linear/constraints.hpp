#pragma once
/// Free displacement components, and the values of the held ones.

#include "osculate/core/shared_pages.hpp"

#include <string>
#include <vector>

namespace osculate::linear {

/// One held direction of one node.
struct NodeConstraint {
    Index node = -1;
    Vec3 direction = Vec3::UnitX(); ///< unit
    double target = 0;              ///< displacement along it at the end of the stage, m
    bool driven = false;            ///< false: remains zero at all times
    bool symmetry = false;          ///< no contact force acts along it either
    Index set = -1;                 ///< constrained set, for messages
    Index course = -1; ///< the displacement is `target` times this course of the stage; -1: `target` itself, at the end
};

/// A direction along which a node has no equation, as its motion along it follows from that of others, see Dependence.
struct LedDirection {
    Index node = -1;
    Vec3 direction = Vec3::UnitX(); ///< unit
};

/// Local frames and equation numbers of every node for one stage. Directions held at one node must be parallel or
/// orthogonal; they become axes of its frame, so that any set of them eliminates components exactly.
class Constraints {
public:
    static constexpr Index held = -1;

    /// @param dependent  nodes without equations, whose motion follows from that of others, see Dependence; directions
    ///                   held at them are ones along which this motion keeps them
    /// @param led        directions orthogonal to those held at their nodes, and to each other
    /// @throws std::invalid_argument naming the node (global number) whose directions or values contradict each other
    Constraints(Index nodes, const std::vector<NodeConstraint>& constraints, const std::vector<Index>& dependent = {},
                const std::vector<LedDirection>& led = {});

    [[nodiscard]] Index nodes() const { return static_cast<Index>(entry_.size()); }
    [[nodiscard]] Index equations() const { return equations_; }
    /// Equation of local component k of a node, or `held`.
    [[nodiscard]] Index equation(Index node, int k) const { return equation_[3 * static_cast<std::size_t>(node) + k]; }
    [[nodiscard]] int free_components(Index node) const;
    /// True if the node's frame is not the global one.
    [[nodiscard]] bool turned(Index node) const { return entry_[node] >= 0 && entries_[entry_[node]].turned; }
    /// Columns: the local axes of the node in global components.
    [[nodiscard]] const Mat3& frame(Index node) const;
    /// The constraint on local component k, or nullptr.
    [[nodiscard]] const NodeConstraint* constraint(Index node, int k) const;

    /// Writes displacements: free components from the start of `unknowns`, held ones from `prescribed` (local, same
    /// layout as u).
    void scatter(const ConstVectorRef& unknowns, const Field& prescribed, Field& u) const;
    /// Writes the free local components of u to the start of `unknowns`.
    void gather(const Field& u, VectorRef unknowns) const;
    /// Local components of a global vector at a node, and back.
    [[nodiscard]] Vec3 to_local(Index node, const Vec3& v) const;
    [[nodiscard]] Vec3 to_global(Index node, const Vec3& v) const;
    /// Sum of the force components along held directions: the force of the supports, in global components.
    [[nodiscard]] Vec3 reaction(Index node, const Vec3& unbalanced) const;

    /// Adds its arrays, the same on all processes.
    void add_replicas(Replicas& replicas) const {
        replicas.add(entry_);
        replicas.add(equation_);
    }

private:
    struct Entry {
        Mat3 frame = Mat3::Identity();
        bool turned = false;
        std::vector<NodeConstraint> along; ///< three slots; node = -1 if the component is free, or led
    };
    std::vector<Index> entry_; ///< (nodes) index into entries_, -1 unconstrained
    std::vector<Entry> entries_;
    std::vector<Index> equation_; ///< (3 nodes)
    Index equations_ = 0;
};

} // namespace osculate::linear
