#pragma once
/// Variations of what the vertex gap blend makes of the patches that it sees from one slave point.

#include "contact/placed_patch.hpp"
#include "osculate/contact/contact_point.hpp"

namespace osculate::contact {

/// First variations of the blend's point: of gap and normal, and where they are wanted of weights and pressing.
void vary_blend(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point,
                ContactVariation& variation);

} // namespace osculate::contact
