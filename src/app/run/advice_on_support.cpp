/// Advice where bodies are not held, or held too often.

#include "app/run/adviser.hpp"

#include <algorithm>

namespace osculate::app {

void Adviser::unsupported() {
    const auto at = std::ranges::find(found_.bodies, found_.body, &time::BodyHold::body);
    if (at == found_.bodies.end()) return;
    const time::BodyHold& loose = *at;
    const std::string ways = loose.free_motions.empty()
                                 ? "free in " + std::to_string(loose.free_by_supports) + " ways without contact"
                                 : "free " + listed(loose.free_motions);
    add("supports",
        "hold body '" + loose.body + "', which is " + ways + ": fix one of its sets, or add a symmetry plane");
    const bool adrift = failed_.result.adrift >= 0;
    constexpr double apart = 1e-6; // facets
    const bool lay = loose.nearest_gap <= apart * loose.facet, slid = adrift && lay && closed_again(loose.nearest_pair);
    if (loose.in_pair && loose.pressed == 0 && !slid && (loose.touching + loose.touched > 0 || adrift)) {
        const std::string how = loose.touching > 0
                                    ? "contact would have to pull at " + std::to_string(loose.touching) + " nodes"
                                : loose.touched > 0 ? "it touched at " + std::to_string(loose.touched) +
                                                          " nodes at the last good time, and contact cannot pull"
                                                    : "nothing in its way stops it";
        add(stage_, "this stage pulls body '" + loose.body + "' off (" + how +
                        "): reverse or reduce the load, or move the body by a displacement instead of a load");
    }
    if (loose.in_pair && loose.touching + loose.touched == 0 && !loose.nearest_pair.empty() && !lay) {
        add(in_stage("displacement"),
            "move the body by a displacement until it touches, instead of loading it: its nearest slave node is " +
                number(loose.nearest_gap) + " m away");
        if (failed_.ladder.stabilisation.share == nullptr)
            change("solver.stabilisation", "true",
                   "true, so that the load can move the body until it touches something");
        else if (loose.nearest_gap < loose.facet && !adrift) // else the load does not lead there
            change(key_of(*pair(loose.nearest_pair)) + ".closing_tolerance",
                   rounded(std::min(1.0, margin * loose.nearest_gap / loose.facet)),
                   "above " + number(loose.nearest_gap / loose.facet) +
                       ", so that nodes this close count as touching in the first solve");
    }
    if (loose.pressed > 0 || slid)
        if (const model::ContactPair* const one = pair(loose.nearest_pair);
            one != nullptr && one->options().friction == 0)
            change(key_of(*one) + ".friction", "0.3",
                   "above 0, for example 0.3, if the real surfaces are rough: without friction, contact holds "
                   "the body only along its normals");
    dynamics("if body '" + loose.body + "' is really meant to move freely: its inertia then holds it");
}

bool Adviser::closed_again(const std::string& name) const {
    return std::ranges::any_of(found_.changes, [&](const time::StatusChanges& one) {
        const auto opened = std::ranges::find_if_not(one.sequence, contact::is_closed);
        return one.pair == name && std::any_of(opened, one.sequence.end(), contact::is_closed);
    });
}

void Adviser::dynamics(const std::string& why) {
    const std::string key = in_stage("analysis");
    const auto has_density = [](const model::Body& body) { return body.has_mass(); };
    if (std::ranges::all_of(failed_.model.bodies, has_density))
        change(key, "dynamic", "dynamic, " + why);
    else
        add(key, "dynamic, " + why + ", and every body needs a density");
}

void Adviser::contradiction() {
    add("supports", "look for parts that are held or driven on both sides of a contact: if neither side can move, "
                    "neither force nor gap is determined");
    add(in_stage("displacement"),
        "drive a part of the body that is not itself in contact, so that the part in contact can deform");
    if (found_.contact && is_own(found_.contact->pair))
        add("contact." + found_.contact->pair + ".slave", "leave out nodes that are held or driven");
}

} // namespace osculate::app
