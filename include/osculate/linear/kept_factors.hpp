#pragma once
/// What a ContactPreconditioner's factors were made for: plain values from which they can be made again.

#include "osculate/linear/soft_contact.hpp"

#include <memory>
#include <vector>

namespace osculate::linear {

struct KeptFactors {
    double mass_factor = 0;                                   ///< of M in the stiffness, 0 in statics, 1/s^2
    std::shared_ptr<const std::vector<SoftContact>> contacts; ///< by coupling; null: there are none yet
    double fresh = 0, wasted = 0;                             ///< see solve::Wear
};

} // namespace osculate::linear
