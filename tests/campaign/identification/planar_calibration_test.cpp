// Planar robots drawn anew, with legs, platform and friction that are off: what the observer takes for a
// contact in a motion that no calibration has used, before and after the dynamics were calibrated. The table
// is printed; docs/theory.md cites it. FLINCH_ROBOTS in the environment says how many robots.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>

#include "tests/identification/free_motion_errors.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::free_motion_errors;
using test::FreeMotionErrors;

TEST(PlanarRobots, FeelHalfOfWhatTheyTookForAContactOnceTheirDynamicsAreCalibrated) {
  std::printf("  robot   parameters off: before, after   motors that cog as well: before, after\n");
  const auto robots = test::wanted<std::uint64_t>("FLINCH_ROBOTS", 3);
  for (std::uint64_t seed = 1; seed <= robots; ++seed) {
    const FreeMotionErrors alone = free_motion_errors(seed, test::only_parameters);
    const FreeMotionErrors cogging = free_motion_errors(seed, test::excitation_realism);
    std::printf("  %5d %18.2f N %6.2f N %28.2f N %6.2f N\n", static_cast<int>(seed), alone.before,
                alone.after, cogging.before, cogging.after);
    EXPECT_LT(alone.after, 0.5 * alone.before) << seed;
    EXPECT_LT(cogging.after, 0.5 * cogging.before) << seed;
  }
}

}  // namespace
}  // namespace flinch
