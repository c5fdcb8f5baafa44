#include "systems/motion/travelled_path.h"

#include <gtest/gtest.h>

namespace flinch::test {
namespace {

const ConfigurationSpace planar(ConfigurationSpace::Kind::planar_pose);

/// A motion along x with 0.5 m/s, for `duration` from `begin` on, which ends at x = 0.
TravelledPath along_x(Time duration, Time begin = {}) {
  TravelledPath path;
  for (Time t{}; t <= duration; t += TravelledPath::spacing)
    path.add(begin + t, begin, Eigen::Vector3d(0.5 * to_seconds(t - duration), 0.2, 0.1));
  return path;
}

TEST(TravelledPath, LeadsBackByTheDistanceToAPoseWhereItWas) {
  const PlatformVector back = along_x(300ms).way_back(planar, Eigen::Vector3d(0, 0.2, 0.1), 0.0999, 0.1);
  EXPECT_LT((back - Eigen::Vector3d(-0.1, 0, 0)).norm(), 1e-12);
}

TEST(TravelledPath, LeadsToItsOldestPoseWhereItIsShorter) {
  const PlatformVector back = along_x(60ms).way_back(planar, Eigen::Vector3d(0, 0.2, 0.1), 0.1, 0.1);
  EXPECT_LT((back - Eigen::Vector3d(-0.03, 0, 0)).norm(), 1e-12);
}

TEST(TravelledPath, HoldsTheLast310Milliseconds) {
  const PlatformVector back = along_x(5s).way_back(planar, Eigen::Vector3d(0, 0.2, 0.1), 1.0, 0.1);
  EXPECT_LT((back - Eigen::Vector3d(-0.155, 0, 0)).norm(), 1e-12);
}

TEST(TravelledPath, IsAsLongWhateverTheTick) {
  for (const Time tick : {1ms, 3ms, 4ms}) {
    TravelledPath path;
    for (Time t{}; t <= 3s; t += tick) path.add(t, {}, Eigen::Vector3d(to_seconds(t), 0, 0));
    const double way = path.way_back(planar, Eigen::Vector3d(3, 0, 0), 1.0, 0.1).norm();
    EXPECT_GE(way, 0.31) << tick.count();
    EXPECT_LE(way, 32 * 0.012) << tick.count();
  }
}

TEST(TravelledPath, CountsRotationsAsTheMotionOfAPoint) {
  TravelledPath path;
  for (int k = 0; k <= 20; ++k) path.add(k * TravelledPath::spacing, {}, Eigen::Vector3d(0, 0, 0.05 * k));
  const PlatformVector back = path.way_back(planar, Eigen::Vector3d(0, 0, 1.0), 0.0999, 0.2);
  EXPECT_LT((back - Eigen::Vector3d(0, 0, -0.5)).norm(), 1e-12);
}

TEST(TravelledPath, LeadsNowhereWhereTheRobotHardlyMoved) {
  EXPECT_EQ(TravelledPath().way_back(planar, Eigen::Vector3d(0, 0.2, 0.1), 0.1, 0.1).size(), 0);
  EXPECT_EQ(along_x(10ms).way_back(planar, Eigen::Vector3d(0, 0.2, 0.1), 0.1, 0.1).size(), 0);
  EXPECT_EQ(along_x(30ms).way_back(planar, Eigen::Vector3d(0, 0.2, 0.1), 0.1, 0.1).size(), 3);
}

TEST(TravelledPath, LeadsFurtherBackFromWhereItHasLedAlready) {
  const TravelledPath path = along_x(300ms);
  for (const double x : {-0.03, -0.04, -0.0401}) {
    const PlatformVector back = path.way_back(planar, Eigen::Vector3d(x, 0.2, 0.1), 0.0999, 0.1);
    ASSERT_EQ(back.size(), 3) << x;
    EXPECT_LT(back[0], -0.09) << x << ": not to where the contact was";
  }
  EXPECT_EQ(path.way_back(planar, Eigen::Vector3d(-0.145, 0.2, 0.1), 0.0999, 0.1).size(), 0) << "at its end";
}

TEST(TravelledPath, LeadsNowhereFromBesideIt) {
  const TravelledPath path = along_x(300ms);
  EXPECT_EQ(path.way_back(planar, Eigen::Vector3d(0, 0.251, 0.1), 0.1, 0.1).size(), 0);
  EXPECT_EQ(path.way_back(planar, Eigen::Vector3d(-0.05, 0.1, 0.1), 0.1, 0.1).size(), 0);
  EXPECT_EQ(path.way_back(planar, Eigen::Vector3d(0, 0.249, 0.1), 0.1, 0.1).size(), 3);
}

TEST(TravelledPath, ForgetsWhatWasBeforeAnInterruption) {
  TravelledPath path = along_x(300ms);
  for (const Time t : {2000ms, 2010ms, 2020ms, 2030ms})
    path.add(t, 2000ms, Eigen::Vector3d(0, 0.2 + to_seconds(t - 2000ms), 0.1));
  const PlatformVector back = path.way_back(planar, Eigen::Vector3d(0, 0.23, 0.1), 0.1, 0.1);
  EXPECT_LT((back - Eigen::Vector3d(0, -0.03, 0)).norm(), 1e-12);
}

TEST(TravelledPath, LeadsBackInSpaceToo) {
  const ConfigurationSpace space(ConfigurationSpace::Kind::spatial_pose);
  PlatformVector turning(6);
  turning << 0.3, -0.2, 0.4, 0.5, -1.0, 0.7;  // m/s and rad/s
  TravelledPath path;
  Configuration pose = space.origin();
  Configuration first = pose;
  for (int k = 0; k <= 8; ++k) {
    path.add(k * TravelledPath::spacing, {}, pose);
    pose = space.plus(pose, to_seconds(TravelledPath::spacing) * turning);
  }
  const PlatformVector back = path.way_back(space, pose, 1.0, 0.1);
  EXPECT_LT(space.difference(space.plus(pose, back), first).norm(), 1e-12);
}

}  // namespace
}  // namespace flinch::test
