#pragma once
/// One static stage as the stepper sees it.

#include "osculate/model/constraints.hpp"

#include <string>
#include <vector>

namespace osculate::time {

struct Stage {
    std::string name;
    double duration = 1; ///< s
    int steps = 1;
    bool ramp = true;                               ///< linear from the last value; false: full value at once
    std::vector<model::NodeConstraint> constraints; ///< every direction held during this stage
    std::vector<Vec3> force_start, force_end;       ///< (nodes) external forces at its two ends, N
};

} // namespace osculate::time
