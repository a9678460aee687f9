#pragma once
/// What contact does to the nodes of all bodies, whatever their role: the sum over all pairs.

#include "osculate/contact/coulomb.hpp"
#include "osculate/core/field.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"

#include <vector>

namespace osculate::output {

struct NodalContact {
    Field force; ///< (nodes) on the node as slave and as master, N
    std::vector<double>
        pressure;            ///< (nodes) of that force, against the outward normal over the node's area, Pa; 0 inside
    std::vector<double> gap; ///< (nodes) the smallest as slave, m; NaN if it has no partner as slave
    std::vector<double> status; ///< (nodes) as slave: 0 open or none, 1 stick, 2 slip; 1 wins over 2
    Field slip;                 ///< (nodes) of the step, tangential, as slave, m
};

/// @param contact  at the state
[[nodiscard]] NodalContact nodal_contact(const model::Model& model, const model::State& state,
                                         const model::ContactEvaluations& contact);

} // namespace osculate::output
