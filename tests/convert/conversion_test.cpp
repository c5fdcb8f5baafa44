// Models become robots that stand, weigh and move as the models do, computed here by other ways.
#include "convert/conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <random>

#include "convert/mjcf_text.h"
#include "convert/urdf_text.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "tests/convert/converted_models.h"

namespace flinch {
namespace {

using test::five_bar;
using test::model;
using test::read_again;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double g = 9.81;

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

// ---------------------------------------------------------------- five_bar.urdf in closed form

/// A point of the plane x of the model: its y and z.
using Point = Eigen::Vector2d;

Point hanging(double angle, double down, double aside = 0.0) {
  return {aside * std::cos(angle) + down * std::sin(angle), aside * std::sin(angle) - down * std::cos(angle)};
}

struct FiveBar {
  Point elbow_left, elbow_right, shared, effector;
  double arm_left, arm_right, coupler_left, coupler_right;  // angles about x
};

/// By circles of both couplers, the lower of their two crossings or the upper one.
FiveBar five_bar_at(double left, double right, bool lower = true) {
  FiveBar at;
  at.arm_left = left;
  at.arm_right = right;
  at.elbow_left = Point(0.15, 0.05) + hanging(left, 0.3);
  at.elbow_right = Point(-0.15, 0.05) + hanging(right, 0.3);
  const Point way = at.elbow_right - at.elbow_left;
  const double half = 0.5 * way.norm();
  const Point across(way.y() / way.norm(), -way.x() / way.norm());
  const Point middle = 0.5 * (at.elbow_left + at.elbow_right);
  const double height = std::sqrt(0.16 - half * half);
  at.shared = middle + ((across.y() < 0.0) == lower ? height : -height) * across;
  const auto angle = [](const Point& d) { return std::atan2(d.x(), -d.y()); };
  at.coupler_left = angle(at.shared - at.elbow_left);
  at.coupler_right = angle(at.shared - at.elbow_right);
  at.effector = at.elbow_right + hanging(at.coupler_right, 0.5, 0.03);
  return at;
}

/// Of all that moves [J].
double five_bar_energy(const FiveBar& at) {
  const Point hip_left(0.15, 0.05), hip_right(-0.15, 0.05);
  double sum = 1.1 * (hip_left + hanging(at.arm_left, 0.14, 0.01)).y();
  sum += 1.3 * (hip_right + hanging(at.arm_right, 0.15, -0.01)).y();
  sum += 0.7 * (at.elbow_left + hanging(at.coupler_left, 0.19)).y();
  sum += 0.9 * (at.elbow_right + hanging(at.coupler_right, 0.24, 0.005)).y();
  return g * (sum + 0.002 * at.shared.y());
}

Configuration pose_of_effector(const FiveBar& at) {
  Configuration pose(2);
  pose << at.effector.x(), at.effector.y();
  return pose;
}

Kinematics at_rest(const LegsRobot& robot, const Configuration& pose) {
  Kinematics kinematics;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), robot.home_working_mode(), kinematics);
  return kinematics;
}

/// Where the arms stand near the home of a robot, and where the couplers cross. The zero of the model hangs
/// straight down, where it is singular, so home is another place, and may be in another assembly.
struct Surroundings {
  /// `zero`: where the arms stand at the zero of the drives.
  explicit Surroundings(const LegsRobot& robot, const Eigen::Vector2d& zero = Eigen::Vector2d::Zero()) {
    const Configuration home = robot.home_pose();
    const Eigen::Vector2d arms = zero + at_rest(robot, home).joints.active;
    for (const bool each : {true, false}) {
      if ((pose_of_effector(five_bar_at(arms[0], arms[1], each)) - home).norm() < 1e-9) lower = each;
    }
    for (const auto& [left, right] : {std::pair(0.0, 0.0), std::pair(0.06, -0.04), std::pair(-0.05, 0.02),
                                      std::pair(0.03, 0.07), std::pair(-0.02, -0.06)})
      angles.emplace_back(arms[0] + left, arms[1] + right);
  }
  FiveBar at(double left, double right) const { return five_bar_at(left, right, *lower); }

