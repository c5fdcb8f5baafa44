#include "systems/foundation/fnv1a.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

// Of http://www.isthe.com/chongo/tech/comp/fnv, the test vectors of 64 bits.
TEST(Fnv1a, GivesThePublishedNumbers) {
  EXPECT_EQ(fnv1a(""), 0xcbf29ce484222325U);
  EXPECT_EQ(fnv1a("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(fnv1a("foobar"), 0x85944171f73967e8U);
}

TEST(Fnv1a, GoesOnFromANumber) { EXPECT_EQ(fnv1a("bar", fnv1a("foo")), fnv1a("foobar")); }

}  // namespace
}  // namespace flinch
