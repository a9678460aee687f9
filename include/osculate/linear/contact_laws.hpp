#pragma once
/// Contact in the form for condensation: linear laws between motions and forces at slave nodes.

#include "osculate/core/types.hpp"

#include <vector>

namespace osculate::linear {

/// B C u + D lambda = r, C u the motions of slave nodes relative to their facets; springs under loose bodies are last.
struct ContactLaws {
    /// One node of the relative motion C.
    struct Term {
        Index node; ///< contact node
        Mat3 by;    ///< global components
    };
    double mass_factor = 0;       ///< of M in the stiffness for which they were made, 0 in statics, 1/s^2
    std::vector<Index> couplings; ///< couplings of SystemMatrix that are in contact
    std::vector<std::vector<Term>> terms;
    std::vector<Mat3> B, D;
};

} // namespace osculate::linear
