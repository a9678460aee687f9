#include "osculate/linear/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace osculate::linear {

namespace {
constexpr double same_direction = 1e-9; ///< sine or cosine below which unit vectors count as parallel or orthogonal
constexpr double same_value = 1e-12;    ///< relative
} // namespace

Constraints::Constraints(Index nodes, const std::vector<NodeConstraint>& constraints,
                         const std::vector<Index>& dependent, const std::vector<LedDirection>& led)
    : entry_(static_cast<std::size_t>(nodes), -1), equation_(3 * static_cast<std::size_t>(nodes), 0) {
    std::vector<std::vector<NodeConstraint>> at;
    const auto list_of = [&](Index node) -> std::vector<NodeConstraint>& {
        if (entry_[node] < 0) {
            entry_[node] = static_cast<Index>(at.size());
            at.emplace_back();
        }
        return at[entry_[node]];
    };
    for (const NodeConstraint& c : constraints) {
        auto& list = list_of(c.node);
        bool repeated = false;
        for (NodeConstraint& other : list) {
            const double cosine = other.direction.dot(c.direction);
            if (std::abs(std::abs(cosine) - 1) < same_direction) {
                const double target = cosine > 0 ? c.target : -c.target;
                if (c.course != other.course ||
                    std::abs(target - other.target) > same_value * std::max(std::abs(target), std::abs(other.target)))
                    throw std::invalid_argument("node " + std::to_string(c.node) +
                                                " is given two different displacements along one direction");
                other.symmetry = other.symmetry || c.symmetry;
                repeated = true;
            } else if (std::abs(cosine) > same_direction) {
                throw std::invalid_argument("node " + std::to_string(c.node) +
                                            " is held along two directions that are neither parallel nor orthogonal");
            }
        }
        if (!repeated) list.push_back(c);
    }
    for (const LedDirection& one : led) {
        auto& list = list_of(one.node);
        for (const NodeConstraint& other : list)
            if (std::abs(other.direction.dot(one.direction)) > same_direction)
                throw std::invalid_argument("node " + std::to_string(one.node) +
                                            " is held along a direction along which an equation leads it, or near it");
        NodeConstraint slot;
        slot.direction = one.direction; // and no node
        list.push_back(slot);
    }

    entries_.resize(at.size());
    for (std::size_t e = 0; e < at.size(); ++e) {
        Entry& entry = entries_[e];
        entry.along.resize(3);
        bool aligned = true;
        for (const NodeConstraint& c : at[e]) aligned = aligned && c.direction.cwiseAbs().maxCoeff() > 1 - 1e-15;
        if (aligned) {
            for (NodeConstraint c : at[e]) {
                int axis = 0;
                c.direction.cwiseAbs().maxCoeff(&axis);
                if (c.direction(axis) < 0) c.target = -c.target;
                c.direction = Vec3::Unit(axis);
                entry.along[static_cast<std::size_t>(axis)] = c;
            }
            continue;
        }
        entry.turned = true;
        std::size_t count = 0;
        for (const NodeConstraint& c : at[e]) {
            entry.frame.col(static_cast<Index>(count)) = c.direction;
            entry.along[count++] = c;
        }
        if (count == 1) {
            int smallest = 0;
            entry.frame.col(0).cwiseAbs().minCoeff(&smallest);
            entry.frame.col(1) = entry.frame.col(0).cross(Vec3::Unit(smallest)).normalized();
        }
        if (count < 3) entry.frame.col(2) = entry.frame.col(0).cross(entry.frame.col(1));
    }

    for (const LedDirection& one : led)
        for (int k = 0; k < 3; ++k)
            if (std::abs(frame(one.node).col(k).dot(one.direction)) > 0.5) // one of the axes
                equation_[3 * static_cast<std::size_t>(one.node) + k] = held;
    for (const Index node : dependent)
        for (int k = 0; k < 3; ++k) equation_[3 * static_cast<std::size_t>(node) + k] = held;
    for (Index node = 0; node < nodes; ++node)
        for (int k = 0; k < 3; ++k)
            if (Index& e = equation_[3 * static_cast<std::size_t>(node) + k]; e != held)
                e = constraint(node, k) ? held : equations_++;
}

int Constraints::free_components(Index node) const {
    int count = 0;
    for (int k = 0; k < 3; ++k) count += equation(node, k) != held;
    return count;
}

const Mat3& Constraints::frame(Index node) const {
    static const Mat3 identity = Mat3::Identity();
    return entry_[node] < 0 ? identity : entries_[entry_[node]].frame;
}

const NodeConstraint* Constraints::constraint(Index node, int k) const {
    if (entry_[node] < 0) return nullptr;
    const NodeConstraint& c = entries_[entry_[node]].along[static_cast<std::size_t>(k)];
    return c.node < 0 ? nullptr : &c;
}

Vec3 Constraints::to_local(Index node, const Vec3& v) const {
    return turned(node) ? Vec3(frame(node).transpose() * v) : v;
}

Vec3 Constraints::to_global(Index node, const Vec3& v) const {
    return turned(node) ? Vec3(frame(node) * v) : v;
}

void Constraints::scatter(const ConstVectorRef& unknowns, const Field& prescribed, Field& u) const {
    for (Index node = 0; node < nodes(); ++node) {
        Vec3 local = prescribed[node];
        for (int k = 0; k < 3; ++k)
            if (const Index e = equation(node, k); e != held) local(k) = unknowns[e];
        u[node] = to_global(node, local);
    }
}

void Constraints::gather(const Field& u, VectorRef unknowns) const {
    for (Index node = 0; node < nodes(); ++node) {
        const Vec3 local = to_local(node, u[node]);
        for (int k = 0; k < 3; ++k)
            if (const Index e = equation(node, k); e != held) unknowns[e] = local(k);
    }
}

Vec3 Constraints::reaction(Index node, const Vec3& unbalanced) const {
    if (entry_[node] < 0) return Vec3::Zero();
    Vec3 local = to_local(node, unbalanced);
    for (int k = 0; k < 3; ++k)
        if (equation(node, k) != held) local(k) = 0;
    return to_global(node, local);
}

} // namespace osculate::linear
