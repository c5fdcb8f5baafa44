#include "systems/robot/planar_place.h"

#include <gtest/gtest.h>

#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/systems/robot/mechanism_cases.h"

namespace flinch {
namespace {

Kinematics at_rest(const PlanarRrr& robot, const Eigen::Vector3d& pose) {
  Kinematics kinematics;
  robot.kinematics(pose, PlatformVector::Zero(3), kinematics);
  return kinematics;
}

// Poses on both sides of type-II singularities and beyond reach.
TEST(PlanarPlace, IsThatOfTheWholeKinematicsToTheBit) {
  for (const BenchGeometry geometry : {BenchGeometry::nominal, BenchGeometry::individual}) {
    const PlanarRrr robot(bench_robot(geometry, BenchFriction::none));
    RandomGenerator random(1);
    int valid = 0, invalid = 0;
    PlaceKinematics place;
    for (int k = 0; k < 2000; ++k) {
      const Eigen::Vector3d pose(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                                 random.uniform(-1.5, 1.5));
      const Kinematics whole = at_rest(robot, pose);
      ASSERT_TRUE(evaluate_planar_place(robot, pose, place));
      ASSERT_EQ(place.valid, whole.valid) << pose.transpose();
      ++(whole.valid ? valid : invalid);
      if (!whole.valid) continue;
      EXPECT_EQ(place.J_qa_x, whole.J_qa_x);
      EXPECT_EQ(place.det_A, whole.det_A);
      EXPECT_EQ(place.det_B, whole.det_B);
      EXPECT_EQ(place.sigma_kappa, whole.sigma_kappa);
      for (std::size_t leg = 0; leg < 3; ++leg) {
        EXPECT_EQ(place.legs[leg].base_joint, whole.legs[leg].base_joint);
        EXPECT_EQ(place.legs[leg].passive_joint, whole.legs[leg].passive_joint);
        EXPECT_EQ(place.legs[leg].coupling_joint, whole.legs[leg].coupling_joint);
      }
    }
    EXPECT_GT(valid, 300);
    EXPECT_GT(invalid, 300);
  }
}

TEST(PlanarPlace, IsNotThatOfOtherMechanismsNorOfWhatIsNoPose) {
  PlaceKinematics place;
  for (const testing::MechanismCase& each : testing::mechanism_cases()) {
    const bool is_planar = dynamic_cast<const PlanarRrr*>(each.robot.get()) != nullptr;
    EXPECT_EQ(evaluate_planar_place(*each.robot, each.robot->home_pose(), place), is_planar) << each.name;
  }
  const PlanarRrr robot(bench_robot(BenchGeometry::nominal, BenchFriction::none));
  for (const Configuration& no_pose : {Configuration(), Configuration(Eigen::Vector3d(HUGE_VAL, 0.0, 0.0))}) {
    place.valid = true;
    EXPECT_TRUE(evaluate_planar_place(robot, no_pose, place));
    EXPECT_FALSE(place.valid);
  }
}

}  // namespace
}  // namespace flinch
