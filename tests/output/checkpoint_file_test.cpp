/// What a checkpoint is told from others by, and that nothing it holds is lost on the way through a file.

#include "osculate/output/checkpoint_file.hpp"
#include "output/two_blocks.hpp"

#include <gtest/gtest.h>
#include <utility>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

TEST(Fingerprint, IsThatOfNodesAndElements) {
    const std::uint64_t known = fingerprint(TwoBlocks().model);
    EXPECT_EQ(fingerprint(TwoBlocks().model), known);

    TwoBlocks moved; // by one digit of one coordinate
    double& z = moved.model.X.values().back().z();
    z = std::nextafter(z, 2 * z);
    EXPECT_NE(fingerprint(moved.model), known);

    for (const std::size_t body : {0U, 1U}) { // the same nodes in other elements
        TwoBlocks renumbered;
        auto& connectivity = renumbered.model.bodies[body].mesh.blocks[0].connectivity;
        std::swap(connectivity.front(), connectivity.back());
        EXPECT_NE(fingerprint(renumbered.model), known) << body;
    }
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
