/// main of every test: gtest's, with floating-point traps from the first fixture on.

#include "support/floating_point_traps.hpp"

#include <gmock/gmock.h>

int main(int argc, char** argv) {
    testing::InitGoogleMock(&argc, argv);
    const osculate::support::FloatingPointTraps traps;
    return RUN_ALL_TESTS();
}
