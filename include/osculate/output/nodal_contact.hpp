#pragma once
/// What contact does to the nodes of all bodies, whatever their role: the sum over all pairs.

#include "osculate/contact/coulomb.hpp"
#include "osculate/core/field.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"

#include <limits>
#include <vector>

namespace osculate::output {

class NodalContact {
public:
    struct Node {
        Vec3 force = Vec3::Zero(); ///< on the node as slave and as master, N
        double pressure = 0;       ///< of that force, against the outward normal over the node's area, Pa; 0 inside
        double gap = std::numeric_limits<double>::quiet_NaN(); ///< the smallest as slave, m; NaN: no partner as slave
        double status = 0;        ///< as slave: 0 open or none, 1 stick, 2 slip; 1 wins over 2
        Vec3 slip = Vec3::Zero(); ///< of the step, tangential, as slave, m
    };

    explicit NodalContact(std::size_t nodes) : place_(nodes, -1) {}

    [[nodiscard]] const Node& operator[](std::size_t node) const {
        return place_[node] < 0 ? nodes_.front() : nodes_[static_cast<std::size_t>(place_[node])];
    }
    /// Number of a node among those that contact reaches, a new one unless it has one already.
    std::size_t reach(std::size_t node);
    /// The same of a node that may be out of its reach: -1.
    [[nodiscard]] Index place(std::size_t node) const { return place_[node]; }
    [[nodiscard]] std::size_t size() const { return nodes_.size(); }
    [[nodiscard]] Node& at(std::size_t place) { return nodes_[place]; }

private:
    std::vector<Index> place_;                       ///< (nodes)
    std::vector<Node> nodes_ = std::vector<Node>(1); ///< those that contact reaches, after one that it does not
};

/// @param contact  at the state
[[nodiscard]] NodalContact nodal_contact(const model::Model& model, const model::State& state,
                                         const model::ContactEvaluations& contact);

} // namespace osculate::output
