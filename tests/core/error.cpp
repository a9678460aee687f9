#include "osculate/core/error.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

TEST(Fault, NamesEverythingItKnows) {
    const Fault fault{"tube.yaml", 12, 5, "contact.sliding.friction", "a number >= 0", "'slippery'", "friction"};
    EXPECT_EQ(fault.message(),
              "tube.yaml:12:5: contact.sliding.friction: expected a number >= 0, found 'slippery' (did "
              "you mean 'friction'?)");
}

TEST(Fault, LeavesOutWhatItDoesNotKnow) {
    Fault fault;
    fault.expected = "a body";
    EXPECT_EQ(fault.message(), "scene: expected a body");
    fault.expected.clear();
    fault.found = "nothing";
    EXPECT_EQ(fault.message(), "scene: found nothing");
    fault.file = "a.yaml";
    fault.key = "bodies";
    EXPECT_EQ(fault.message(), "a.yaml: bodies: found nothing");
}

TEST(SceneError, CarriesAndTellsEveryFault) {
    Fault first, second;
    first.found = "one";
    second.found = "two";
    const SceneError error({first, second});
    EXPECT_EQ(error.faults().size(), 2u);
    EXPECT_STREQ(error.what(), "scene: found one\nscene: found two");
}

TEST(Require, ThrowsWhenAnInvariantIsBroken) {
    EXPECT_NO_THROW(require(true, "fine"));
    try {
        require(false, "a broken invariant");
        FAIL() << "nothing thrown";
    } catch (const InternalError& error) {
        EXPECT_STREQ(error.what(), "a broken invariant");
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
