#include "experiments/live/seen_pose.h"

#include <gmock/gmock.h>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using testing::HasSubstr;

const PlanarRrr& rig() {
  static const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  return robot;
}

JointReading reading_at(const PlatformVector& pose) {
  const JointAngles joints = rig().inverse_kinematics(pose, rig().home_working_mode()).joints;
  return {.acquired = {},
          .valid = true,
          .passive_valid = true,
          .active = joints.active,
          .passive = joints.passive};
}

TEST(SeenPose, IsWhereThePlatformIs) {
  const PlatformVector pose = Eigen::Vector3d(0.021, -0.034, 0.1);
  const SeenPose seen = see_pose(rig(), reading_at(pose));
  ASSERT_TRUE(seen.platform);
  EXPECT_LT((*seen.platform - pose).norm(), 1e-9);
  EXPECT_LT(seen.closure_error.value(), 1e-9);
  EXPECT_THAT(seen.text(), HasSubstr("platform at 21.0 mm, -34.0 mm, 5.7 deg; the elbows miss it by 0.0 mm"));
}

TEST(SeenPose, NeedsNoPassiveAngles) {
  const PlatformVector pose = Eigen::Vector3d(0.02, 0.01, 0.0);
  JointReading joints = reading_at(pose);
  joints.passive_valid = false;
  const SeenPose seen = see_pose(rig(), joints);
  EXPECT_LT((seen.platform.value() - pose).norm(), 1e-9);
  EXPECT_FALSE(seen.closure_error);
  EXPECT_THAT(seen.text(), Not(HasSubstr("elbows")));
}

TEST(SeenPose, BetraysAnAngleWithTheWrongSign) {
  JointReading joints = reading_at(Eigen::Vector3d(0.02, 0.01, 0.0));
  joints.passive[1] = -joints.passive[1];
  const SeenPose seen = see_pose(rig(), joints);
  EXPECT_GT(seen.closure_error.value(), 0.01);
  EXPECT_THAT(seen.text(), HasSubstr("check signs and zeros"));
}

TEST(SeenPose, IsUnknownWithoutAnglesAndWithAnglesThatFitNone) {
  EXPECT_FALSE(see_pose(rig(), {}).platform);
  EXPECT_THAT(see_pose(rig(), {}).text(), HasSubstr("no angles of the drives"));
  JointReading joints = reading_at(Eigen::Vector3d::Zero());
  joints.active += JointVector::Constant(3, 3.14159);  // all legs point outwards
  EXPECT_FALSE(see_pose(rig(), joints).platform);
  EXPECT_THAT(see_pose(rig(), joints).text(), HasSubstr("fit no pose"));
}

}  // namespace
}  // namespace flinch
