#include "systems/robot/workspace_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const PlanarRrr rig(rig_robot(RigGeometry::individual, RigFriction::none));

// At home: |det A| 0.4519, |det B| 0.2216, sigma_sc 0.18533 m, drives at 24.379 to 25.963 degrees.
const WorkspaceLimits just_outside_home{.centre = {},
                                        .max_distance = 0.0,
                                        .max_rotation = 0.0,
                                        .min_abs_det_A = 0.4518,
                                        .min_abs_det_B = 0.2215,
                                        .min_self_collision_distance = 0.1853,
                                        .min_active = 0.4254,
                                        .max_active = 0.4532};

TEST(WorkspaceLimits, AllowEverythingByDefault) { EXPECT_THAT(problems(WorkspaceLimits{}, rig), IsEmpty()); }

TEST(WorkspaceLimits, MayLieJustOutsideTheHomePose) {
  EXPECT_THAT(problems(just_outside_home, rig), IsEmpty());
}

TEST(WorkspaceLimits, MustNotExcludeTheHomePose) {
  const WorkspaceLimits limits{.centre = {},
                               .max_distance = -0.1,
                               .max_rotation = std::nan(""),
                               .min_abs_det_A = 0.4520,
                               .min_abs_det_B = 0.2217,
                               .min_self_collision_distance = 0.1854,
                               .min_active = 0.4256,
                               .max_active = 0.4531};
  EXPECT_THAT(
      problems(limits, rig),
      ElementsAre(
          "max_distance is -0.1 m; it must be at least that at the home pose, 0 m",
          "max_rotation is nan rad (nan deg); it must be at least that at the home pose, 0 rad (0 deg)",
          HasSubstr("min_abs_det_A is 0.452; it must be at most that at the home pose, 0.45185"),
          HasSubstr("min_abs_det_B is 0.2217;"), HasSubstr("min_self_collision_distance is 0.1854 m;"),
          HasSubstr("min_active_angle is 0.4256 rad (24.3851 deg);"),
          HasSubstr("max_active_angle is 0.4531 rad (25.9607 deg);")));
}

Kinematics at_home() {
  Kinematics home;
  rig.kinematics(rig.home_pose(), PlatformVector::Zero(3), home);
  return home;
}

TEST(WorkspaceLimits, AreKeptWhereNoneIsExceeded) {
  EXPECT_TRUE(is_within({}, rig, at_home()));
  EXPECT_TRUE(is_within(just_outside_home, rig, at_home()));
  EXPECT_FALSE(is_within({}, rig, Kinematics()));
}

TEST(WorkspaceLimits, AreEachExceededAlone) {
  std::vector<WorkspaceLimits> narrow(7);
  narrow[0].centre = Eigen::Vector2d(0.011, 0.0);
  narrow[0].max_distance = 0.01;
  narrow[1].max_rotation = -1e-3;
  narrow[2].min_abs_det_A = 0.4520;
  narrow[3].min_abs_det_B = 0.2217;
  narrow[4].min_self_collision_distance = 0.1854;
  narrow[5].min_active = 0.4256;
  narrow[6].max_active = 0.4531;
  for (const WorkspaceLimits& one : narrow) EXPECT_FALSE(is_within(one, rig, at_home()));
}

}  // namespace
}  // namespace flinch
