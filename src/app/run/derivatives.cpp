#include "app/run/derivatives.hpp"

#include "app/run/changed_scene.hpp"
#include "app/run/gradients.hpp"
#include "osculate/output/history.hpp"
#include "osculate/output/probe_file.hpp"
#include "osculate/scene/writer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>

namespace osculate::app {

namespace {

std::string folder_of(const std::string& name) {
    return "derivatives/" + name + "/";
}

bool dynamic(const Plan& plan) {
    return std::ranges::any_of(plan.stages, [](const time::Stage& stage) { return stage.dynamics.has_value(); });
}

std::vector<Index> sets_of(const scene::Scene& scene, const Plan& plan) {
    return scene.output.history_reactions ? plan.constrained_sets : std::vector<Index>{};
}

/// Whether a column of history.csv changes smoothly with a number of the scene.
bool is_smooth(const std::string& column) {
    static const std::set<std::string> not_smooth{"dt", "iterations", "open", "stick", "slip"};
    return !not_smooth.contains(column.substr(column.rfind('.') + 1));
}

/// Whether a column of a probe says where a sample is in the undeformed model.
bool is_place(const std::string& column) {
    static const std::set<std::string> places{"s", "angle", "X", "Y", "Z"};
    return places.contains(column);
}

/// What a column is measured in: columns of one kind have one round-off.
std::string kind_of(const std::string& column) {
    if (column.starts_with("energy.")) return "energy";
    std::string name = column.substr(column.rfind('.') + 1);
    if (name.size() > 2 && name[name.size() - 2] == '_') name.resize(name.size() - 2);
    return name == "normal" || name == "friction" || name == "reaction" || name == "contact_force" ? "force" : name;
}

/// NaN: no number.
double number_in(const output::Cell& cell) {
    const double* value = std::get_if<double>(&cell);
    return value != nullptr ? *value : std::nan("");
}

output::Cell cell_of(double value) {
    return std::isnan(value) ? output::Cell{std::string()} : output::Cell{value};
}

} // namespace

/// One derivative: the two changed scenes, and its tables.
struct Derivatives::One {
    std::string name, key;
    double step = 0;      ///< of the number, SI
    bool changes = false; ///< whether anything that is written has a derivative other than 0
    std::unique_ptr<time::PerturbedPair> runs;
    std::array<std::unique_ptr<ChangedScene>, 2> sides; ///< below, above
    std::unique_ptr<output::CsvTable> history;
    std::vector<std::unique_ptr<output::CsvTable>> probes;
    std::vector<std::size_t> columns;                                ///< of history.csv
    std::vector<double> largest_value, largest_change, largest_kink; ///< of these columns
    std::vector<std::string> column_names;
};

Derivatives::Derivatives(const LoadedScene& loaded, int threads, Timings& timings) : loaded_(loaded) {
    const std::string resolved = scene::write_scene(loaded.scene);
    std::vector<Fault> faults;
    for (const auto& [name, derivative] : loaded.scene.output.derivatives) {
        auto one = std::make_unique<One>();
        one->name = name;
        one->key = derivative.key;
        ChangedScenes changed =
            changed_scenes(loaded, resolved, derivative, "output.derivatives." + name, threads, timings, faults);
        one->step = changed.step;
        one->sides = std::move(changed.sides);
        all_.push_back(std::move(one));
    }
    if (!loaded.scene.output.gradients.empty())
        gradients_ = std::make_unique<Gradients>(loaded, resolved, threads, timings, faults);
    if (!faults.empty()) throw SceneError(std::move(faults));
    time::StepperOptions options = loaded.plan.stepper;
    options.audit = false;
    const auto run_of = [&](const ChangedScene& side) {
        return std::make_unique<time::PerturbedRun>(side.plan.model, side.plan.stages, options, timings);
    };
    for (const auto& one : all_)
        one->runs = std::make_unique<time::PerturbedPair>(run_of(*one->sides[0]), run_of(*one->sides[1]));
}

Derivatives::~Derivatives() = default;

std::vector<std::string> Derivatives::files(const scene::Scene& scene, const Plan& plan) {
    std::vector<std::string> names;
    for (const auto& [name, derivative] : scene.output.derivatives) {
        names.push_back(folder_of(name) + "history.csv");
        for (const PlannedProbe& probe : plan.probes)
            names.push_back(folder_of(name) + output::ProbeFile::relative_path(probe.name));
    }
    for (const auto& [name, gradient] : scene.output.gradients) names.push_back(Gradients::file(name));
    return names;
}

std::vector<time::BesideRun*> Derivatives::runs() const {
    std::vector<time::BesideRun*> runs;
    for (const auto& one : all_) runs.push_back(one->runs.get());
    if (gradients_) runs.push_back(&gradients_->run());
    return runs;
}

void Derivatives::finish(const std::filesystem::path& folder) {
    if (gradients_) gradients_->write(folder);
}

void Derivatives::open(output::OutputFolder& folder) {
    const Plan& plan = loaded_.plan;
    folder.claim(files(loaded_.scene, plan));
    const std::vector<std::string> all = output::History::columns(plan.model, loaded_.scene.output.history_pairs,
                                                                  sets_of(loaded_.scene, plan), dynamic(plan));
    for (const auto& one : all_) {
        for (std::size_t c = 0; c < all.size(); ++c)
            if (c == 0 || is_smooth(all[c])) {
                one->columns.push_back(c);
                one->column_names.push_back(all[c]);
            }
        one->largest_value.assign(one->columns.size(), 0);
        one->largest_change = one->largest_kink = one->largest_value;
        const std::filesystem::path& path = folder.path();
        one->history =
            std::make_unique<output::CsvTable>(path / (folder_of(one->name) + "history.csv"), one->column_names);
        for (const PlannedProbe& probe : plan.probes) {
            std::vector<std::string> names{"time"};
            for (const output::ProbeColumn& column : probe.probe->columns()) names.push_back(column.name);
            one->probes.push_back(std::make_unique<output::CsvTable>(
                path / (folder_of(one->name) + output::ProbeFile::relative_path(probe.name)), names));
        }
    }
}

void Derivatives::accepted(const time::AcceptedStep& step, const std::vector<std::size_t>& probes) {
    const auto snapshot_of = [&](const Plan& plan, const model::State& state,
                                 const equilibrium::Equilibrium& equilibrium) {
        return output::Snapshot(plan.model, state, equilibrium.contact(),
                                {equilibrium.constraints(), equilibrium.unbalanced()}, {}, step.dt);
    };
    const auto history_of = [&](const Plan& plan, const output::Snapshot& snapshot,
                                const equilibrium::Equilibrium& equilibrium, const time::Ledger* ledger) {
        return output::History::cells(snapshot, equilibrium.constraints(), step.dt, step.iterations,
                                      loaded_.scene.output.history_pairs, sets_of(loaded_.scene, plan), dynamic(plan),
                                      ledger);
    };
    const auto here = history_of(loaded_.plan, snapshot_of(loaded_.plan, step.state, step.equilibrium),
                                 step.equilibrium, step.ledger);
    for (const auto& one : all_) {
        if (!one->runs->lost().empty()) continue;
        std::array<std::optional<output::Snapshot>, 2> at;
        std::array<std::vector<output::Cell>, 2> cells;
        for (std::size_t k = 0; k < 2; ++k) {
            const Plan& plan = one->sides[k]->plan;
            const time::PerturbedRun& run = k == 0 ? one->runs->below() : one->runs->above();
            at[k].emplace(snapshot_of(plan, run.state(), run.equilibrium()));
            cells[k] = history_of(plan, *at[k], run.equilibrium(), run.ledger());
        }
        std::vector<output::Cell> row{step.state.time};
        for (std::size_t i = 1; i < one->columns.size(); ++i) {
            const std::size_t c = one->columns[i];
            const double below = number_in(cells[0][c]), above = number_in(cells[1][c]), now = number_in(here[c]);
            row.push_back(cell_of((above - below) / (2 * one->step)));
            if (std::isnan(above - below)) continue;
            one->changes = one->changes || above != below;
            one->largest_value[i] = std::max(one->largest_value[i], std::abs(now));
            one->largest_change[i] = std::max(one->largest_change[i], std::abs(above - below));
            one->largest_kink[i] = std::max(one->largest_kink[i], std::abs(above + below - 2 * now));
        }
        one->history->row(row);
        for (const std::size_t p : probes) {
            const auto below = one->sides[0]->plan.probes[p].probe->rows(*at[0]),
                       above = one->sides[1]->plan.probes[p].probe->rows(*at[1]);
            const auto& columns = loaded_.plan.probes[p].probe->columns();
            for (std::size_t r = 0; r < std::min(below.size(), above.size()); ++r) {
                std::vector<output::Cell> cells_now{step.state.time};
                for (std::size_t c = 0; c < columns.size(); ++c) {
                    one->changes =
                        one->changes || (!std::isnan(above[r][c] - below[r][c]) && above[r][c] != below[r][c]);
                    cells_now.push_back(is_place(columns[c].name)
                                            ? cell_of(above[r][c])
                                            : cell_of((above[r][c] - below[r][c]) / (2 * one->step)));
                }
                one->probes[p]->row(cells_now);
            }
        }
    }
}

std::vector<std::string> Derivatives::warnings() const {
    constexpr double bent = 0.05;      // of the change: what one step of Newton leaves out is then no trifle
    constexpr double round_off = 1e-7; // of the value: what the solver's tolerance leaves
    Eigen::AlignedBox3d box;
    for (const Vec3& X : loaded_.plan.model.X) box.extend(X);
    const double length = box.diagonal().norm();
    std::vector<std::string> list;
    if (gradients_) list = gradients_->warnings();
    for (const auto& one : all_) {
        if (const std::string& lost = one->runs->lost(); !lost.empty())
            list.push_back(fmt::format("derivative '{}' ends before its run does: {}", one->name, lost));
        if (!one->changes && one->runs->lost().empty()) {
            list.push_back(fmt::format("derivative '{}' is 0: nothing that the run writes changes with '{}'", one->name,
                                       one->key));
            continue;
        }
        std::map<std::string, double> values, changes; // largest of a kind
        for (std::size_t i = 1; i < one->columns.size(); ++i) {
            const std::string kind = kind_of(one->column_names[i]);
            values[kind] = std::max(values[kind], one->largest_value[i]);
            changes[kind] = std::max(changes[kind], one->largest_change[i]);
        }
        // of a moment that is 0 only its forces tell the round-off
        for (const auto& [moment, force] : {std::pair{"moment", "force"}, std::pair{"angular", "linear"}})
            for (auto* of_kind : {&values, &changes})
                (*of_kind)[moment] = std::max((*of_kind)[moment], length * (*of_kind)[force]);
        std::string worst;
        double most = bent;
        for (std::size_t i = 1; i < one->columns.size(); ++i) {
            const std::string kind = kind_of(one->column_names[i]);
            const double kink = one->largest_kink[i], change = changes[kind];
            if (kind == "penetration" || // of closed gaps: round-off
                kink <= round_off * values[kind] || kink <= most * change)
                continue;
            most = kink / change;
            worst = one->column_names[i];
        }
        if (!worst.empty())
            list.push_back(fmt::format(
                "derivative '{}': {} changes by {:.2g} more one way than the other, so that the derivative may be "
                "wrong; where contact opens, begins to slide or passes from facet to facet it has a kink",
                one->name, worst, most));
    }
    return list;
}

} // namespace osculate::app
