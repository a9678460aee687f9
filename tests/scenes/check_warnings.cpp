/// What `osculate check` says of surfaces, meshes and supports that cost time or accuracy: each where it should speak, and
/// where it must not.

#include "scenes/program.hpp"

#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CheckWarnings : public Program {
protected:
    /// What is said of a scene of the repository with changes; it is expected to be valid.
    std::string checked(const std::string& scene, const std::vector<std::string>& changes = {}) const {
        std::vector<std::string> arguments{"check", scene_file(scene)};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    }
    const std::string press = "tests/scenes/press.yaml";
};

TEST_F(CheckWarnings, BodiesThatGravityPassesOverAreNamed) {
    const std::string down = "gravity=[0, 0, -9.81 m/s^2]", says = "gravity does not act on it",
                      heavy = ".material.linear_elastic.density=2000 kg/m^3";
    EXPECT_THAT(checked(press, {down, "bodies.cap" + heavy}), HasSubstr("warning: bodies.base: " + says));
    EXPECT_THAT(checked(press, {down, "bodies.cap" + heavy, "bodies.base" + heavy}), Not(HasSubstr(says)));
    EXPECT_THAT(checked(press), Not(HasSubstr(says)));
    const Outcome none = osculate({"check", scene_file(press), "--set", down});
    EXPECT_EQ(none.code, 2);
    EXPECT_THAT(none.err, HasSubstr("gravity: expected a body with a density or a mass, on which it acts, found none"));
}

TEST_F(CheckWarnings, AMuchStifferSlaveIsNamedWhateverTheMeshes) {
    const std::string stiff = "bodies.cap.material.linear_elastic.E=30 GPa",
                      fine = "bodies.cap.mesh.block.divisions=[12, 12, 2]",
                      apart = "bodies.cap.mesh.block.origin=[0.3 m, 0.45 m, 3 m]",
                      mortar = "contact.joint.discretisation=mortar",
                      says = "warning: contact.joint.slave: its body is 1e+03 times as stiff as the master's";
    for (const std::vector<std::string>& changes :
         {std::vector{stiff}, std::vector{stiff, fine}, std::vector{stiff, apart}, std::vector{stiff, mortar}})
        EXPECT_THAT(checked(press, changes), HasSubstr(says)) << changes.back();
    EXPECT_THAT(checked(press, {"bodies.base.material.linear_elastic.E=30 GPa"}), Not(HasSubstr("times as stiff")))
        << "the softer side is the slave";
    EXPECT_THAT(checked(press, {"bodies.cap.material.linear_elastic.E=300 MPa", fine}),
                Not(HasSubstr("times as stiff")))
        << "10 times, and the finer side";
}

TEST_F(CheckWarnings, OneFullHexahedronThroughAPlateThatBendsIsNamed) {
    const std::vector<std::string> plate{"bodies.cap.mesh.block.size=[1 m, 1 m, 0.1 m]",
                                         "bodies.cap.mesh.block.divisions=[3, 3, 1]"};
    const auto with = [&](const std::string& change) {
        std::vector<std::string> changes = plate;
        changes.push_back(change);
        return checked(press, changes);
    };
    // (1-nu)/((1+nu)(1-2nu)) + (0.3333/0.1)^2/(2(1+nu)) with nu = 0.3
    EXPECT_THAT(checked(press, plate),
                HasSubstr("warning: bodies.cap.hex_formulation: full, but 9 of 9 hexahedra reach through the whole "
                          "thickness: the body is about 5.6 times too stiff in bending; use incompatible_modes, which "
                          "bends correctly"));
    EXPECT_THAT(
        with("bodies.cap.material={neo_hookean: {E: 10 MPa, nu: 0.3}}"),
        AllOf(HasSubstr("use elements half as long as the body is thick"), Not(HasSubstr("incompatible_modes"))))
        << "which small strain alone has";
    const std::string silent = "thickness: the body is about";
    EXPECT_THAT(with("bodies.cap.hex_formulation=incompatible_modes"), Not(HasSubstr(silent)));
    EXPECT_THAT(with("bodies.cap.mesh.block.divisions=[3, 3, 2]"), Not(HasSubstr(silent)));
    EXPECT_THAT(with("bodies.cap.mesh.block.divisions=[20, 20, 1]"), Not(HasSubstr(silent)))
        << "elements shorter than thick do not lock";
    EXPECT_THAT(with("supports.top={fix: [z]}"), Not(HasSubstr(silent))) << "a plate that lies on a bed is not bent";
    EXPECT_THAT(checked("configs/tutorials/two_bars.yaml"), Not(HasSubstr(silent))) << "bars that meet head on";
    EXPECT_THAT(checked("configs/extreme/stack_of_20.yaml"), Not(HasSubstr(silent))) << "plates between plates";
}

