#include "systems/robot/contact_jacobian.h"

#include <limits>

#include "systems/robot/joint_space_dynamics.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::testing {
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

TEST_P(Contact, JacobianIsTheDerivativeOfThePoint) {
  Residual translation("contact J against central differences", 5e-10);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    for (const BodyId body : all_bodies) {
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      ASSERT_TRUE(contact.valid);
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector2d column = derivative(
            [&](double h) -> Eigen::Vector2d {
              return reference_point(pose + h * Eigen::Vector3d::Unit(axis), body);
            },
            5e-4);
        translation.add(contact.translation.col(axis), column);
      }
    }
  }
}

TEST_P(Contact, JacobianRateIsTheDerivativeOfTheJacobianAlongTheMotion) {
  Residual residual("contact dJ/dt against central differences", 1e-9);
  Residual joints("contact dJ_xc,qa/dt against central differences", 1e-8);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const auto& velocity = motion.velocity;
    const Kinematics k = kinematics_at(pose, velocity);
    for (const BodyId body : all_bodies) {
      const auto at = [&](double h) {
        return robot.contact_jacobian(kinematics_at(pose + h * velocity, velocity), body, point);
      };
      const ContactJacobian contact = at(0.0);
      residual.add(contact.d_translation,
                   derivative([&](double h) -> Eigen::MatrixXd { return at(h).translation; }, 1e-4));
      residual.add(contact.d_rotation,
                   derivative([&](double h) -> Eigen::MatrixXd { return at(h).rotation; }, 1e-4));
      const auto at_joints = [&](double h) -> Eigen::MatrixXd {
        return from_active_joints(at(h), kinematics_at(pose + h * velocity, velocity)).translation;
      };
      joints.add(from_active_joints(contact, k).d_translation, derivative(at_joints, 1e-4));
    }
  }
}

TEST_P(Contact, RotationRowIsTheAngularVelocityOfTheBody) {
  Residual residual("rotation rows [rad/s]", 1e-14);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    for (const BodyId body : all_bodies) {
      const double rate = (robot.contact_jacobian(k, body, point).rotation * velocity)[0];
      if (body.is_platform()) residual.add(rate - velocity.z());
      if (body.is_link1()) residual.add(rate - k.rates.active[body.leg()]);
      if (body.is_link2()) residual.add(rate - k.rates.active[body.leg()] - k.rates.passive[body.leg()]);
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

TEST_P(Contact, DriveTorquesAndPlatformWrenchesAreInverse) {
  Residual residual("wrench to torques and back [N, Nm]", 1e-13);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    const Eigen::Vector3d wrench(10.0, -20.0, 1.5);
    residual.add(platform_wrench(k, drive_torques(k, wrench)), wrench);
  }
}

TEST_P(Contact, FixedSizePathAgreesWithTheGeneralOne) {
  Residual velocities("velocity of a point [m/s]", 1e-14);
  Residual wrenches("wrench of a force [N, Nm per 50 N]", 1e-12);
  const Eigen::Vector2d force(-40.0, 30.0);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    const PlanarMotion motion = robot.motion(pose, velocity);
    for (const BodyId body : all_bodies) {
      const ContactJacobian contact = robot.contact_jacobian(k, body, point);
      const Eigen::Vector2d in_base = robot.point_on_body(k, body, point);
      velocities.add(point_velocity(motion, body, in_base), contact.translation * velocity);
      wrenches.add(contact_wrench(motion, body, in_base, force), platform_wrench(contact, force));
    }
  }
}

TEST_P(Contact, IsInvalidAndFiniteForUnusableInput) {
  Kinematics out_of_reach;
  robot.kinematics(Eigen::Vector3d(9, 0, 0), PlatformVector::Zero(3), out_of_reach);
  const Kinematics home = kinematics_at(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const Eigen::Vector2d bad(std::numeric_limits<double>::quiet_NaN(), 0.0);
  for (const ContactJacobian& contact :
       {robot.contact_jacobian(out_of_reach, BodyId::link1(0), point),
        robot.contact_jacobian(home, BodyId::link1(3), point),
        robot.contact_jacobian(home, BodyId::link2(0), bad),
        robot.contact_jacobian(home, BodyId::platform(), Eigen::Vector3d(0, 0, 0)),
        robot.contact_jacobian(Kinematics(), BodyId::platform(), point)}) {
    EXPECT_FALSE(contact.valid);
    EXPECT_EQ(contact.translation, (Eigen::Matrix<double, 2, 3>::Zero()));
    EXPECT_EQ(contact.rotation, (Eigen::Matrix<double, 1, 3>::Zero()));
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
}  // namespace flinch::testing
