// 6 robots that differ from their model, each drawn anew, in contact-free motion at 1.5 m/s and 12 or 17
// m/s^2; beside them the model itself with the same noise and motions. FLINCH_ROBOTS in the environment says
// how many robots instead; docs/theory.md cites 50.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/experiments/simulated/realistic_robots.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::FreeMotion;
using test::FreeMotionErrors;
using test::RobotTrial;

int wanted_robots() { return test::wanted("FLINCH_ROBOTS", 6); }

TEST(RealisticRobots, MoveWithoutAFaultAndAlignedWithoutAContactThatIsNone) {
  std::printf("%s", test::table_head().c_str());
  for (const FreeMotion motion : {FreeMotion::square, FreeMotion::point_to_point, FreeMotion::harsh}) {
    for (const bool realistic : {true, false}) {
      for (const bool aligned : {true, false}) {
        const RobotTrial trial{.motion = motion, .realistic = realistic, .aligned = aligned};
        const FreeMotionErrors errors = test::try_robots(trial, wanted_robots());
        std::printf("%s", test::table_row(trial, errors).c_str());
        EXPECT_THAT(errors.faults, ::testing::IsEmpty());
        if (aligned) {
          EXPECT_EQ(errors.crossings, 0);
          EXPECT_EQ(errors.alarmed_robots, 0);
        }
      }
    }
  }
}

}  // namespace
}  // namespace flinch
