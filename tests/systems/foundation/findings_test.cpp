#include "systems/foundation/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace flinch {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Findings, SayFieldValueUnitAndRule) {
  Findings found("post.");
  found.positive("radius", 0.0, "m");
  found.not_negative("friction", -0.5);
  found.at_most(1.0, "restitution", 1.5);
  found.finite("path", std::array{0.0, infinity}, "m");
  found.add("sign", 2.0, "", "must be 1 or -1");
  found.require(false, "shape is none");
  EXPECT_FALSE(found.none());
  EXPECT_THAT(
      found.take(),
      ElementsAre("post.radius is 0 m; it must be positive", "post.friction is -0.5; it must not be negative",
                  "post.restitution is 1.5; it must be at most 1", "post.path[1] is inf m; it must be finite",
                  "post.sign is 2; it must be 1 or -1", "post.shape is none"));
}

TEST(Findings, LeaveOutWhatIsRight) {
  Findings found;
  found.positive("mass", 1e-300, "kg");
  found.not_negative("friction", 0.0);
  found.at_most(1.0, "restitution", 1.0);
  found.finite("x", -1e300);
  found.finite("path", std::array{0.0, 1.0}, "m");
  found.require(true, "never said");
  EXPECT_TRUE(found.none());
  EXPECT_THAT(found.take(), IsEmpty());
}

TEST(Findings, TakeNothingThatIsNotFiniteForANumber) {
  for (const double value : {std::nan(""), infinity, -infinity}) {
    Findings found;
    found.positive("a", value);
    found.not_negative("b", value);
    found.at_most(1.0, "c", value);
    found.finite("d", value);
    EXPECT_EQ(found.take().size(), 4U) << value;
  }
}

TEST(Findings, LeaveSentencesOfAPartAsTheyAre) {
  Findings found("bench: ");
  found.add_all({"post.radius is 0 m; it must be positive"});
  EXPECT_THAT(found.take(), ElementsAre("post.radius is 0 m; it must be positive"));
}

}  // namespace
}  // namespace flinch
