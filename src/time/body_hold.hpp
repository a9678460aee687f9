#pragma once
/// What holds each body, for a post-mortem.

#include "osculate/time/post_mortem.hpp"

namespace osculate::time {

/// How contact stood at the last accepted state, body by body. Evaluates the contact points there.
[[nodiscard]] std::vector<BodyHold> holds_before(const FailedAttempt& failed);
/// Adds what holds the bodies at the last iterate, at which `equilibrium` has been evaluated.
void hold_now(const FailedAttempt& failed, const equilibrium::Equilibrium& equilibrium, const model::State& state,
              std::vector<BodyHold>& holds);
/// Whether nothing holds a body at the last iterate, though its loads push it against what it touched: the iterate is far from any
/// equilibrium.
[[nodiscard]] bool thrown_off(const BodyHold& hold);
/// Of the bodies that nothing holds in statics, the freest; null where each is held.
[[nodiscard]] const BodyHold* loose_body(const FailedAttempt& failed, const PostMortem& found);

} // namespace osculate::time
