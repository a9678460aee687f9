#include "osculate/model/rigid_motion.hpp"

#include "osculate/mesh/generators.hpp"

#include <gmock/gmock.h>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A brick far from the origin, so that levers about the origin would not be told from translations.
Body brick() {
    return {"brick", mesh::make_block({1000, 2000, 3000}, {1, 2, 3}, {1, 1, 1}), 0, {}, {}, {}};
}

TEST(RigidHold, ABodyThatNothingHoldsIsFreeInSixWays) {
    const Body body = brick();
    const RigidHold hold(body, body.mesh.nodes);
    EXPECT_EQ(hold.free(), 6);
    EXPECT_THAT(hold.free_motions(), ElementsAre("along x", "along y", "along z", "about x", "about y", "about z"));
}

TEST(RigidHold, AFaceHeldAlongItsNormalSlidesAndTurnsInItsPlane) {
    const Body body = brick();
    RigidHold hold(body, body.mesh.nodes);
    for (const Vec3& X : body.mesh.nodes)
        if (X.z() == 3000) hold.hold(X, Vec3::UnitZ());
    EXPECT_EQ(hold.free(), 3);
    EXPECT_THAT(hold.free_motions(), ElementsAre("along x", "along y", "about z"));
}

TEST(RigidHold, AHeldEdgeLeavesAHinge) {
    const Body body = brick();
    RigidHold hold(body, body.mesh.nodes);
    for (const Vec3& X : body.mesh.nodes)
        if (X.x() == 1000 && X.z() == 3000)
            for (int k = 0; k < 3; ++k) hold.hold(X, Vec3::Unit(k));
    EXPECT_EQ(hold.free(), 1);
    EXPECT_THAT(hold.free_motions(), ElementsAre("1 oblique")) << "about the edge, not about the centre";
}

TEST(RigidHold, AHeldFaceLeavesNothing) {
    const Body body = brick();
    RigidHold hold(body, body.mesh.nodes);
    for (const Vec3& X : body.mesh.nodes)
        if (X.z() == 3000)
            for (int k = 0; k < 3; ++k) hold.hold(X, Vec3::Unit(k));
    EXPECT_EQ(hold.free(), 0);
    EXPECT_THAT(hold.free_motions(), IsEmpty());
}

/// Levers are measured by the body: a speck and a mountain are held like a brick.
TEST(RigidHold, TheSizeOfABodyDoesNotMatter) {
    for (const double size : {1e-8, 1e-3, 1e8}) {
        const Body body{"block", mesh::make_block(Vec3::Zero(), {size, 2 * size, 3 * size}, {1, 1, 1}), 0, {}, {}, {}};
        RigidHold face(body, body.mesh.nodes), slider(body, body.mesh.nodes);
        for (const Vec3& X : body.mesh.nodes)
            if (X.z() == 0) {
                slider.hold(X, Vec3::UnitZ());
                for (int k = 0; k < 3; ++k) face.hold(X, Vec3::Unit(k));
            }
        EXPECT_THAT(face.free_motions(), IsEmpty()) << size;
        EXPECT_THAT(slider.free_motions(), ElementsAre("along x", "along y", "about z")) << size;
    }
}

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
