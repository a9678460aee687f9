#pragma once
/// A vector at every node of all bodies, with the sums and maxima on which decisions are based.

#include "osculate/core/types.hpp"

#include <utility>
#include <vector>

namespace osculate {

/// Displacements, velocities, positions, forces: three components at each node, a plain value. All sums and comparisons
/// over the nodes are made here, in the order of the nodes. So there is one place to add up contributions when several
/// processes own the nodes. Geometry code needs single points only and takes the field as a list.
class Field {
public:
    Field() = default;
    explicit Field(std::size_t nodes, const Vec3& value = Vec3::Zero()) : values_(nodes, value) {}
    Field(std::vector<Vec3> values) : values_(std::move(values)) {}

    operator const std::vector<Vec3>&() const noexcept { return values_; }
    [[nodiscard]] const std::vector<Vec3>& values() const noexcept { return values_; }
    [[nodiscard]] std::vector<Vec3>& values() noexcept { return values_; }

    [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
    [[nodiscard]] bool empty() const noexcept { return values_.empty(); }
    [[nodiscard]] Vec3& operator[](std::size_t node) { return values_[node]; }
    [[nodiscard]] const Vec3& operator[](std::size_t node) const { return values_[node]; }
    [[nodiscard]] auto begin() noexcept { return values_.begin(); }
    [[nodiscard]] auto end() noexcept { return values_.end(); }
    [[nodiscard]] auto begin() const noexcept { return values_.begin(); }
    [[nodiscard]] auto end() const noexcept { return values_.end(); }
    void assign(std::size_t nodes, const Vec3& value) { values_.assign(nodes, value); }
    void clear() noexcept { values_.clear(); }
    /// Sets the field to zero at `nodes` nodes.
    void reset(std::size_t nodes) { values_.assign(nodes, Vec3::Zero()); }
    [[nodiscard]] bool operator==(const Field&) const = default;

    /// *this += a x
    void add(double a, const Field& x) {
        for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += a * x.values_[i];
    }

private:
    std::vector<Vec3> values_;
};

/// A value found over all nodes, and the first node that has it; -1: no node.
struct AtNode {
    double value = 0;
    Index node = -1;
};

/// Sum of f(node), a number or a vector that starts from `start`, over all nodes.
template <class Value, class F> [[nodiscard]] Value sum_over(Index nodes, Value start, F&& f) {
    for (Index node = 0; node < nodes; ++node) start += f(node);
    return start;
}

/// Largest f(node) over all nodes if it is above `least`; otherwise `least` and node -1.
template <class F> [[nodiscard]] AtNode largest_over(Index nodes, F&& f, double least = 0) {
    AtNode largest{least, -1};
    for (Index node = 0; node < nodes; ++node)
        if (const double value = f(node); value > largest.value) largest = {value, node};
    return largest;
}

/// Sum of a . b.
[[nodiscard]] double dot(const Field& a, const Field& b);
/// Euclidean norm over all components.
[[nodiscard]] double norm(const Field& a);
/// Largest component, in absolute value; NaN is ignored.
[[nodiscard]] double largest_component(const Field& a);
/// Largest |a - b|.
[[nodiscard]] AtNode largest_distance(const Field& a, const Field& b);
/// a x + b y
[[nodiscard]] Field weighted(double a, const Field& x, double b, const Field& y);
/// x + y
[[nodiscard]] Field sum(const Field& x, const Field& y);

} // namespace osculate
