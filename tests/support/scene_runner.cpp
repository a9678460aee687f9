#include "support/scene_runner.hpp"

#include "support/source_tree.hpp"

#include <algorithm>
#include <utility>

namespace osculate::support {

namespace {

class Keeper final : public time::StepObserver {
public:
    explicit Keeper(SceneRun& run) : run_(run) {}

    void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>& records) override {
        ++run_.attempts;
        records_ = records;
    }

    void accepted(const time::AcceptedStep& step) override {
        const model::Model& model = run_.plan.model;
        RunStep kept;
        kept.time = step.state.time;
        kept.iterations = step.iterations;
        kept.records = records_;
        kept.state = step.state;
        if (step.ledger != nullptr) kept.ledger = *step.ledger;
        const auto x = [&](Index node) -> Vec3 { return model.X[node] + step.state.u[node]; };
        for (std::size_t p = 0; p < model.pairs.size(); ++p) {
            const model::ContactEvaluation& evaluation = step.equilibrium.contact()[p];
            const model::ContactPair& pair = evaluation.pair();
            PairForces forces;
            for (Index j = 0; j < pair.size(); ++j) {
                const Vec3& lambda = step.state.contact[p].lambda[j];
                const contact::ContactPoint& point = evaluation.point(j);
                const Index slave = pair.slaves().node[j];
                forces.on_slave += lambda;
                forces.moment_on_slave += x(slave).cross(lambda);
                if (!point.found) continue;
                const double normal = lambda.dot(point.normal);
                forces.normal += normal;
                forces.friction += (lambda - normal * point.normal).norm();
                forces.penetration = std::max(forces.penetration, -point.gap);
                for (std::size_t i = 0; i < evaluation.point_nodes(j).size(); ++i) {
                    const Vec3 f = evaluation.master_force(j, static_cast<Index>(i), lambda);
                    forces.on_master += f;
                    forces.moment_on_master += x(evaluation.point_nodes(j)[i]).cross(f);
                }
            }
            kept.pairs.push_back(forces);
        }
        for (const Index s : run_.plan.constrained_sets) {
            Vec3 sum = Vec3::Zero();
            for (const Index node : model.sets[s].nodes)
                sum += step.equilibrium.constraints().reaction(node, step.equilibrium.unbalanced()[node]);
            kept.reactions.push_back(sum);
        }
        for (const model::RigidBody& body : model.rigid) {
            const auto held = [&](Index node) {
                return step.equilibrium.constraints().reaction(node, step.equilibrium.unbalanced()[node]);
            };
            kept.held_force.push_back(held(body.reference));
            kept.held_moment.emplace_back(body.radius * held(body.rotation()));
        }
        for (const Vec3& f : step.stage.force(model.X.size(), 1)) kept.load += f;
        run_.steps.push_back(std::move(kept));
        run_.contact = step.equilibrium.contact();
    }

private:
    SceneRun& run_;
    std::vector<equilibrium::IterationRecord> records_;
};

} // namespace

void run_scene(SceneRun& run, const std::string& path, const std::vector<scene::Override>& overrides,
               const EditMeshes& edit, int threads) {
    const scene::Scene scene = scene::read_scene(path, overrides);
    std::vector<mesh::Mesh> meshes = app::build_meshes(scene);
    if (edit) edit(meshes);
    run.plan = app::compile(scene, std::move(meshes), threads, run.timings);
    time::Stepper stepper(run.plan.model, run.plan.stages, run.plan.stepper, run.timings);
    Keeper keeper(run);
    stepper.run(keeper);
}

void run_scene(SceneRun& run, const std::string& path, const std::vector<scene::Override>& overrides, int threads) {
    run_scene(run, path, overrides, EditMeshes(), threads);
}

std::string shipped(const std::string& name) {
    return support::source_tree() + "/configs/" + name;
}

} // namespace osculate::support
