#include "systems/contact/leg_history.h"

#include <gtest/gtest.h>

#include "systems/contact/wrench_uncertainty.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

struct Bench {
  PlanarRrr robot{rig_robot(RigGeometry::individual, RigFriction::none)};
  Kinematics now = [this] {
    Kinematics k;
    robot.kinematics(robot.home_pose(), PlatformVector{{0.3, -0.2, 0.5}}, k);
    return k;
  }();

  ContactMoments all(const PlatformVector& wrench) const {
    ContactMoments moments;
    moments.fill({wrench, now.velocity});
    return moments;
  }
  /// Of 1 N at a fraction of a link, along `direction`.
  PlatformVector push(BodyId link, double fraction, const CartesianVector& direction) const {
    return platform_wrench(robot.contact_jacobian(now, link, robot.axis_point(link, fraction)), direction);
  }
  /// Across a link, away from the other one of its leg.
  CartesianVector outwards(BodyId link) const {
    const LegPoints& leg = now.legs[static_cast<std::size_t>(link.leg())];
    const CartesianVector own = link.is_link1() ? leg.base_joint : leg.coupling_joint;
    const CartesianVector other = link.is_link1() ? leg.coupling_joint : leg.base_joint;
    const CartesianVector along = (own - leg.passive_joint).normalized(), to = other - leg.passive_joint;
    return -(to - along.dot(to) * along).normalized();
  }
  /// Of the middle of a link, by differences.
  CartesianVector speed(BodyId link) const {
    const auto middle = [&](double ahead) {
      Kinematics then;
      robot.kinematics(Configuration(robot.home_pose() + ahead * now.velocity), now.velocity, then);
      return robot.point_on_body(then, link, robot.axis_point(link, 0.5));
    };
    return (middle(1e-6) - middle(-1e-6)) / 2e-6;
  }
};

TEST(LegHistory, FeelsAFirstLinkInOneNumberAndASecondInTwo) {
  const Bench rig;
  for (int leg = 0; leg < 3; ++leg) {
    const BodyId first = BodyId::link1(leg), second = BodyId::link2(leg);
    const auto felt = [&](const PlatformVector& wrench) {
      return leg_histories(rig.robot, rig.now, rig.all(wrench))
          .value()[static_cast<std::size_t>(leg)]
          .moments[3];
    };
    const LegMoment on_first = felt(30.0 * rig.push(first, 0.8, rig.outwards(first)));
    EXPECT_GT(on_first.link1_force, 1.0);
    EXPECT_NEAR(on_first.link2_force, 0.0, 1e-9);
    EXPECT_NEAR(on_first.other_force, 0.0, 1e-9);
    const LegMoment on_second = felt(30.0 * rig.push(second, 0.8, rig.outwards(second)));
    EXPECT_GT(on_second.link2_force, 1.0);
    EXPECT_NEAR(on_second.other_force, 0.0, 1e-9);
    EXPECT_LT(felt(-30.0 * rig.push(second, 0.8, rig.outwards(second))).link2_force, -1.0);
  }
}

TEST(LegHistory, LosesNothingOfAWrench) {
  const Bench rig;
  const PlatformVector wrench = Eigen::Vector3d(12.0, -7.0, 0.8);
  const PlatformVector deviation = Eigen::Vector3d(2.0, 2.0, 0.2);
  ASSERT_LT((WrenchUncertainty().covariance(rig.robot.space(), PlatformVector::Zero(3)).diagonal() -
             deviation.cwiseAbs2())
                .norm(),
            1e-12);
  const LegCourses courses = leg_histories(rig.robot, rig.now, rig.all(wrench)).value();
  for (int leg = 0; leg < 3; ++leg) {
    for (const LegMoment& moment : courses[static_cast<std::size_t>(leg)].moments) {
      EXPECT_NEAR(std::hypot(moment.link1_force, moment.link2_force, moment.other_force),
                  wrench.cwiseQuotient(deviation).norm(), 1e-9);
    }
  }
}

TEST(LegHistory, SeesHowFastEachLinkMovesTowardsTheOther) {
  const Bench rig;
  const LegCourses courses = leg_histories(rig.robot, rig.now, rig.all(PlatformVector::Zero(3))).value();
  for (int leg = 0; leg < 3; ++leg) {
    const BodyId first = BodyId::link1(leg), second = BodyId::link2(leg);
    const LegMoment& moment = courses[static_cast<std::size_t>(leg)].moments.back();
    EXPECT_NEAR(moment.link1_speed, -rig.speed(first).dot(rig.outwards(first)), 1e-8);
    EXPECT_NEAR(moment.link2_speed, -rig.speed(second).dot(rig.outwards(second)), 1e-8);
  }
}

TEST(LegHistory, IsNothingWhereNothingIsKnown) {
  const Bench rig;
  ContactMoments moments = rig.all(PlatformVector::Ones(3));
  EXPECT_TRUE(leg_histories(rig.robot, rig.now, moments));
  EXPECT_FALSE(leg_histories(rig.robot, Kinematics(), moments));
  moments[4].velocity.resize(2);
  EXPECT_FALSE(leg_histories(rig.robot, rig.now, moments));
}

TEST(LegHistory, DoesNotAllocate) {
  const Bench rig;
  const ContactMoments moments = rig.all(PlatformVector::Ones(3));
  const test::AllocationCounter allocations;
  const LegCourses courses = leg_histories(rig.robot, rig.now, moments).value();
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_NE(courses[0].elbow_cosine, 0.0);
}

}  // namespace
}  // namespace flinch
