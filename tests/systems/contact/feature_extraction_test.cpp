#include "systems/contact/feature_extraction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/robot/random_motion.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
}

WrenchEstimate estimate_of(const Kinematics& kinematics, const PlatformVector& wrench) {
  return {.acquired = 5ms,
          .valid = true,
          .wrench_in_base = wrench,
          .drive_torque = drive_torques(kinematics, wrench)};
}

/// What is felt of a force on `body` at `fraction` of its axis, in each of 100 states of the rig.
template <class See>
void for_each_push(BodyId body, double fraction, const Eigen::Vector2d& force_along_and_across,
                   const See& see) {
  const auto robot = rig();
  for (const auto& [pose, velocity] : test::random_motions(*robot, 100)) {
    Kinematics k;
    robot->kinematics(pose, velocity, k);
    const LegPoints& leg = k.legs[static_cast<std::size_t>(body.leg())];
    const Eigen::Vector2d axis =
        body.is_link1() ? leg.passive_joint - leg.base_joint : leg.coupling_joint - leg.passive_joint;
    const CartesianVector force = rotate(axis.normalized(), force_along_and_across);
    const ContactJacobian J = robot->contact_jacobian(k, body, robot->axis_point(body, fraction));
    see(k, contact_features(*robot, k, estimate_of(k, platform_wrench(J, force)), {}));
  }
}

TEST(ContactFeatures, OfAFirstLinkAreOneDriveNoDistanceAndNoAngle) {
  for_each_push(BodyId::link1(1), 0.8, {0.0, 40.0}, [](const Kinematics&, const ContactFeatures& features) {
    ASSERT_TRUE(features.valid);
    EXPECT_NEAR(features.distance[1], 0.0, 1e-12);
    EXPECT_NEAR(std::sin(features.angle[1]), 0.0, 1e-12);
    EXPECT_EQ(features.affected_drives, 1);
    EXPECT_NEAR(features.drive_torque[0], 0.0, 1e-9);
    EXPECT_NEAR(features.drive_torque[2], 0.0, 1e-9);
  });
}

// tan alpha = l / (1 - l) tan qp, from the elbow at l = 0.
TEST(ContactFeatures, OfASecondLinkTellByTheAngleHowFarFromTheElbowItIsPushed) {
  for (const double l : {0.2, 0.5, 0.9}) {
    for_each_push(BodyId::link2(2), l, {0.0, 40.0},
                  [l](const Kinematics& k, const ContactFeatures& features) {
                    ASSERT_TRUE(features.valid);
                    EXPECT_NEAR(features.distance[2], 0.0, 1e-12);
                    const double expected = std::abs(l / (1.0 - l) * std::tan(k.joints.passive[2]));
                    EXPECT_NEAR(std::abs(std::tan(features.angle[2])) / expected, 1.0, 1e-9);
                  });
  }
}

TEST(ContactFeatures, CountTheDrivesAboveTheirThreshold) {
  const auto robot = rig();
  Kinematics k;
  robot->kinematics(robot->home_pose(), PlatformVector::Zero(3), k);
  WrenchEstimate estimate = estimate_of(k, PlatformVector{{20.0, 0.0, 0.0}});
  estimate.drive_torque = JointVector{{2.4, -2.6, 2.6}};
  EXPECT_EQ(contact_features(*robot, k, estimate, {}).affected_drives, 2);
  EXPECT_EQ(
      contact_features(*robot, k, estimate, {.least_force = 1.0, .affected_drive = 1.0}).affected_drives, 3);
}

TEST(ContactFeatures, AreZeroAndInvalidWithoutAForceOrAPose) {
  const auto robot = rig();
  Kinematics good;
  Kinematics bad;
  robot->kinematics(robot->home_pose(), PlatformVector::Zero(3), good);
  robot->kinematics(Configuration{{9.0, 0.0, 0.0}}, PlatformVector::Zero(3), bad);
  const WrenchEstimate push = estimate_of(good, PlatformVector{{20.0, 0.0, 0.0}});
  ASSERT_TRUE(contact_features(*robot, good, push, {}).valid);
  std::vector<std::pair<Kinematics, WrenchEstimate>> cases = {{bad, push}};
  const PlatformVector wrenches[] = {PlatformVector{{0.0, 0.0, 5.0}}, PlatformVector{{0.7, 0.7, 5.0}},
                                     PlatformVector::Constant(3, nan), PlatformVector()};
  for (const PlatformVector& wrench : wrenches) {
    cases.emplace_back(good, push);
    cases.back().second.wrench_in_base = wrench;
  }
  cases.emplace_back(good, push);
  cases.back().second.valid = false;
  cases.emplace_back(good, push);
  cases.back().second.drive_torque = JointVector::Constant(3, nan);
  for (const auto& [kinematics, estimate] : cases) {
    const ContactFeatures features = contact_features(*robot, kinematics, estimate, {});
    EXPECT_FALSE(features.valid);
    EXPECT_EQ(feature_vector(features), FeatureVector::Zero(12));
    EXPECT_EQ(features.affected_drives, 0);
  }
}

