#pragma once
/// What the geometry of contact says against an attempted step: gaps at its end, and paths that lead through a master.

#include "osculate/core/timing.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/step_control.hpp"

#include <utility>
#include <vector>

namespace osculate::time {

/// Who speaks for which slave node of a pair:
/// - *Gap at the end*, of the nodes open at the start: (27) and (28). It can be trusted where the node still sees the sheet
///   it started above, so it can where nothing moves farther than `reach`.
/// - *Motion along the normal at the start*, where that sheet is lost at the end, or another one seen: of closed nodes, and of
///   open ones so near the surface that facets cannot tell which side of a smooth surface they are on.
/// - *Path* of all other open nodes, against the moving facets, where the motion could have taken them there: at least as
///   far as the closest facet, and farther than `reach` or with a sheet lost, changed or found. Paths are straight, so that
///   closed nodes, which follow the surface round its bends, have none.
/// A node farther from every facet than it moves costs one comparison; with none else, no facet is looked at.
class CollisionCheck {
public:
    /// Part of the smallest facet size or thickness of a master's body. A node that moves no farther relative to the master
    /// ends, if it ends inside, nearer to the facets it has gone through than to those on the far side, even in a body squeezed
    /// to half its thickness, and no farther than next to the facet it started from.
    static constexpr double reach = 0.25;
    /// No interpenetration beyond this part of the thickness is allowed, whatever the limit: it must not end in the far half.
    static constexpr double deepest = 0.25;

    /// @param paths  follow paths at all
    /// @param contact  of the attempts: begin_step() takes it as scratch
    CollisionCheck(const model::Model& model, model::ContactEvaluations& contact, const StepLimits& limits, bool paths,
                   Timings& timings, int threads);

    /// Locates every slave node at the accepted state a step starts from.
    void begin_step(const model::State& state);
    /// Adds what there is to say of a trial that leads to displacements u, at which contact has been evaluated last.
    void add_trial(const Field& u, StepEvidence& evidence);
    /// The same for a solution with contact, whose gaps need no proof.
    void add_solution(const Field& u, StepEvidence& evidence);
    /// Paths followed since it was asked last.
    [[nodiscard]] long take_paths_followed() { return std::exchange(followed_, 0); }

private:
    /// A slave node at the accepted state.
    struct Start {
        bool found = false; ///< the master has a point for it
        bool closed = false;
        double gap = 0;
        double distance = 0; ///< to the closest facet, at least, m
        Vec3 normal = Vec3::Zero();
        Index facet = -1;
    };
    [[nodiscard]] bool speaks_by_normal(std::size_t p, const Start& start) const;
    [[nodiscard]] bool sheet_lost(std::size_t p, Index j) const;
    /// GapEvidence::length at a facet, and what it allows, m.
    [[nodiscard]] double length(std::size_t p, Index facet) const;
    [[nodiscard]] double allowed(std::size_t p, Index facet) const;
    void add_normal_motions(const Field& u, StepEvidence& evidence) const;
    void add_paths(const Field& u, StepEvidence& evidence);
    void follow(std::size_t p, const std::vector<Index>& slaves, const Field& x, StepEvidence& evidence);

    const model::Model& model_;
    model::ContactEvaluations& contact_;
    const StepLimits& limits_;
    bool paths_;
    Timings& timings_;
    int threads_;
    Field x_; ///< positions at the start
    std::vector<std::vector<Start>> starts_;
    long followed_ = 0;
};

} // namespace osculate::time