  std::optional<bool> lower;  ///< none: the home of the robot is none of the model
  std::vector<std::pair<double, double>> angles;
};

TEST(FiveBarFromUrdf, MovesInXAndYOfItsPlaneAndTurnsAsItMust) {
  const Conversion found = converted_robot(five_bar(), {.platform = "effector"});
  using enum ChartRole;
  const std::array<ChartRole, 6> roles{free, free, fixed, fixed, fixed, follows};
  EXPECT_EQ(found.robot.moves.roles, roles);
  EXPECT_TRUE(found.robot.moves.planar);
  // y and z of the model are x and y here.
  EXPECT_TRUE(found.base_axes.isApprox((Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished(), 1e-12));
  EXPECT_TRUE(found.robot.gravity.isApprox(Eigen::Vector3d(0.0, -g, 0.0), 1e-12));
  EXPECT_EQ(found.max_effort, 60.0);
  EXPECT_THAT(found.notes, ::testing::Contains(HasSubstr("'marker_left'")));
}

TEST(FiveBarFromUrdf, StandsWhereTheModelsChainsStand) {
  const Conversion found = converted_robot(five_bar(), {.platform = "effector"});
  const LegsRobot robot(read_again(robot_text(found)));
  const Surroundings here(robot);
  ASSERT_TRUE(here.lower.has_value());
  for (const auto& [left, right] : here.angles) {
    const Configuration pose = pose_of_effector(here.at(left, right));
    const Kinematics kinematics = at_rest(robot, pose);
    ASSERT_TRUE(kinematics.reachable) << left << " " << right;
    EXPECT_NEAR(kinematics.joints.active[0], left, 1e-12);
    EXPECT_NEAR(kinematics.joints.active[1], right, 1e-12);
  }
}

TEST(FiveBarFromUrdf, WeighsWhatTheModelWeighs) {
  const Conversion found = converted_robot(five_bar(), {.platform = "effector"});
  const LegsRobot robot(found.robot);
  double mass = found.robot.platform.inertia.mass;
  for (const RobotLeg& leg : found.robot.legs) {
    for (const LegJoint& joint : leg.joints) mass += joint.link ? joint.link->inertia.mass : 0.0;
  }
  EXPECT_NEAR(mass, 1.1 + 1.3 + 0.7 + 0.9 + 0.002, 1e-12);
  const Surroundings here(robot);
  ASSERT_TRUE(here.lower.has_value());
  for (const auto& [left, right] : here.angles) {
    const Kinematics kinematics = at_rest(robot, pose_of_effector(here.at(left, right)));
    Dynamics dynamics;
    robot.dynamics(kinematics, dynamics);
    const Eigen::VectorXd torque = kinematics.J_x_qa.transpose() * dynamics.g_x;
    const double h = 1e-5;
    const auto energy = [&](double l, double r) { return five_bar_energy(here.at(l, r)); };
    EXPECT_NEAR(torque[0], (energy(left + h, right) - energy(left - h, right)) / (2.0 * h), 1e-7);
    EXPECT_NEAR(torque[1], (energy(left, right + h) - energy(left, right - h)) / (2.0 * h), 1e-7);
  }
}

TEST(FiveBarFromUrdf, ClosesToRoundingAtHome) {
  const Conversion found = converted_robot(five_bar(), {.platform = "effector"});
  EXPECT_LT(closure_rows(found.chains, found.home).e.lpNorm<Eigen::Infinity>(), 1e-12);
}

/// Its zero is not singular: arms out by half a radian.
TEST(FiveBarFromSdf, StandsAndWeighsAsTheModel) {
  const ConversionSettings settings{.platform = "effector", .drives = {"motor_left", "motor_right"}};
  const LegsRobot robot(converted_robot(model("five_bar.sdf"), settings).robot);
  const Eigen::Vector2d zero(0.5, -0.5);
  const Surroundings here(robot, zero);
  ASSERT_TRUE(here.lower.has_value());
  for (const auto& [left, right] : here.angles) {
    const Kinematics kinematics = at_rest(robot, pose_of_effector(here.at(left, right)));
    EXPECT_NEAR(kinematics.joints.active[0] + zero[0], left, 1e-12);
    EXPECT_NEAR(kinematics.joints.active[1] + zero[1], right, 1e-12);
    Dynamics dynamics;
    robot.dynamics(kinematics, dynamics);
    const Eigen::VectorXd torque = kinematics.J_x_qa.transpose() * dynamics.g_x;
    const double h = 1e-5;
    const auto energy = [&](double l, double r) { return five_bar_energy(here.at(l, r)); };
    EXPECT_NEAR(torque[0], (energy(left + h, right) - energy(left - h, right)) / (2.0 * h), 1e-7);
    EXPECT_NEAR(torque[1], (energy(left, right + h) - energy(left, right - h)) / (2.0 * h), 1e-7);
  }
}

// ---------------------------------------------------------------- two_rods.xml

TEST(DeltaOfTwoRods, MovesInSpaceWithoutTurning) {
  const Conversion found = converted_robot(model("two_rods.xml"), {.platform = "platform"});
  EXPECT_EQ(found.robot.moves.roles, moves_of("translation").roles);
  EXPECT_EQ(found.robot.legs.size(), 3U);
  EXPECT_EQ(found.max_effort, 30.0);
}

// sphere of each rod about its hold: with a = shoulder angle, |p + hold - elbow(a)| = 0.7.
TEST(DeltaOfTwoRods, DrivesStandWhereSpheresOfRodsSay) {
  const Conversion found = converted_robot(model("two_rods.xml"), {.platform = "platform"});
  const LegsRobot robot(read_again(robot_text(found)));
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.0, 0.0, -0.6), Eigen::Vector3d(0.05, -0.04, -0.55),
                                   Eigen::Vector3d(-0.08, 0.02, -0.65)}) {
    Configuration pose(3);
    pose << p;
    const Kinematics kinematics = at_rest(robot, pose);
    ASSERT_TRUE(kinematics.reachable);
    for (int leg = 0; leg < 3; ++leg) {
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(2.0 * std::numbers::pi / 3.0 * leg, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const double a = kinematics.joints.active[leg];
      for (const double aside : {0.04, -0.04}) {
        const Eigen::Vector3d elbow = R * Eigen::Vector3d(0.2 + 0.3 * std::cos(a), aside, -0.3 * std::sin(a));
        EXPECT_NEAR((p + R * Eigen::Vector3d(0.05, aside, 0.0) - elbow).norm(), 0.7, 1e-12);
      }
    }
  }
}

