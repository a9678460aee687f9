#pragma once
/// Geometric objections to an attempted step: gaps at its end, and paths that lead through a master.

#include "osculate/core/timing.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/step_control.hpp"

#include <utility>
#include <vector>

namespace osculate::time {

/// Criteria, by slave node of a pair:
/// - *Gap at the end*, for nodes open at the start: (27) and (28). It is reliable if the node still sees the sheet
///   above which it started; this is certain if nothing moves farther than `reach`.
/// - *Motion along the normal at the start*, if the node no longer sees that sheet at the end, or sees another one: for
///   closed nodes, and for open nodes so near the surface that facets cannot tell their side of a smooth surface.
/// - *Path* against the moving facets, for all other open nodes whose motion could lead through a facet: it is at least
///   the distance of the closest facet, and is longer than `reach` or the node has lost, changed or found a sheet.
///   Paths are straight. Closed nodes follow a curved surface and therefore have no path.
/// - *Edges against edges*: the gap at the end where they cross at the start, otherwise the path.
/// A node that moves less than its distance to every facet costs one comparison; if all nodes do, no facet is examined.
class CollisionCheck {
public:
    /// Fraction of the smallest facet size or thickness of a master's body. A node that moves no farther relative to
    /// the master and ends inside is nearer to the facets it has passed than to those on the far side, even if the body
    /// is compressed to half its thickness. It is then at most one facet away from the facet where it started.
    static constexpr double reach = 0.25;
    /// Largest allowed interpenetration as fraction of the thickness, whatever the limit: it must not end in the far
    /// half.
    static constexpr double deepest = 0.25;

    /// @param paths    whether to follow paths
    /// @param contact  of the attempts: begin_step() uses it as scratch
    CollisionCheck(const model::Model& model, model::ContactEvaluations& contact, const StepLimits& limits, bool paths,
                   Timings& timings, int threads);

    /// Locates every slave node at the accepted state from which a step starts.
    /// @param state  stays as it is until the step has ended
    void begin_step(const model::State& state);
    /// Adds the evidence of a trial with displacements u, at which contact was last evaluated.
    void add_trial(const Field& u, StepEvidence& evidence);
    /// The same for a solution with contact, whose gaps need no check.
    void add_solution(const Field& u, StepEvidence& evidence);
    /// Number of paths followed since the last call.
    [[nodiscard]] long take_paths_followed() { return std::exchange(followed_, 0); }

private:
    /// A slave node at the accepted state.
    struct Start {
        bool found = false; ///< whether it has a contact point on the master
        bool closed = false;
        double gap = 0;
        double distance = 0; ///< lower bound of the distance to the closest facet, m
        Vec3 normal = Vec3::Zero();
        Index facet = -1;
    };
    [[nodiscard]] bool speaks_by_normal(std::size_t p, const Start& start) const;
    /// Whether a node, at positions x, sees another sheet of its master than at the start, or none.
    [[nodiscard]] bool sheet_lost(std::size_t p, Index j, const Field& x) const;
    /// GapEvidence::length at a facet, and the allowed interpenetration there, m.
    [[nodiscard]] double length(std::size_t p, Index facet) const;
    [[nodiscard]] double allowed(std::size_t p, Index facet) const;
    void add_normal_motions(const Field& x, StepEvidence& evidence) const;
    void add_paths(const Field& x, StepEvidence& evidence);
    /// Paths of edges that had no crossing with each other at the start.
    void add_edge_paths(std::size_t p, const Field& x, StepEvidence& evidence) const;
    void follow(std::size_t p, const std::vector<Index>& slaves, const Field& x, StepEvidence& evidence);

    const model::Model& model_;
    model::ContactEvaluations& contact_;
    const StepLimits& limits_;
    bool paths_;
    Timings& timings_;
    int threads_;
    const Field* u_ = nullptr; ///< displacements at the start, of the state
    Field x_;                  ///< positions at the start, while they are needed
    std::vector<std::vector<Start>> starts_;
    long followed_ = 0;
};

} // namespace osculate::time