std::vector<std::string> names_of(const ParallelRobot& robot) {
  std::vector<std::string> names;
  for (const FeatureName& feature : feature_names(robot)) names.push_back(feature.name + " " + feature.unit);
  return names;
}

TEST(FeatureNames, FollowTheVectorOfThePapers) {
  EXPECT_THAT(names_of(*rig()),
              ElementsAre("force_x N", "force_y N", "moment_z Nm", "drive_torque_1 Nm", "drive_torque_2 Nm",
                          "drive_torque_3 Nm", "distance_1 m", "distance_2 m", "distance_3 m", "angle_1 rad",
                          "angle_2 rad", "angle_3 rad"));
}

TEST(FeatureNames, AreThereForOtherMechanisms) {
  const FiveBar five_bar(five_bar_robot());
  EXPECT_THAT(names_of(five_bar),
              ElementsAre("force_x N", "force_y N", "drive_torque_1 Nm", "drive_torque_2 Nm", "distance_1 m",
                          "distance_2 m", "angle_1 rad", "angle_2 rad"));
  const Hexapod hexapod(hexapod_robot());
  const std::vector<std::string> names = names_of(hexapod);
  ASSERT_EQ(names.size(), 24u);
  EXPECT_EQ(names[3], "moment_x Nm");
  EXPECT_EQ(names[6], "drive_torque_1 N");
}

TEST(FeatureVector, HasTheSizeOfItsNamesForEveryMechanism) {
  const std::shared_ptr<const ParallelRobot> robots[] = {rig(), std::make_shared<FiveBar>(five_bar_robot()),
                                                         std::make_shared<Hexapod>(hexapod_robot())};
  for (const auto& robot : robots) {
    Kinematics k;
    robot->kinematics(robot->home_pose(), PlatformVector::Zero(robot->dof()), k);
    PlatformVector wrench = PlatformVector::Zero(robot->dof());
    wrench[0] = 30.0;
    const ContactFeatures features = contact_features(*robot, k, estimate_of(k, wrench), {});
    EXPECT_TRUE(features.valid);
    EXPECT_EQ(features.has_lever, robot->space().rotations() > 0);
    EXPECT_EQ(static_cast<std::size_t>(feature_vector(features).size()), feature_names(*robot).size());
    EXPECT_TRUE(feature_vector(features).allFinite());
  }
}

TEST(FeatureExtraction, ComputesTheFeaturesAtEveryTickWithoutAllocating) {
  DiagramBuilder builder;
  const auto robot = rig();
  auto& block = builder.add<FeatureExtraction>("features", robot, FeatureSettings{});
  const auto kinematics = builder.export_input("kinematics", block.kinematics);
  const auto wrench = builder.export_input("wrench", block.wrench);
  test::Ticking ticking(builder);
  Kinematics k;
  robot->kinematics(robot->home_pose(), PlatformVector::Zero(3), k);
  ticking.set(kinematics, k);
  ticking.set(wrench, estimate_of(k, PlatformVector{{20.0, 5.0, 0.5}}));
  const test::AllocationCounter allocations;
  ticking.tick();
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(
      feature_vector(ticking.get(block.features)),
      feature_vector(contact_features(*robot, k, estimate_of(k, PlatformVector{{20.0, 5.0, 0.5}}), {})));
}

TEST(FeatureExtraction, AsksForPositiveSettings) {
  EXPECT_THROW(FeatureExtraction(rig(), {.least_force = 0.0, .affected_drive = 2.5}), SetupError);
  EXPECT_THROW(FeatureExtraction(rig(), {.least_force = 1.0, .affected_drive = nan}), SetupError);
}

}  // namespace
}  // namespace flinch
