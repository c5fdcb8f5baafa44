#include "systems/robot/five_bar.h"

#include <gtest/gtest.h>

#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/link_segments.h"

// Numbers of an independent implementation, at home and at one state.
namespace flinch::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double printed = 6e-7;  // half a unit in the last printed digit

struct State {
  Kinematics k;
  Dynamics dynamics;

  State(const FiveBar& robot, const Eigen::Vector2d& pose, const Eigen::Vector2d& velocity) {
    robot.kinematics(pose, velocity, k);
    robot.dynamics(k, dynamics);
  }
};

TEST(FiveBarAtHome, HasTheValuesOfAnIndependentImplementation) {
  const FiveBar robot(five_bar_robot());
  const auto [k, dynamics] = State(robot, robot.home_pose(), {0.0, 0.0});
  EXPECT_EQ(robot.home_working_mode(), (WorkingMode{{1, 0}}));
  EXPECT_LT((k.joints.active / degree - Eigen::Vector2d(106.37759, 73.62241)).norm(), 1e-5);
  EXPECT_LT((k.joints.passive / degree - Eigen::Vector2d(-77.99491, 77.99491)).norm(), 1e-5);
  Eigen::Matrix2d A;
  A << -3.910715, -2.112988, -3.910715, 2.112988;
  EXPECT_LT((k.J_qa_x - A).lpNorm<Eigen::Infinity>(), printed);
  EXPECT_NEAR(k.sigma_kappa, 1.850798, printed);
  EXPECT_LT((dynamics.M_x - Eigen::Vector2d(0.788774, 0.489334).asDiagonal().toDenseMatrix()).norm(),
            printed);
  EXPECT_TRUE(dynamics.g_x.isZero(0.0));
}

TEST(FiveBarInMotion, HasTheValuesOfAnIndependentImplementation) {
  const FiveBar robot(five_bar_robot());
  const Eigen::Vector2d v(0.3, -0.2);
  const auto [k, dynamics] = State(robot, {0.05, 0.31}, v);
  EXPECT_LT((k.joints.active - Eigen::Vector2d(1.690729, 1.050840)).norm(), printed);
  EXPECT_LT((k.joints.passive - Eigen::Vector2d(-1.327805, 1.590115)).norm(), printed);
  Eigen::Matrix2d A;
  A << -4.187643, -1.590236, -3.814958, 2.087281;
  EXPECT_LT((k.J_qa_x - A).lpNorm<Eigen::Infinity>(), printed);
  EXPECT_LT((k.dJ_qa_x * v - Eigen::Vector2d(-1.354587, -0.035768)).lpNorm<Eigen::Infinity>(), printed);
  Eigen::Matrix2d M;
  M << 0.804277, -0.022850, -0.022850, 0.468107;
  EXPECT_LT((dynamics.M_x - M).lpNorm<Eigen::Infinity>(), printed);
  EXPECT_LT((dynamics.C_x * v - Eigen::Vector2d(0.062960, 0.006152)).norm(), printed);
  EXPECT_LT((dynamics.C_x.transpose() * v - Eigen::Vector2d(0.030139, -0.043080)).norm(), printed);
}

TEST(FiveBarWithElbowsInward, HasTheDrivesOfAnIndependentImplementation) {
  const FiveBar robot(five_bar_robot(FiveBarElbows::inward));
  const JointAngles home = robot.inverse_kinematics(robot.home_pose(), robot.home_working_mode()).joints;
  EXPECT_EQ(robot.home_working_mode(), (WorkingMode{{0, 1}}));
  EXPECT_LT((home.active - Eigen::Vector2d(0.495371, 2.646221)).norm(), printed);
}

TEST(FiveBarSingularities, AreWhereTheSecondLinksAreInLineAndWhereALegIsStretched) {
  const FiveBar robot(five_bar_robot());
  // Drives straight up, the elbows 0.275 m apart at y = 0.23 m.
  const double across = std::sqrt(0.23 * 0.23 - 0.1375 * 0.1375);
  const auto home_side = State(robot, {0.0, 0.23 + across}, {0.0, 0.0});
  EXPECT_NEAR(home_side.k.det_A, 4.0 * 0.23 * 0.23 * 2.0 * 0.1375 * across / (0.23 * 0.23), 1e-12);
  EXPECT_NEAR(home_side.k.det_B, -4.0 * std::pow(0.1375 * 0.23, 2), 1e-12);
  const double stretched = std::sqrt(0.46 * 0.46 - 0.1375 * 0.1375);
  EXPECT_TRUE(State(robot, {0.0, stretched - 1e-9}, {0.0, 0.0}).k.reachable);
  EXPECT_FALSE(State(robot, {0.0, stretched + 1e-9}, {0.0, 0.0}).k.reachable);
  EXPECT_NEAR(State(robot, {0.0, stretched - 1e-9}, {0.0, 0.0}).k.det_B, 0.0, 1e-8);
}

