#pragma once
/// What a study's keys say of one another.

#include "osculate/core/error.hpp"
#include "osculate/scene/study.hpp"

namespace osculate::scene {

/// Formulas whose names are all known, and scenes that can be read.
void check_study(const Study& study, const NamedFunctions& functions, const std::vector<Override>& command_line,
                 std::vector<Fault>& faults);

} // namespace osculate::scene