// ---------------------------------------------------------------- there and back

class ShippedLegs : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Robots, ShippedLegs,
                         ::testing::Values("delta", "planar_3rpr", "planar_4rrr", "hexa_6rus", "linapod_6pus",
                                           "tricept"),
                         [](const auto& each) { return std::string(each.param); });

LegsParameters shipped_legs(const std::string& name) {
  ConfigReader reader = ConfigReader::open("apps/robots/" + name + ".yaml");
  return read_legs_parameters(reader);
}

/// The pose moved at random along its coordinates.
Configuration near_home(const LegsRobot& robot, std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(-0.05, 0.05);
  PlatformVector step(robot.dof());
  for (double& entry : step) entry = uniform(generator);
  return robot.space().plus(robot.home_pose(), step);
}

void expect_same_motion(const LegsRobot& a, const LegsRobot& b) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const Configuration pose = near_home(a, generator);
    PlatformVector velocity(a.dof());
    for (double& entry : velocity) entry = uniform(generator);
    Kinematics of_a, of_b;
    a.kinematics(pose, velocity, a.home_working_mode(), of_a);
    b.kinematics(pose, velocity, b.home_working_mode(), of_b);
    ASSERT_TRUE(of_a.valid && of_b.valid);
    EXPECT_TRUE(of_a.joints.active.isApprox(of_b.joints.active, 1e-11))
        << of_a.joints.active.transpose() << "\n"
        << of_b.joints.active.transpose();
    EXPECT_TRUE(of_a.J_qa_x.isApprox(of_b.J_qa_x, 1e-11));
    EXPECT_TRUE(of_a.dJ_qa_x.isApprox(of_b.dJ_qa_x, 1e-10));
    Dynamics d_a, d_b;
    a.dynamics(of_a, d_a);
    b.dynamics(of_b, d_b);
    EXPECT_TRUE(d_a.M_x.isApprox(d_b.M_x, 1e-10));
    EXPECT_TRUE((d_a.C_x * velocity).isApprox(d_b.C_x * velocity, 1e-9));
    EXPECT_LT((d_a.g_x - d_b.g_x).norm(), 1e-10 * (1.0 + d_a.g_x.norm()));
    EXPECT_LT((d_a.F_fr_x - d_b.F_fr_x).norm(), 1e-10 * (1.0 + d_a.F_fr_x.norm()));
  }
}

