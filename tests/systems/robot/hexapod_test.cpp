#include "systems/robot/hexapod.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/link_segments.h"

// Numbers of an independent implementation, at home and at one state.
namespace flinch::test {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double printed = 1e-6;  // of six printed digits

struct State {
  Kinematics k;
  Dynamics dynamics;

  State(const Hexapod& robot, const Vector6& from_home, const Vector6& velocity) {
    robot.kinematics(robot.space().plus(robot.home_pose(), from_home), velocity, k);
    robot.dynamics(k, dynamics);
  }
};

const Vector6 zero = Vector6::Zero();

double largest(const Eigen::VectorXd& v) { return v.lpNorm<Eigen::Infinity>(); }

TEST(HexapodAtHome, HasTheValuesOfAnIndependentImplementation) {
  const Hexapod robot(hexapod_robot());
  const auto [k, dynamics] = State(robot, zero, zero);
  EXPECT_LT(largest(k.joints.active - Vector6::Constant(0.703311)), printed);
  const Vector6 row{-0.457538, 0.116350, 0.881545, 0.163779, -0.147467, 0.104468};
  EXPECT_LT(largest(k.J_qa_x.row(0).transpose() - row), printed);
  EXPECT_NEAR(k.sigma_kappa, 3.098260, printed);
  EXPECT_NEAR(Eigen::MatrixXd(k.J_qa_x).jacobiSvd().singularValues()[0] /
                  Eigen::MatrixXd(k.J_qa_x).jacobiSvd().singularValues()[5],
              8.438456, 2e-6);
  const double singular_values = 2.159336 * 1.585642 * 1.585642 * 1.023569 * 0.696951 * 0.696951;
  EXPECT_NEAR(std::abs(k.det_A), singular_values, 2e-5);
  const Vector6 diagonal{10.247671, 10.247671, 11.111046, 0.260320, 0.260320, 0.460594};
  EXPECT_LT(largest(dynamics.M_x.diagonal() - diagonal), printed);
  EXPECT_NEAR(dynamics.M_x(0, 4), 0.091366, printed);
  EXPECT_NEAR(dynamics.M_x(1, 3), -0.091366, printed);
  EXPECT_LT(largest(dynamics.g_x - Vector6{0.0, 0.0, 115.601837, 0.0, 0.0, 0.0}), printed);
  EXPECT_LT(largest(drive_torques(k, dynamics.g_x) - Vector6::Constant(21.855912)), printed);
  EXPECT_NEAR(self_collision_distance(robot, k), 0.5 * std::sin(12.0 * std::numbers::pi / 180.0), 1e-12);
}

TEST(HexapodAtHome, CarriesItsPayload) {
  const Hexapod robot(hexapod_robot(HexapodPayload::eccentric));
  const auto [k, dynamics] = State(robot, zero, zero);
  const Vector6 diagonal{15.247671, 15.247671, 16.111046, 0.319320, 0.326820, 0.487094};
  EXPECT_LT(largest(dynamics.M_x.diagonal() - diagonal), printed);
  EXPECT_LT(largest(dynamics.g_x.segment<2>(3) - Eigen::Vector2d(-0.981, -1.4715)), printed);
  const HexapodParameters p = robot.parameters();
  const RigidBodyInertia both = together(p.platform, *p.payload);
  EXPECT_EQ(both.mass, 11.0);
  EXPECT_LT((both.centre_of_mass - Eigen::Vector3d(0.013636, -0.009091, 0.041818)).norm(), printed);
}

TEST(HexapodInMotion, HasTheValuesOfAnIndependentImplementation) {
  const Hexapod robot(hexapod_robot());
  const Vector6 v{0.1, -0.2, 0.3, 0.5, -0.4, 0.6};
  const auto [k, dynamics] = State(robot, {0.05, -0.03, 0.04, 0.2, -0.1, 0.3}, v);
  EXPECT_LT(largest(k.pose.tail<4>() - Eigen::Vector4d(0.982551, 0.099418, -0.049709, 0.149127)), printed);
  EXPECT_LT(largest(k.joints.active - Vector6{0.794820, 0.786537, 0.777296, 0.679681, 0.758605, 0.687333}),
            printed);
  EXPECT_LT(largest(k.rates.active - Vector6{0.411184, 0.440252, 0.361197, 0.084924, 0.289830, 0.250373}),
            printed);
  EXPECT_LT(largest(k.dJ_qa_x * v - Vector6{0.057923, 0.023879, -0.019484, 0.270497, 0.159838, 0.234899}),
            printed);
  EXPECT_LT(largest(dynamics.M_x * v - Vector6{1.012221, -2.090499, 3.373197, 0.132143, -0.122397, 0.293338}),
            printed);
  EXPECT_LT(
      largest(dynamics.C_x * v - Vector6{0.014987, 0.056314, 0.144131, -0.051229, -0.075745, -0.022921}),
      printed);
  EXPECT_LT(largest(dynamics.C_x.transpose() * v -
                    Vector6{0.027783, -0.083237, -0.017927, -0.005349, 0.002718, 0.023534}),
            printed);
  EXPECT_LT(largest(dynamics.g_x - Vector6{-0.783667, 0.285035, 115.235758, -0.248192, 0.190871, -0.410247}),
            printed);

  const ContactJacobian cylinder = robot.contact_jacobian(k, BodyId::link1(0), Eigen::Vector3d::Zero());
  EXPECT_LT(largest(cylinder.rotation * v - Eigen::Vector3d(0.239432, 0.181365, 0.118238)), printed);
  const Eigen::Vector3d point(0.0, 0.02, -0.1);
  const ContactJacobian rod = robot.contact_jacobian(k, BodyId::link2(0), point);
  EXPECT_LT(largest(robot.point_on_body(k, BodyId::link2(0), point) -
                    Eigen::Vector3d(0.212991, 0.184053, 0.632881)),
            printed);
  EXPECT_LT(largest(rod.translation * v - Eigen::Vector3d(-0.068686, -0.139031, 0.439059)), printed);
  EXPECT_LT(largest(rod.d_translation * v - Eigen::Vector3d(-0.061215, -0.174658, -0.016453)), printed);
}

// A force at distance h along a leg: the cylinder hands on (h/q) P f, the rod s s^T f + (h/q) P f, and both
// act on the platform joint.
TEST(HexapodContact, OnALegIsAPureForceThroughThePlatformJoint) {
  const Hexapod robot(hexapod_robot());
  const auto state = State(robot, {0.05, -0.03, 0.04, 0.2, -0.1, 0.3}, zero);
  const Kinematics& k = state.k;
  const Eigen::Vector3d f(20.0, -35.0, 10.0);
  for (int i = 0; i < 6; ++i) {
    const LegPoints& leg = k.legs[static_cast<std::size_t>(i)];
    const Eigen::Vector3d joint = leg.coupling_joint;
    const Eigen::Vector3d s = Eigen::Vector3d(joint - leg.base_joint).normalized();
    const double q = k.joints.active[i];
    const Eigen::Vector3d across = f - s * s.dot(f);
    const auto expect_force = [&](BodyId body, const Eigen::Vector3d& in_body, const Eigen::Vector3d& force) {
      const PlatformVector F = platform_wrench(robot.contact_jacobian(k, body, in_body), f);
      EXPECT_LT(largest(F.head<3>() - force), 1e-13);
      EXPECT_LT(largest(F.tail<3>() - Eigen::Vector3d(joint - k.pose.head<3>()).cross(force)), 1e-14 * 50.0);
    };
    expect_force(BodyId::link1(i), {0.0, 0.0, 0.3}, 0.3 / q * across);
    expect_force(BodyId::link2(i), {0.0, 0.0, 0.6 - q}, s * s.dot(f) + 0.6 / q * across);
  }
}

TEST(HexapodSingularities, AreNearedByTurningAboutTheVerticalAxis) {
  const Hexapod robot(hexapod_robot());
  const auto turned = [&](double degrees) {
    return State(robot, {0.0, 0.0, 0.0, 0.0, 0.0, degrees * std::numbers::pi / 180.0}, zero).k;
  };
  EXPECT_NEAR(turned(60.0).sigma_kappa, 5.51, 5e-3);
  EXPECT_NEAR(turned(85.0).sigma_kappa, 35.0, 0.5);
  const Kinematics singular = turned(90.0);
  EXPECT_TRUE(singular.reachable);
  EXPECT_FALSE(singular.valid);
  EXPECT_NEAR(singular.det_A, 0.0, 1e-12);
  EXPECT_TRUE(singular.J_x_qa.isZero(0.0));
  Dynamics dynamics;
  robot.dynamics(singular, dynamics);
  EXPECT_TRUE(dynamics.valid);
}

TEST(HexapodLegs, ReachAsFarAsTheRodSlidesInTheCylinder) {
  const Hexapod robot(hexapod_robot());
  const auto raised = [&](double length) {  // so that all legs have this length
    const Kinematics home = State(robot, zero, zero).k;
    const double radius_squared = std::pow(home.joints.active[0], 2) - 0.62 * 0.62;
    return State(robot, {0.0, 0.0, std::sqrt(length * length - radius_squared) - 0.62, 0.0, 0.0, 0.0}, zero);
  };
  EXPECT_FALSE(raised(0.5 - 1e-9).k.reachable);
  EXPECT_TRUE(raised(0.5 + 1e-9).k.reachable);
  EXPECT_TRUE(raised(0.94 - 1e-9).k.reachable);
  EXPECT_FALSE(raised(0.94 + 1e-9).k.reachable);
}

TEST(HexapodBodies, ArePlatformCylindersAndRods) {
  const Hexapod robot(hexapod_robot());
  EXPECT_EQ(robot.body_count(), 13);
  EXPECT_EQ(robot.description().self_collision_pairs.size(), 60u);
  EXPECT_EQ(std::get<ConvexHull>(robot.body(BodyId::platform()).shapes.at(0)).points.size(), 24u);
}

TEST(HexapodParameters, AreReportedByTheirPathWhereTheyAreWrong) {
  EXPECT_TRUE(problems(hexapod_robot(HexapodPayload::eccentric, HexapodFriction::ball_screws)).empty());
  EXPECT_GT(problems(HexapodParameters()).size(), 10u);
  const std::pair<const char*, void (*)(HexapodParameters&)> cases[] = {
      {"name", [](HexapodParameters& p) { p.name.clear(); }},
      {"legs[1].base_joint[2]", [](HexapodParameters& p) { p.legs[1].base_joint.z() = std::nan(""); }},
      {"legs[5].platform_joint[0]", [](HexapodParameters& p) { p.legs[5].platform_joint.x() = HUGE_VAL; }},
      {"legs[2].universal_axis", [](HexapodParameters& p) { p.legs[2].universal_axis *= 2.0; }},
      {"legs[3].mass_scale", [](HexapodParameters& p) { p.legs[3].mass_scale = 0.0; }},
      {"cylinder_length", [](HexapodParameters& p) { p.cylinder_length = 0.0; }},
      {"rod_radius", [](HexapodParameters& p) { p.rod_radius = -0.1; }},
      {"rod.mass", [](HexapodParameters& p) { p.rod.mass = 0.0; }},
      {"cylinder.inertia has", [](HexapodParameters& p) { p.cylinder.inertia(2, 2) = 1.0; }},
      {"platform.inertia is not", [](HexapodParameters& p) { p.platform.inertia(0, 1) = 0.1; }},
      {"drive_armature", [](HexapodParameters& p) { p.drive_armature = -1.0; }},
      {"legs[0].drive_friction.coulomb",
       [](HexapodParameters& p) { p.legs[0].drive_friction.coulomb = -1.0; }},
      {"legs[4].universal_friction.viscous",
       [](HexapodParameters& p) { p.legs[4].universal_friction.viscous = -1.0; }},
      {"payload.mass", [](HexapodParameters& p) { p.payload = RigidBodyInertia{.inertia = p.rod.inertia}; }},
      {"platform_top - platform_bottom", [](HexapodParameters& p) { p.platform_top = -0.02; }},
      {"gravity[0]", [](HexapodParameters& p) { p.gravity.x() = std::nan(""); }},
      {"characteristic_length", [](HexapodParameters& p) { p.characteristic_length = 0.0; }},
  };
  for (const auto& [path, spoil] : cases) {
    HexapodParameters parameters = hexapod_robot();
    spoil(parameters);
    const std::vector<std::string> found = problems(parameters);
    ASSERT_EQ(found.size(), 1u) << path;
    EXPECT_EQ(found[0].rfind(path, 0), 0u) << found[0];
    EXPECT_THROW(Hexapod robot(parameters), SetupError) << path;
  }
  HexapodParameters too_high = hexapod_robot();
  too_high.home_position.z() = 1.2;
  EXPECT_EQ(problems(too_high).size(), 6u);
  EXPECT_EQ(problems(too_high).at(2).rfind("home_pose is out of reach of legs[2]", 0), 0u);
}

}  // namespace
}  // namespace flinch::test
