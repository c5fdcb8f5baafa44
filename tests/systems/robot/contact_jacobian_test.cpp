#include "systems/robot/contact_jacobian.h"

#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

constexpr std::array<BodyId, 7> all_bodies = {BodyId::platform(), BodyId::link1(0), BodyId::link2(0),
                                              BodyId::link1(1),   BodyId::link2(1), BodyId::link1(2),
                                              BodyId::link2(2)};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

class Contact : public BothGeometries {
 protected:
  // A point beside the axis of the body, (along, across) from its origin [m].
  const Eigen::Vector2d point{0.31, 0.04};

  // The same point by absolute angles.
  Eigen::Vector2d reference_point(const Eigen::Vector3d& pose, BodyId body) const {
    const auto turned = [&](double angle) -> Eigen::Vector2d { return Eigen::Rotation2Dd(angle) * point; };
    if (body.is_platform()) return pose.head<2>() + turned(pose.z());
    const ReferenceLeg leg = reference_legs(GetParam())[static_cast<std::size_t>(body.leg())];
    const Eigen::Vector3d q = leg.joints(pose);
    const double theta1 = leg.psi + q[0];
    if (body.is_link1()) return leg.base() + turned(theta1);
    return leg.base() + leg.l1 * Eigen::Vector2d(std::cos(theta1), std::sin(theta1)) + turned(theta1 + q[1]);
  }
};
FLINCH_FOR_BOTH_GEOMETRIES(Contact);

TEST_P(Contact, PointsMoveWithTheirBody) {
  Residual residual("point on body [m]", 2e-15);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    for (const BodyId body : all_bodies) {
      residual.add(robot.point_on_body(k, body, point), reference_point(pose, body));
    }
  }
}

TEST_P(Contact, ForceOnALegActsThroughItsCouplingJoint) {
  Residual residual("moment about the coupling joint [Nm per 50 N]", 1e-12);
  const Eigen::Vector2d force(30.0, -40.0);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    for (const BodyId body : all_bodies) {
      if (body.is_platform()) continue;
      const PlatformVector wrench = platform_wrench(robot.contact_jacobian(k, body, point), force);
      const Eigen::Vector2d arm =
          k.legs[static_cast<std::size_t>(body.leg())].coupling_joint - pose.head<2>();
      residual.add(wrench[2] - cross(arm, wrench.head<2>()));
    }
  }
}

TEST_P(Contact, ForceOnAFirstLinkLoadsItsOwnDriveOnlyAndPushesAlongTheSecondLink) {
  Residual drives("torque of the other drives [Nm per 50 N]", 1e-12);
  Residual direction("force across the second link [N per 50 N]", 1e-12);
  const Eigen::Vector2d force(30.0, -40.0);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    for (int leg = 0; leg < 3; ++leg) {
      const PlatformVector wrench =
          platform_wrench(robot.contact_jacobian(k, BodyId::link1(leg), point), force);
      const JointVector torques = drive_torques(k, wrench);
      drives.add(torques[(leg + 1) % 3]);
      drives.add(torques[(leg + 2) % 3]);
      const LegPoints& points = k.legs[static_cast<std::size_t>(leg)];
      const Eigen::Vector2d e = Eigen::Vector2d(points.coupling_joint - points.passive_joint).normalized();
      direction.add(cross(e, wrench.head<2>()));
      EXPECT_NEAR(
          torques[leg],
          cross(Eigen::Vector2d(reference_point(pose, BodyId::link1(leg)) - points.base_joint), force),
          1e-12);
    }
  }
}

TEST_P(Contact, ForceAlongASecondLinkReachesThePlatformUnchanged) {
  Residual residual("force on the platform [N per 50 N]", 1e-13);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    for (int leg = 0; leg < 3; ++leg) {
      const LegPoints& points = k.legs[static_cast<std::size_t>(leg)];
      const Eigen::Vector2d force =
          50.0 * Eigen::Vector2d(points.coupling_joint - points.passive_joint).normalized();
      const BodyId link = BodyId::link2(leg);
      const PlatformVector wrench =
          platform_wrench(robot.contact_jacobian(k, link, robot.axis_point(link, 0.3)), force);
      residual.add(wrench.head(2), force);
    }
  }
}

TEST_P(Contact, ForceAtFractionOfASecondLinkFollowsTheElbowToPointMap) {
  Residual residual("F_n = l f_y and F_e = (1 - l) f_y cot qp [N per 60 N]", 1e-12);
  const double l = 0.7;
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    for (int leg = 0; leg < 3; ++leg) {
      const LegPoints& points = k.legs[static_cast<std::size_t>(leg)];
      const Eigen::Vector2d e = Eigen::Vector2d(points.coupling_joint - points.passive_joint).normalized();
      const Eigen::Vector2d n(-e.y(), e.x());
      const BodyId link = BodyId::link2(leg);
      const Eigen::Vector2d force = 60.0 * n;
      const PlatformVector F =
          platform_wrench(robot.contact_jacobian(k, link, robot.axis_point(link, l)), force);
      residual.add(n.dot(F.head<2>()) - l * 60.0);
      residual.add(e.dot(F.head<2>()) - (1.0 - l) * 60.0 / std::tan(k.joints.passive[leg]));
    }
  }
}

TEST_P(Contact, ClampingForcesOfOneChainActThroughItsCouplingJoint) {
  Residual residual("moment of both forces about the coupling joint [Nm]", 1e-12);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    const Eigen::Vector2d force(20.0, 35.0);
    const BodyId first = BodyId::link1(2);
    const BodyId second = BodyId::link2(2);
    const PlatformVector wrench =
        clamping_wrench(robot.contact_jacobian(k, first, robot.axis_point(first, 0.6)), force,
                        robot.contact_jacobian(k, second, robot.axis_point(second, 0.4)), -force);
    residual.add(wrench[2] - cross(k.legs[2].coupling_joint - pose.head<2>(), wrench.head<2>()));
  }
}

TEST(BodyNames, CountLegsFromOne) {
  EXPECT_EQ(body_name(BodyId::platform()), "platform");
  EXPECT_EQ(body_name(BodyId::link1(0)), "leg1_link1");
  EXPECT_EQ(body_name(BodyId::link2(2)), "leg3_link2");
  for (int i = 0; i < 7; ++i) {
    const BodyId body = BodyId::from_index(i);
    EXPECT_EQ(body.index(), i);
    EXPECT_EQ(body, all_bodies[static_cast<std::size_t>(i)]);
    EXPECT_EQ(body.is_platform() + body.is_link1() + body.is_link2(), 1);
  }
}

}  // namespace
}  // namespace flinch::test
