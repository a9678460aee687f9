#pragma once
/// Steps of a run, and how far two runs that should be the same are from each other.

#include "osculate/core/error.hpp"
#include "osculate/time/stepper.hpp"
#include "support/transformation.hpp"

#include <map>
#include <string>
#include <vector>

namespace osculate::support {

struct TraceStep {
    double time = 0;
    int iterations = 0;
    std::vector<Vec3> u;                            ///< (nodes)
    std::vector<std::map<Index, Vec3>> slave_force; ///< per pair, by global node
};

struct Trace {
    std::vector<TraceStep> steps;
    std::string failure; ///< message of a scene that is refused or a run that gives up
    app::Plan plan;
};

namespace detail {

struct Enough {};

class Tracer final : public time::StepObserver {
public:
    Tracer(Trace& trace, int most_steps) : trace_(trace), most_steps_(most_steps) {}
    void attempted(const time::Attempt& /*attempt*/,
                   const std::vector<equilibrium::IterationRecord>& /*records*/) override {}
    void accepted(const time::AcceptedStep& step) override {
        TraceStep kept{step.state.time, step.iterations, step.state.u, {}};
        const auto& pairs = trace_.plan.model.pairs;
        for (std::size_t p = 0; p < pairs.size(); ++p) {
            kept.slave_force.emplace_back();
            for (Index j = 0; j < pairs[p]->size(); ++j)
                // a node of a skin by that of the mesh which it goes with
                kept.slave_force[p][model::material_node(trace_.plan.model, pairs[p]->slaves().node[j])] =
                    step.state.contact[p].lambda[j];
        }
        trace_.steps.push_back(std::move(kept));
        if (static_cast<int>(trace_.steps.size()) == most_steps_) throw Enough{};
    }

private:
    Trace& trace_;
    int most_steps_;
};

} // namespace detail

/// @param most_steps  accepted ones, after which the run is left
inline void run_trace(Trace& trace, const scene::Scene& scene, const std::vector<mesh::Mesh>& meshes, int most_steps) {
    try {
        Timings timings;
        trace.plan = app::compile(scene, meshes, 1, timings);
        time::Stepper stepper(trace.plan.model, trace.plan.stages, trace.plan.stepper, timings);
        detail::Tracer tracer(trace, most_steps);
        stepper.run(tracer);
    } catch (const detail::Enough&) {
    } catch (const SceneError& error) {
        trace.failure = error.faults().front().message();
    } catch (const RunFailure& failure) {
        trace.failure = failure.what();
    }
}

/// Largest differences over all common steps, each over the largest such value of the run.
struct Difference {
    double force = 0;        ///< of a pair, over the sum of its nodal forces' sizes
    double nodal_force = 0;  ///< of a slave node
    double displacement = 0; ///< of a node
    bool same_steps = false; ///< as many, at the same times
    int iterations = 0;      ///< of all steps, more than before
    std::string failure;     ///< where one run ended and the other did not
};

/// @param number  see transformed()
inline Difference difference(const Trace& a, const Trace& b, const Transformation& by,
                             const std::vector<Index>& number) {
    // the end of a step is the sum of the steps before, each rounded
    constexpr double same_time = 1e-12;
    Difference d;
    if (a.failure.empty() != b.failure.empty()) d.failure = a.failure.empty() ? b.failure : "none: " + a.failure;
    const std::size_t steps = std::min(a.steps.size(), b.steps.size());
    d.same_steps = a.steps.size() == b.steps.size();
    double force = 0, nodal = 0, u = 0;
    for (std::size_t k = 0; k < steps; ++k) {
        const double time = by.time * a.steps[k].time;
        if (std::abs(b.steps[k].time - time) > same_time * by.time * a.steps.back().time) d.same_steps = false;
        d.iterations += b.steps[k].iterations - a.steps[k].iterations;
        for (std::size_t i = 0; i < number.size(); ++i) { // those behind are of no body's mesh
            const Vec3 expected = by.length * (by.turn * a.steps[k].u[i]);
            u = std::max(u, expected.norm());
            const Vec3& found = b.steps[k].u[static_cast<std::size_t>(number[i])];
            d.displacement = std::max(d.displacement, (found - expected).norm());
        }
        for (std::size_t p = 0; p < a.steps[k].slave_force.size(); ++p) {
            Vec3 sum_a = Vec3::Zero(), sum_b = Vec3::Zero();
            double sizes = 0;
            for (const auto& [node, lambda] : a.steps[k].slave_force[p]) {
                const Vec3 expected = by.force() * (by.turn * lambda);
                sum_a += expected;
                sizes += expected.norm();
                nodal = std::max(nodal, expected.norm());
                if (by.swap_sides) continue;
                const Vec3& found = b.steps[k].slave_force[p].at(number[static_cast<std::size_t>(node)]);
                d.nodal_force = std::max(d.nodal_force, (found - expected).norm());
            }
            for (const auto& [node, lambda] : b.steps[k].slave_force[p]) sum_b += by.swap_sides ? -lambda : lambda;
            force = std::max(force, sizes);
            d.force = std::max(d.force, (sum_b - sum_a).norm());
        }
    }
    const auto over = [](double& x, double largest) { x = largest > 0 ? x / largest : x; };
    over(d.force, force), over(d.nodal_force, nodal), over(d.displacement, u);
    return d;
}

} // namespace osculate::support