TEST_F(CheckWarnings, LoadsOnWhatIsHeldAreNamed) {
    const std::string bolt = "configs/tutorials/bolted_joint.yaml", moves_nothing = "and moves nothing";
    EXPECT_THAT(
        checked(bolt, {"stages.load.force={bolt: [0 N, 0 N, -1 kN]}"}),
        HasSubstr("warning: stages.load.force.bolt.z: it acts along a direction that is held, or driven in this "
                  "or an earlier stage"));
    EXPECT_THAT(checked(bolt), Not(HasSubstr(moves_nothing))) << "free when it is tightened, without force when driven";
    const auto with = [&](const std::string& set) {
        return checked(press, {"stages.press.nodal_force={" + set + ": [1 N, 0 N, 0 N]}"});
    };
    EXPECT_THAT(with("bed"), HasSubstr("warning: stages.press.nodal_force.bed.x: it acts along"));
    EXPECT_THAT(with("under"), Not(HasSubstr(moves_nothing)));
}

TEST_F(CheckWarnings, FacetsThatTwoPairsKeepApartAreNamed) {
    const std::string twice = "contact.joint already pairs these facets", ways = "and its master is the slave there";
    EXPECT_THAT(checked(press, {"contact.again={slave: under, master: {set: ground}}"}),
                HasSubstr("warning: contact.again: " + twice));
    EXPECT_THAT(checked(press, {"contact.back={slave: ground, master: {set: under}}"}),
                AllOf(HasSubstr("warning: contact.back: its slave is the master of contact.joint"), HasSubstr(ways)));
    EXPECT_THAT(checked(press, {"contact.wall={slave: rear, master: {set: ground}}"}),
                AllOf(Not(HasSubstr(twice)), Not(HasSubstr(ways))))
        << "one master for two slaves";
    EXPECT_THAT(checked("configs/extreme/block_in_groove.yaml"), AllOf(Not(HasSubstr(twice)), Not(HasSubstr(ways))));
}

TEST_F(CheckWarnings, SideFacesInASlaveAreNamed) {
    EXPECT_THAT(checked(press, {"sets.low={body: cap, box: {min: [0 m, 0 m, 0.9 m], max: [2 m, 2 m, 1.3 m]}}",
                                "contact.joint.slave=low"}),
                HasSubstr("warning: contact.joint.slave: 12 of 21 facets are at right angles to the master"));
    const std::string says = "right angles to the master";
    EXPECT_THAT(checked(press), Not(HasSubstr(says)));
    EXPECT_THAT(checked("configs/extreme/wheel_rolls_freely.yaml"), Not(HasSubstr(says))) << "all round, without edges";
    EXPECT_THAT(checked("configs/validation/thrown_ball.yaml"), Not(HasSubstr("face away from it")))
        << "any side may come to face the plate";
}

TEST_F(CheckWarnings, CurvedSurfacesThatFitOneAnotherAreNamedOnFacets) {
    const std::string tubes = "configs/validation/nested_tubes.yaml", facets = "contact.touch.master.surface=facets",
                      says = "curved surfaces fit one another", inner = "bodies.inner.mesh.tube.divisions=[80, 1, 2]";
    const auto outer = [](int around) {
        std::string change = "bodies.outer.mesh.tube.divisions=[";
        return change.append(std::to_string(around)).append(", 1, 2]");
    };
    EXPECT_THAT(checked(tubes, {facets, inner, outer(64)}),
                HasSubstr("warning: contact.touch.master.surface: facets, but the two " + says));
    EXPECT_THAT(checked(tubes, {facets, inner, outer(64), "contact.touch.discretisation=mortar"}), HasSubstr(says));
    EXPECT_THAT(checked(tubes, {inner, outer(64)}), Not(HasSubstr(says))) << "blend";
    EXPECT_THAT(checked(tubes, {facets, inner, outer(80)}), Not(HasSubstr(says))) << "node on node";
    EXPECT_THAT(checked("configs/validation/hertz_cylinder.yaml", {"contact.touch.master.surface=facets"}),
                Not(HasSubstr(says)))
        << "surfaces that part at once";
    EXPECT_THAT(checked(press), Not(HasSubstr(says))) << "a plane has no sagitta";
}

TEST_F(CheckWarnings, SharpEdgesInsideAMasterAreNamed) {
    // the upper half of the base: 16 edges round its top, 4 down its corners
    EXPECT_THAT(checked(press, {"sets.ground={body: base, box: {min: [-1 m, -1 m, 0.4 m], max: [3 m, 3 m, 2 m]}}"}),
                HasSubstr("warning: contact.joint.master.set: 20 edges inside it are sharper than 40 degrees"));
    const std::string says = "edges inside it";
    EXPECT_THAT(checked(press), Not(HasSubstr(says))) << "its rim is the set's, not inside";
    EXPECT_THAT(checked("configs/tutorials/ring_on_cylinder.yaml"), Not(HasSubstr(says))) << "32 facets to a round";
}

TEST_F(CheckWarnings, ASupportThatHoldsNothingIsNamed) {
    const std::string says = "it holds nothing";
    EXPECT_THAT(checked(press, {"supports.top={fix: []}"}), HasSubstr("warning: supports.top: " + says));
    EXPECT_THAT(checked(press, {"supports.rear={fix: []}"}), Not(HasSubstr(says))) << "the stages drive it";
    EXPECT_THAT(checked(press), Not(HasSubstr(says)));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
