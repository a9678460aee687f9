#pragma once
/// What rotations add to the strains of elements at small strain, from the positions of nodes alone.

#include "osculate/linear/constraints.hpp"
#include "osculate/model/model.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace osculate::app {

/// Small strain takes a rotation by theta for a strain of cos theta - 1 across the axis. theta is that of the rotation R in
/// F = R U, where F = 1 + H and H = grad u is fitted to the nodes of an element. It counts in two ways. Lines between nodes
/// that supports, motions or couplings lead through a rotation keep their length, and the stiffness sees them strained by
/// that. Elsewhere the stiffness sees no strain, and lines grow by it instead. That is an error of the shape, of the order
/// of theta^2, and harmless in a beam that bends a little; so it counts from a larger angle on.
class RotationCheck {
public:
    /// The model must outlive this object.
    explicit RotationCheck(const model::Model& model);

    /// O(elements at small strain).
    void accepted(const model::State& state, const linear::Constraints& constraints);

    /// Largest 1 - cos theta in any accepted step; no value if no body is at small strain.
    [[nodiscard]] std::optional<double> largest() const;
    /// A sentence about the body that is worst off, if 1 - cos theta is above a tenth of the largest strain of any.
    [[nodiscard]] std::optional<std::string> warning() const;

    /// Results so far, as plain numbers; recall() continues from them.
    /// @throws std::runtime_error if the count of numbers is wrong
    [[nodiscard]] std::vector<double> memory() const;
    void recall(std::span<const double> memory);

private:
    /// An element of a body, and what its rotation adds.
    struct Turned {
        double added = 0;           ///< 1 - cos theta, of led lines as far as they are led; 0: none
        double strain = 0;          ///< largest strain of the body at that time
        double angle = 0, time = 0; ///< theta, rad; s
        Index element = -1;         ///< of its body
        Vec3 place = Vec3::Zero();  ///< current centre, m
        bool led = false;
    };

    [[nodiscard]] static Turned worst_of_all(const Turned& own, Ranks& ranks);
    /// Where processes share the model, of elements at own nodes.
    void examine(std::size_t body, const model::State& state, const linear::Constraints& constraints,
                 const std::vector<char>& led);

    const model::Model& model_;
    std::vector<char> follows_;  ///< (nodes) those of couplings
    std::vector<Turned> spoilt_; ///< (bodies) the worst of those that count
    double largest_ = 0;
    bool any_ = false; ///< some body is at small strain
};

} // namespace osculate::app
