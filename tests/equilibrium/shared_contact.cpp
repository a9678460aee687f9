/// Contact whose slave nodes several processes share, against contact in one.

#include "osculate/app/compile.hpp"
#include "osculate/equilibrium/contact_term.hpp"
#include "osculate/scene/reader.hpp"
#include "support/random.hpp"
#include "support/source_tree.hpp"
#include "support/thread_ranks.hpp"

#include <gtest/gtest.h>

namespace osculate::equilibrium::OSCULATE_THIS_FILE {
namespace {

/// All numbers that other parts of the program take from contact, over a few iterates of two attempts.
std::vector<double> numbers_of_contact(const std::vector<scene::Override>& settings, Ranks* ranks) {
    Timings timings;
    const scene::Scene scene = scene::read_scene(support::source_tree() + "/tests/scenes/press.yaml", settings);
    const app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const model::Model& model = plan.model;
    const model::ContactPair& pair = *model.pairs[0];
    const linear::Constraints constraints(model.nodes(), plan.stages[1].constraints);
    const linear::Unknowns unknowns(constraints, pair.slaves().node);
    ContactTerm term(model.pairs, constraints, unknowns, timings, 1);
    if (ranks != nullptr) term.share_out(*ranks);

    std::vector<double> numbers;
    const auto add = [&](const auto& values) { numbers.insert(numbers.end(), values.begin(), values.end()); };
    const auto add_field = [&](const Field& field) {
        for (const Vec3& value : field) add(value);
    };
    support::Random random(26);
    model::State state;
    state.u.assign(model.X.size(), Vec3::Zero());
    state.contact.push_back(model::opened(model.pairs[0]));
    for (int attempt = 0; attempt < 2; ++attempt) {
        Iterate at;
        at.u = state.u;
        at.x = at.tail = at.u;
        const auto place = [&] {
            for (std::size_t i = 0; i < at.x.size(); ++i) at.x[i] = model.X[i] + at.u[i];
        };
        place();
        term.begin(state, at, {}, 1);
        Statuses statuses{state.contact[0].status};
        for (std::size_t j = 0; j < statuses[0].size(); ++j)
            statuses[0][j] = j % 3 == 0   ? contact::Status::stick
                             : j % 3 == 1 ? contact::Status::slip
                                          : contact::Status::open;
        term.set_statuses(statuses, StatusRule::frozen, false);
        Vector z(unknowns.size()), y(unknowns.size());
        for (int iterate = 0; iterate < 3; ++iterate) {
            for (Vec3& u : at.u) u += random.vector(0.01);
            place();
            for (double& value : z) value = 1e3 * random.uniform();
            at.z = &z;
            EXPECT_TRUE(term.evaluate(at));
            const model::ContactEvaluation& evaluation = term.evaluations()[0];
            for (Index j = 0; j < pair.size(); ++j) {
                const contact::ContactPoint& point = evaluation.point(j);
                add(std::vector<double>{point.found ? point.gap : -1, evaluation.area(j), evaluation.hit(j).distance,
                                        static_cast<double>(evaluation.facets()[j])});
                add(evaluation.state(j, Vec3::UnitZ()).drift);
            }
            y.setZero();
            (void)term.write_rows(y);
            add(y);
            Field f(model.X.size(), Vec3::Zero());
            term.add_forces(f);
            add_field(f);
            term.linearise(at);
            f.assign(model.X.size(), Vec3::Zero());
            y.setZero();
            Field along(model.X.size());
            for (Vec3& value : along) value = random.vector();
            term.add_product({along, z}, f, y);
            add_field(f);
            add(y);
        }
        // what needs the variations of all slave nodes in one process
        for (const LinearisedContact& near : term.linearise_near(0.5)) {
            add(near.A.reshaped());
            add(near.F.reshaped());
            add(near.w);
        }
        state.u = at.u;
        state.contact.clear();
        term.complete(z, state);
    }
    return numbers;
}

class SharedContact : public ::testing::TestWithParam<std::vector<scene::Override>> {};

TEST_P(SharedContact, HasTheBitsOfContactInOneProcess) {
    const std::vector<double> alone = numbers_of_contact(GetParam(), nullptr);
    ASSERT_GT(alone.size(), 1000U);
    EXPECT_TRUE(std::ranges::any_of(alone, [](double value) { return value < 0; }));
    for (const int count : {1, 2, 5})
        support::on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
            EXPECT_EQ(numbers_of_contact(GetParam(), ranks.get()), alone) << ranks->rank() << " of " << count;
        });
}

using Settings = std::vector<scene::Override>;
const scene::Override blend{"contact.joint.master.surface", "blend"}, node{"contact.joint.discretisation", "node"};
INSTANTIATE_TEST_SUITE_P(Of, SharedContact,
                         ::testing::Values(Settings{}, Settings{node}, Settings{blend}, Settings{blend, node},
                                           Settings{{"contact.joint.discretisation", "mortar"}},
                                           Settings{{"contact.joint.master.surface", "rpim"}},
                                           Settings{{"contact.joint.friction", "0"}}));

} // namespace
} // namespace osculate::equilibrium::OSCULATE_THIS_FILE