TEST_P(ShippedLegs, AreTheSameByWayOfMjcf) {
  const LegsParameters shipped = shipped_legs(GetParam());
  const std::string model_of_robot = mjcf_text(shipped);
  const Conversion back = converted_robot(read_model(model_of_robot, "robot.xml"), {.platform = "platform"});
  EXPECT_EQ(back.robot.moves.roles, shipped.moves.roles);
  ASSERT_EQ(back.robot.legs.size(), shipped.legs.size());
  expect_same_motion(LegsRobot(shipped), LegsRobot(read_again(robot_text(back))));
}

// URDF has no rotors, so the model is one without.
TEST_P(ShippedLegs, AreTheSameByWayOfUrdf) {
  LegsParameters shipped = shipped_legs(GetParam());
  for (RobotLeg& leg : shipped.legs) {
    for (LegJoint& joint : leg.joints) {
      if (joint.drive) joint.drive = LegDrive();
    }
  }
  const UrdfTexts texts = urdf_texts(shipped, 50.0);
  BodyGraph graph = read_model(texts.model, "robot.urdf");
  add_closures(texts.closures, "closures.yaml", graph);
  graph.gravity = shipped.gravity;
  const Conversion back = converted_robot(std::move(graph), {.platform = "platform"});
  EXPECT_EQ(back.robot.moves.roles, shipped.moves.roles);
  ASSERT_EQ(back.robot.legs.size(), shipped.legs.size());
  expect_same_motion(LegsRobot(shipped), LegsRobot(read_again(robot_text(back))));
}

TEST(Urdf, IsRefusedWhereItCannotSayWhatARobotIs) {
  LegsParameters robot = shipped_legs("hexa_6rus");
  robot.legs[0].joints[0].kind = LegJointKind::screw;
  EXPECT_FALSE(refusal([&] { urdf_texts(robot, 1.0); }).empty());
}

TEST(ZerosOfAModel, AreRefusedForJointsThatThereAreNot) {
  BodyGraph graph = model("five_bar.urdf");
  EXPECT_THAT(
      refusal([&] { add_closures("closed_loop: []\nzeros: {motor_lef: 0.1}\n", "closures.yaml", graph); }),
      AllOf(HasSubstr("closures.yaml:2"), HasSubstr("did you mean 'motor_left'?")));
}

TEST_P(ShippedLegs, AreTheSameByWayOfTheirText) {
  const LegsParameters shipped = shipped_legs(GetParam());
  expect_same_motion(LegsRobot(shipped), LegsRobot(read_again(legs_text(shipped))));
}

