#include "app/run/gradients.hpp"

#include "app/overloaded.hpp"
#include "osculate/output/csv_table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace osculate::app {

Gradients::Gradients(const LoadedScene& loaded, const std::string& resolved, int threads, Timings& timings,
                     std::vector<Fault>& faults)
    : loaded_(loaded) {
    time::StepperOptions options = loaded.plan.stepper;
    options.audit = false;
    run_ = std::make_unique<time::AdjointRun>(loaded.plan.model, loaded.plan.stages, options, timings);
    for (const auto& [name, gradient] : loaded.scene.output.gradients)
        for (const auto& [label, derivative] : gradient.by) {
            if (!number_.try_emplace({derivative.key, derivative.change, derivative.step}, scenes_.size()).second)
                continue;
            scenes_.push_back(changed_scenes(loaded, resolved, derivative, "output.gradients." + name + ".by." + label,
                                             threads, timings, faults));
            const ChangedScenes& changed = scenes_.back();
            const auto run_of = [&](std::size_t side) {
                const Plan& plan = changed.sides[side]->plan;
                return std::make_unique<time::PerturbedRun>(plan.model, plan.stages, options, timings);
            };
            if (changed.sides[0] && changed.sides[1]) run_->add(run_of(0), run_of(1), changed.step);
        }
}

time::FinalQuantity Gradients::quantity(const scene::Gradient& gradient) const {
    const Plan& plan = loaded_.plan;
    const auto nodes = static_cast<std::size_t>(plan.model.nodes());
    const std::vector<Index>& first = run_->first_coupling();
    time::FinalQuantity q;
    q.weights.nodes.reset(nodes);
    q.weights.couplings.assign(static_cast<std::size_t>(first.back()), Vec3::Zero());
    std::visit(Overloaded{[&](const scene::MeanDisplacement& mean) {
                              const auto set = std::ranges::find(plan.model.sets, mean.set, &model::Set::name);
                              for (const Index node : set->nodes)
                                  q.weights.nodes[node] +=
                                      mean.direction.normalized() / static_cast<double>(set->nodes.size());
                          },
                          [&](const scene::PairForce& force) {
                              const auto pair = std::ranges::find_if(
                                  plan.model.pairs, [&](const auto& one) { return one->name() == force.pair; });
                              const auto p = static_cast<std::size_t>(pair - plan.model.pairs.begin());
                              for (Index j = first[p]; j < first[p + 1]; ++j)
                                  q.weights.couplings[j] = force.direction.normalized();
                          },
                          [&](const scene::SupportForce& force) {
                              const auto set = std::ranges::find(plan.model.sets, force.set, &model::Set::name);
                              const auto number = static_cast<Index>(set - plan.model.sets.begin());
                              q.reactions.reset(nodes);
                              const linear::Constraints constraints(plan.model.nodes(), plan.stages.back().constraints);
                              for (Index node = 0; node < constraints.nodes(); ++node)
                                  for (int k = 0; k < 3; ++k)
                                      if (const auto* held = constraints.constraint(node, k);
                                          held != nullptr && held->set == number) {
                                          const Vec3 axis = constraints.frame(node).col(k);
                                          q.reactions[node] += axis * axis.dot(force.direction.normalized());
                                      }
                          }},
               gradient.of);
    return q;
}

void Gradients::write(const std::filesystem::path& folder) {
    if (!run_->lost().empty()) return;
    std::vector<time::FinalQuantity> quantities;
    for (const auto& [name, gradient] : loaded_.scene.output.gradients) quantities.push_back(quantity(gradient));
    const std::vector<std::vector<double>> all = run_->gradients(quantities);
    singular_ = all.empty();
    for (std::size_t g = 0; g < all.size(); ++g) {
        const auto& [name, gradient] = loaded_.scene.output.gradients[g];
        output::CsvTable table(folder / file(name), {"name", "key", "value", "derivative", "change_of_1_percent"});
        bool any = false;
        for (const auto& [label, by] : gradient.by) {
            const std::size_t number = number_.at({by.key, by.change, by.step});
            const double value = scenes_[number].value, derivative = all[g][number];
            any = any || derivative != 0;
            table.row({label, by.key, value, derivative, 0.01 * value * derivative});
        }
        if (!any) zero_.push_back(name);
    }
}

std::vector<std::string> Gradients::warnings() const {
    std::vector<std::string> list;
    if (const std::string& lost = run_->lost(); !lost.empty()) list.push_back("there are no gradients: " + lost);
    if (singular_) list.push_back("there are no gradients: the transposed tangent of a step is singular");
    for (const std::string& name : zero_)
        list.push_back(fmt::format("gradient '{}' is 0: its quantity changes with none of the numbers", name));
    return list;
}

} // namespace osculate::app
