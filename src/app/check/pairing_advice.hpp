#pragma once
/// What a user may want to know about the choice of slave and master.

#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"

#include <string>
#include <vector>

namespace osculate::app {

/// How the meshes of a pair meet where they are near one another.
struct Pairing {
    Index near = 0;            ///< slave nodes closer to the master than its facets are long
    bool matching = true;      ///< each of them lies over a master node
    double slave_spacing = 0;  ///< mean distance of neighbouring nodes there, m
    double master_spacing = 0; ///< the same of the master
    bool midside = false;      ///< the slave's faces have midside nodes
    Discretisation discretisation = Discretisation::node;
};

/// @pre the pair has been evaluated at the positions X of the model
[[nodiscard]] Pairing pairing(const model::ContactEvaluation& evaluation, const model::Model& model);

/// Sentences; none where there is nothing to say.
[[nodiscard]] std::vector<std::string> advice(const Pairing& pairing);

} // namespace osculate::app