TEST(FiveBarForwardKinematics, TellsThePointFromItsMirrorImage) {
  const FiveBar robot(five_bar_robot());
  const Eigen::Vector2d point(0.03, 0.30);
  const JointVector active = robot.inverse_kinematics(point, robot.home_working_mode()).joints.active;
  const auto from = [&](const Eigen::Vector2d& start) {
    return robot.forward_kinematics(active, start, robot.home_working_mode());
  };
  EXPECT_TRUE(from(robot.home_pose()).converged);
  EXPECT_LT((from(robot.home_pose()).pose - point).norm(), 1e-15);
  // Started below the elbows, it is the point's mirror image in the line from elbow to elbow.
  const ForwardSolution below = from(Eigen::Vector2d(0.0, 0.0));
  EXPECT_TRUE(below.converged);
  const auto at_point = State(robot, point, {0.0, 0.0});
  const Eigen::Vector2d elbow = at_point.k.legs[0].passive_joint;
  const Eigen::Vector2d line = at_point.k.legs[1].passive_joint - elbow;
  const Eigen::Vector2d between = below.pose - point;
  EXPECT_NEAR(between.dot(line), 0.0, 1e-15);
  EXPECT_LT(below.pose[1], elbow.y());
  EXPECT_NEAR((below.pose - elbow).norm(), 0.23, 1e-15);
  EXPECT_FALSE(from(Eigen::Vector2d(0.0, 0.9)).converged);  // a start out of reach lies on no side
}

TEST(FiveBarBodies, AreThePlatformAndFourLinks) {
  const FiveBar robot(five_bar_robot());
  EXPECT_EQ(robot.body_count(), 5);
  EXPECT_EQ(robot.description().self_collision_pairs.size(), 3u);
  const auto home = State(robot, robot.home_pose(), {0.0, 0.0});
  // Nearest to an elbow is the end of the other leg's second link, by the length of a second link.
  EXPECT_NEAR(self_collision_distance(robot, home.k), 0.23, 1e-12);
}

TEST(FiveBarParameters, AreReportedByTheirPathWhereTheyAreWrong) {
  EXPECT_TRUE(problems(five_bar_robot()).empty());
  const std::pair<const char*, void (*)(FiveBarParameters&)> cases[] = {
      {"name", [](FiveBarParameters& p) { p.name.clear(); }},
      {"legs[1].base_joint[0]", [](FiveBarParameters& p) { p.legs[1].base_joint.x() = std::nan(""); }},
      {"legs[0].link2_length", [](FiveBarParameters& p) { p.legs[0].link2_length = 0.0; }},
      {"legs[1].inertia has", [](FiveBarParameters& p) { p.legs[1].inertia.p3 = 0.5; }},
      {"platform_mass", [](FiveBarParameters& p) { p.platform_mass = 0.0; }},
      {"platform_radius", [](FiveBarParameters& p) { p.platform_radius = -1.0; }},
      {"link_radius", [](FiveBarParameters& p) { p.link_radius = 0.0; }},
      {"friction_velocity", [](FiveBarParameters& p) { p.friction_velocity = 0.0; }},
      {"gravity[1]", [](FiveBarParameters& p) { p.gravity.y() = 9.81; }},
      {"home_pose[1]", [](FiveBarParameters& p) { p.home_pose.y() = std::nan(""); }},
      {"home_pose is out of reach of legs[0]", [](FiveBarParameters& p) { p.home_pose.x() = 0.2; }},
  };
  for (const auto& [path, spoil] : cases) {
    FiveBarParameters parameters = five_bar_robot();
    spoil(parameters);
    const std::vector<std::string> found = problems(parameters);
    ASSERT_EQ(found.size(), 1u) << path;
    EXPECT_EQ(found[0].rfind(path, 0), 0u) << found[0];
    EXPECT_THROW(FiveBar robot(parameters), SetupError) << path;
  }
}

}  // namespace
}  // namespace flinch::test