TEST_P(ShippedLegs, StandWithClosedLoopsInTheirModel) {
  const BodyGraph graph = read_model(mjcf_text(shipped_legs(GetParam())), "robot.xml");
  const BodyGraph merged = without_fixed_joints(graph, "platform");
  const ClosedChains chains = closed_chains(merged, {.platform = "platform"});
  EXPECT_LT(closure_rows(chains, resting_state(chains)).e.lpNorm<Eigen::Infinity>(), 1e-12);
}

// ---------------------------------------------------------------- what is refused

const char* const serial_arm = R"(<robot name="arm">
  <link name="foot"/>
  <link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
  <link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
  <joint name="j1" type="revolute"><parent link="foot"/><child link="a"/><axis xyz="0 0 1"/></joint>
  <joint name="j2" type="revolute">
    <parent link="a"/><child link="b"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
  </joint>
</robot>)";

TEST(Refusals, ASerialArm) {
  EXPECT_THAT(refusal([] { converted_robot(read_model(serial_arm, "arm.urdf"), {.platform = "b"}); }),
              HasSubstr("arm.urdf: closes no loop"));
}

TEST(Refusals, APlatformThatThereIsNot) {
  EXPECT_THAT(refusal([] { converted_robot(five_bar(), {.platform = "efector"}); }),
              HasSubstr("no link or frame 'efector'; did you mean 'effector'?"));
}

TEST(Refusals, APlatformThatStandsStill) {
  EXPECT_THAT(refusal([] { converted_robot(five_bar(), {.platform = "frame"}); }),
              HasSubstr("is part of the base"));
}

TEST(Refusals, NoDrives) {
  BodyGraph graph = five_bar();
  graph.set_driven({});
  EXPECT_THAT(refusal([&] { converted_robot(graph, {.platform = "effector"}); }),
              HasSubstr("--drives JOINT,JOINT,..., of motor_left, elbow_left"));
}

TEST(Refusals, ARobotWithTooFewDrives) {
  EXPECT_THAT(
      refusal([] { converted_robot(five_bar(), {.platform = "effector", .drives = {"motor_left"}}); }),
      HasSubstr("has 1 drives, motor_left, for 2 coordinates of the platform: it is underactuated"));
}

TEST(Refusals, ALinkThatLeadsNowhere) {
  BodyGraph graph = five_bar();
  GraphBody tail;
  tail.name = "tail";
  GraphJoint hinge;
  hinge.name = "tail_hinge";
  hinge.kind = GraphJoint::Kind::revolute;
  hinge.parent = graph.frame("effector").body;
  hinge.child = graph.add_body(tail);
  graph.joints.push_back(hinge);
  EXPECT_THAT(refusal([&] { converted_robot(graph, {.platform = "effector"}); }),
              HasSubstr("link 'tail' hangs on the platform"));
}

TEST(Refusals, LoopsThatDoNotMeet) {
  BodyGraph graph = five_bar();
  for (GraphJoint& joint : graph.joints) {
    if (joint.name == "motor_right") joint.in_parent.translation().y() = -3.0;
  }
  EXPECT_THAT(refusal([&] { converted_robot(graph, {.platform = "effector"}); }),
              HasSubstr("the loops do not close from the zero of the joints"));
}

TEST(Refusals, MechanismsWithOtherCoordinates) {
  BodyGraph graph = five_bar();  // a four-bar: one arm stands
  for (GraphJoint& joint : graph.joints) {
    if (joint.name == "motor_right") joint.kind = GraphJoint::Kind::fixed;
  }
  EXPECT_THAT(refusal([&] { converted_robot(graph, {.platform = "effector", .drives = {"motor_left"}}); }),
              HasSubstr("moves in 1 coordinate in a plane"));
}

TEST(Refusals, JointsThatLegsHaveNot) {
  EXPECT_THAT(refusal([] {
                read_model(R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="floating"><parent link="a"/><child link="b"/></joint></robot>)",
                           "r.urdf");
              }),
              HasSubstr("r.urdf:2: <joint name=\"j\"> is floating"));
}

}  // namespace
}  // namespace flinch
