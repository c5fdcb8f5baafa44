#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/support/allocations.h"
#include "tests/systems/robot/differences.h"
#include "tests/systems/robot/residual.h"
#include "tests/systems/robot/written_legs.h"

// One robot, described in several ways: with a closed form or followed along a path, with joints that follow
// others or close themselves, with platform coordinates that are fixed or follow. All are the same robot.
namespace flinch::test {
namespace {

constexpr double rounding = 2e-12;  // relative where above 1

std::string file_text(const std::string& name) {
  std::ifstream file(std::string(FLINCH_SOURCE_DIR) + "/apps/robots/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  std::string all = text.str();
  const std::size_t drives = all.find("\ndrives:");
  return all.substr(0, drives == std::string::npos ? all.find("\nworkspace_limits:") : drives) + "\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to, int least = 1) {
  int count = 0;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
    ++count;
  }
  EXPECT_GE(count, least) << from;
  return text;
}

template <class A, class B>
double relative(const A& a, const B& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return HUGE_VAL;
  if (a.size() == 0) return 0.0;
  return (a - b).template lpNorm<Eigen::Infinity>() / std::max(1.0, b.template lpNorm<Eigen::Infinity>());
}

struct State {
  Configuration pose;
  PlatformVector velocity;
};

std::vector<State> states_of(const ParallelRobot& robot, double length, double angle, int count = 100) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<State> states;
  for (int i = 0; i < count; ++i) {
    PlatformVector xi(robot.dof()), v(robot.dof());
    for (int j = 0; j < robot.dof(); ++j) {
      xi[j] = uniform(generator) * (j < robot.space().translations() ? length : angle);
      v[j] = uniform(generator);
    }
    states.push_back({robot.space().plus(robot.home_pose(), xi), v});
  }
  return states;
}

// Platform coordinates, drives and equations of motion. `drive_scale`: drive positions of `a` by those of
// `b`.
void expect_same(const LegsRobot& a, const LegsRobot& b, double length, double angle,
                 double drive_scale = 1.0) {
  Residual maps("drive map and rate", rounding);
  Residual dynamics("M, C v, C^T v, g, F_fr", rounding);
  for (const State& state : states_of(b, length, angle)) {
    Kinematics ka, kb;
    a.kinematics(state.pose, state.velocity, ka);
    b.kinematics(state.pose, state.velocity, kb);
    ASSERT_TRUE(ka.valid && kb.valid) << state.pose.transpose();
    maps.add(relative(ka.J_qa_x, PlatformMatrix(drive_scale * kb.J_qa_x)));
    maps.add(relative(ka.dJ_qa_x, PlatformMatrix(drive_scale * kb.dJ_qa_x)));
    Dynamics da, db;
    a.dynamics(ka, da);
    b.dynamics(kb, db);
    dynamics.add(relative(da.M_x, db.M_x));
    dynamics.add(relative(da.C_x * state.velocity, db.C_x * state.velocity));
    dynamics.add(relative(da.C_x.transpose() * state.velocity, db.C_x.transpose() * state.velocity));
    dynamics.add(relative(da.g_x, db.g_x));
    dynamics.add(relative(da.F_fr_x, db.F_fr_x));
  }
}

LegsRobot shipped(const std::string& name) { return legs_robot_in(file_text(name)); }

// ---------------------------------------------------------------- numbers worked out elsewhere

TEST(LegsNumbers, AreThoseOfTheDelta) {
  const LegsRobot delta = shipped("delta.yaml");
  Kinematics k;
  const Eigen::Vector3d v(0.5, -0.3, 0.4);
  delta.kinematics(Eigen::Vector3d(0.1, 0.06, -0.66), v, k);
  ASSERT_TRUE(k.valid);
  EXPECT_LT((k.joints.active - Eigen::Vector3d(0.180809, 0.396779, 0.608407)).norm(), 1e-6);
  EXPECT_LT((k.rates.active - Eigen::Vector3d(-2.192619, 0.159702, -0.813413)).norm(), 1e-6);
  EXPECT_LT((k.dJ_qa_x * v - Eigen::Vector3d(-0.180782, 2.589742, 1.803407)).norm(), 2e-6);
  Dynamics d;
  delta.dynamics(k, d);
  Eigen::Matrix3d M;
  M << 1.001988, 0.000231, -0.107486, 0.000231, 0.964638, -0.060524, -0.107486, -0.060524, 1.717374;
  EXPECT_LT((d.M_x - M).norm(), 2e-6);
  EXPECT_LT((d.C_x * v - Eigen::Vector3d(0.222948, -0.014392, -0.435931)).norm(), 2e-6);
  EXPECT_LT((d.C_x.transpose() * v - Eigen::Vector3d(-0.212742, 0.121703, 0.210753)).norm(), 2e-6);
  EXPECT_LT((d.g_x - Eigen::Vector3d(-1.258958, -0.656620, 18.218932)).norm(), 2e-6);
}

TEST(LegsNumbers, AreThoseOfTheRedundantPlanarRobot) {
  const LegsRobot robot = shipped("planar_4rrr.yaml");
  Kinematics k;
  robot.kinematics(robot.home_pose(), Eigen::Vector3d::Zero(), k);
  ASSERT_TRUE(k.valid);
  for (const double q : k.joints.active) EXPECT_NEAR(q * 180.0 / std::numbers::pi, 25.251374, 1e-6);
  for (const double q : k.joints.passive) EXPECT_NEAR(q * 180.0 / std::numbers::pi, 122.819339, 1e-6);
  EXPECT_LT((k.J_qa_x.row(0) - Eigen::RowVector3d(-1.082054, -1.736413, -0.185796)).norm(), 1e-6);
  EXPECT_NEAR(k.sigma_kappa, 7.786572, 1e-6);
  Dynamics d;
  robot.dynamics(k, d);
  EXPECT_LT((d.M_x.diagonal() - Eigen::Vector3d(4.987370, 4.987370, 0.066959)).norm(), 2e-6);
  const JointVector least = drive_torques(k, Eigen::Vector3d(10.0, 0.0, 0.0));
  EXPECT_LT((least - Eigen::Vector4d(-1.292477, 2.074087, 1.292477, -2.074087)).norm(), 1e-5);
}

// ---------------------------------------------------------------- one robot, several descriptions

// Two rods in the place of one, half as heavy: the second follows, or has a closure of its own, or holds the
// platform's orientation together with it.
std::string two_rods(const std::string& closures, bool follows) {
  std::string text = file_text("delta.yaml");
  const std::size_t elbow = text.find("      - name: elbow");
  const std::size_t end = text.find("    closures:", elbow);
  const auto rod = [&](const std::string& name, const std::string& y, bool following) {
    return "      - {name: " + name + ", on: shoulder, kind: universal, at_m: [0.3, " + y +
           ", 0], axis: [0, 1, 0], second_axis: [1, 0, 0], " +
           (following ? "follows: {joint: elbow_a}, " : "reference_deg: 25, ") +
           "link: {mass_kg: 0.12, centre_of_mass_m: [0, 0, -0.35], inertia_kg_m2: [4.9e-3, 4.9e-3, 0]}}\n";
  };
  text.replace(elbow, end - elbow, rod("elbow_a", "-0.04", false) + rod("elbow_b", "0.04", follows));
  for (const double angle : {0.0, 120.0, 240.0}) {
    std::ostringstream both;
    both.precision(17);
    const auto tip = [&](double y) {
      const double a = angle * std::numbers::pi / 180.0;
      const double x = 0.05;
      std::ostringstream point;
      point.precision(17);
      point << "[" << x * std::cos(a) - y * std::sin(a) << ", " << x * std::sin(a) + y * std::cos(a)
            << ", 0]";
      return point.str();
    };
    both << "    closures: [{joint: elbow_a, at_m: [0, 0, -0.7], on_platform_m: " << tip(-0.04) << "}";
    if (!follows) both << ", {joint: elbow_b, at_m: [0, 0, -0.7], on_platform_m: " << tip(0.04) << "}";
    both << "]\n";
    const std::size_t at = text.find("    closures: [{at_m");
    const std::size_t line = text.find('\n', at) + 1;
    text.replace(at, line - at, both.str());
  }
  return closures.empty() ? text : replaced(text, "moves: translation", closures);
}

TEST(LegsForms, WithAMirroredRodAreThoseWithOneRodOfDoubleMass) {
  expect_same(legs_robot_in(two_rods("", true)), shipped("delta.yaml"), 0.12, 0.0);
}

TEST(LegsForms, WithTwoRodsThatCloseAreThoseWithOne) {
  const LegsRobot closed = legs_robot_in(two_rods("", false));
  EXPECT_FALSE(closed.model().legs[0].form.has_value());
  EXPECT_FALSE(closed.model().legs[0].is_square());
  expect_same(closed, shipped("delta.yaml"), 0.12, 0.0);
}

TEST(LegsForms, WithAnOrientationThatFollowsFromParallelogramsAreThoseThatFixIt) {
  const LegsRobot follows = legs_robot_in(two_rods(
      "moves: coordinates\ncoordinates: {x: free, y: free, z: free, rx: follows, ry: follows, rz: follows}",
      false));
  EXPECT_EQ(follows.model().following(), 3);
  expect_same(follows, shipped("delta.yaml"), 0.12, 0.0);
}

// The hinge at the platform given as a joint: three joints that hold a frame, in the place of two that hold a
// point.
TEST(LegsForms, WithHingesAtThePlatformAreThoseThatHoldPoints) {
  const PlanarRrrParameters p = rig_robot(RigGeometry::individual, RigFriction::simulation);
  const std::string text = legs_text(p, rig_link1(), rig_link2());
  std::string hinged = text;
  std::size_t at = 0;
  for (const PlanarRrrLeg& leg : p.legs) {
    std::ostringstream hinge;
    hinge.precision(17);
    const double reference = -leg.base_angle * 180.0 / std::numbers::pi - 147.0;
    hinge << "      - {name: hinge, kind: revolute, at_m: [" << leg.link2_length
          << ", 0, 0], reference_deg: " << std::remainder(reference, 360.0)
          << "}\n    closures: [{holds: frame, on_platform_m";
    const std::size_t from = hinged.find("    closures: [{at_m", at);
    const std::size_t to = hinged.find("on_platform_m", from) + 13;
    hinged.replace(from, to - from, hinge.str());
    at = from + hinge.str().size();
  }
  hinged = replaced(hinged, "reference_deg: 90", "reference_deg: 115");
  const LegsRobot by_hinges = legs_robot_in(hinged);
  EXPECT_FALSE(by_hinges.model().legs[0].form.has_value());
  EXPECT_TRUE(by_hinges.model().legs[0].is_square());
  expect_same(by_hinges, legs_robot_in(text), 0.2, 0.3);
}

// A spherical joint given as one, which holds a frame; the leg has six coordinates then and is followed.
TEST(LegsForms, WithSphericalJointsAreThoseThatHoldPoints) {
  const std::string text = legs_text(hexapod_robot(HexapodPayload::eccentric, HexapodFriction::ball_screws));
  // Its frame at home is that of the platform, so that its own angles are small.
  LegsParameters p = legs_parameters_in(text);
  const LegsRobot closed(p);
  for (std::size_t i = 0; i < p.legs.size(); ++i) {
    RobotLeg& leg = p.legs[i];
    ChainPlace place;
    closed.model().legs[i].chain.place(closed.model().legs[i].home, place);
    LegJoint ball;
    ball.name = "ball";
    ball.kind = LegJointKind::spherical;
    ball.turned = rotation_log(place.axes[2].transpose());
    leg.joints.push_back(ball);
    leg.closures.front().holds_frame = true;
    for (std::size_t j = 0; j < 2; ++j)
      leg.joints[0].reference[j] = closed.model().legs[i].home[static_cast<int>(j)];
  }
  const LegsRobot followed(p);
  EXPECT_EQ(followed.model().legs[0].chain.coordinates, 6);
  expect_same(followed, closed, 0.06, 0.2);
}

// A rod that is screwed out instead of pushed, and does not resist that turning.
TEST(LegsForms, WithScrewsAreThoseThatSlide) {
  HexapodParameters hexapod = hexapod_robot();
  hexapod.rod.inertia(2, 2) = 0.0;
  hexapod.rod.inertia(0, 0) = hexapod.rod.inertia(1, 1) = 0.018;
  LegsParameters sliding = legs_parameters_in(legs_text(hexapod));
  LegsParameters screwed = sliding;
  const double pitch = 0.5;
  for (RobotLeg& leg : screwed.legs) {
    LegJoint& screw = leg.joints[1];
    screw.kind = LegJointKind::screw;
    screw.pitch = pitch;
    screw.reference[0] *= 2.0 * std::numbers::pi / pitch;
    screw.least = -HUGE_VAL;
    screw.most = HUGE_VAL;
  }
  expect_same(LegsRobot(screwed), LegsRobot(sliding), 0.05, 0.2, 2.0 * std::numbers::pi / pitch);
}

// ---------------------------------------------------------------- drives

TEST(LegsForms, WithADriveMapMoveTheirDrivesBySumsOfJoints) {
  const std::string text = replaced(file_text("planar_3rpr.yaml"), "        drive: {armature_kg: 0.3}\n", "");
  const LegsRobot summed = legs_robot_in(text +
                                         "drive_map: [{leg1.slide: 0.5, leg2.slide: 0.5}, {leg2.slide: 2.0, "
                                         "leg1.slide: -1.0}, {leg3.slide: 1.0}]\n");
  const LegsRobot own =
      legs_robot_in(replaced(file_text("planar_3rpr.yaml"), "armature_kg: 0.3", "armature_kg: 0.0"));
  Eigen::Matrix3d map;
  map << 0.5, 0.5, 0.0, -1.0, 2.0, 0.0, 0.0, 0.0, 1.0;
  Residual residual("drives by the map", 1e-14);
  for (const State& state : states_of(own, 0.05, 0.2)) {
    Kinematics a, b;
    summed.kinematics(state.pose, state.velocity, a);
    own.kinematics(state.pose, state.velocity, b);
    residual.add(relative(a.joints.active, JointVector(map * b.joints.active)));
    residual.add(relative(a.dJ_qa_x, PlatformMatrix(map * b.dJ_qa_x)));
    Dynamics da, db;
    summed.dynamics(a, da);
    own.dynamics(b, db);
    residual.add(relative(da.M_x, db.M_x));
  }
}

TEST(LegsForms, WithGearsCountDrivesByTheirRatio) {
  const std::string text = file_text("delta.yaml");
  const LegsRobot geared = legs_robot_in(replaced(
      text, "drive: {armature_kg_m2: 0.010}", "drive: {armature_kg_m2: 0.010, ratio: -2.0, zero_rad: 0.3}"));
  const LegsRobot plain = legs_robot_in(text);
  for (const State& state : states_of(plain, 0.1, 0.0, 20)) {
    Kinematics a, b;
    geared.kinematics(state.pose, state.velocity, a);
    plain.kinematics(state.pose, state.velocity, b);
    EXPECT_LT(relative(a.joints.active, JointVector((-2.0 * b.joints.active).array() + 0.3)), 1e-14);
    EXPECT_LT(relative(a.rates.active, JointVector(-2.0 * b.rates.active)), 1e-14);
  }
  const auto found = geared.forward_kinematics(
      geared.inverse_kinematics(Eigen::Vector3d(0.05, 0.02, -0.6), geared.home_working_mode()).joints.active,
      geared.home_pose(), geared.home_working_mode());
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.pose - Eigen::Vector3d(0.05, 0.02, -0.6)).norm(), 1e-11);
}

// ---------------------------------------------------------------- paths

// Far beyond reach: a followed leg finds the solution of the closed form, or none.
TEST(LegsPaths, NeverJump) {
  const PlanarRrrParameters p = rig_robot(RigGeometry::nominal, RigFriction::none);
  LegsParameters parameters = legs_parameters_in(legs_text(p, rig_link1(), rig_link2()));
  const LegsRobot closed(parameters);
  for (RobotLeg& leg : parameters.legs) {  // A second closure that says the same takes the closed form away.
    leg.closures.push_back(leg.closures.front());
    leg.joints[0].reference[0] = 25.0 * std::numbers::pi / 180.0;
    leg.joints[1].reference[0] = 120.0 * std::numbers::pi / 180.0;
  }
  const LegsRobot followed(parameters);
  ASSERT_FALSE(followed.model().legs[0].form.has_value());
  int both = 0;
  int shy = 0;
  for (const State& state : states_of(closed, 1.0, 2.0, 2000)) {
    const InverseSolution a = followed.inverse_kinematics(state.pose, followed.home_working_mode());
    const InverseSolution b = closed.inverse_kinematics(state.pose, closed.home_working_mode());
    ASSERT_FALSE(a.reachable && !b.reachable);
    if (!b.reachable) continue;
    if (!a.reachable) {
      ++shy;
      continue;
    }
    ++both;
    EXPECT_LT(closed.drive_difference(a.joints.active, b.joints.active).lpNorm<Eigen::Infinity>(), 1e-9);
  }
  EXPECT_GT(both, 100);
  EXPECT_LT(shy, both / 3) << "whose straight paths are blocked";
}

TEST(LegsPaths, NeitherAllocateNorFailOnWildInput) {
  const LegsRobot robot = legs_robot_in(two_rods(
      "moves: coordinates\ncoordinates: {x: free, y: free, z: free, rx: follows, ry: follows, rz: follows}",
      false));
  std::vector<State> states = states_of(robot, 0.3, 0.0, 200);
  for (const double wild : {1e3, 1e8, 1e300, HUGE_VAL, std::nan("")})
    states.push_back({Eigen::Vector3d(0.1, wild, 0.0), Eigen::Vector3d::Ones()});
  const AllocationCounter counter;
  for (const State& state : states) {
    Kinematics k;
    Dynamics d;
    robot.kinematics(state.pose, state.velocity, k);
    robot.dynamics(k, d);
    robot.contact_jacobian(k, BodyId::link2(1), Eigen::Vector3d(0.0, 0.0, -0.3));
    robot.forward_kinematics(k.joints.active, robot.home_pose(), robot.home_working_mode());
  }
  EXPECT_EQ(counter.count(), 0);
}

// ---------------------------------------------------------------- following coordinates by differences

TEST(LegsFollowing, MapsAreDerivatives) {
  const LegsRobot robot = legs_robot_in(two_rods(
      "moves: coordinates\ncoordinates: {x: free, y: free, z: free, rx: follows, ry: follows, rz: follows}",
      false));
  Residual map("drive map", 1e-9);
  Residual rate("rate of the drive map", 1e-8);
  Residual mass("dM/dt = C + C^T", 1e-8);
  for (const State& state : states_of(robot, 0.1, 0.0, 20)) {
    const auto at = [&](const PlatformVector& xi) {
      Kinematics k;
      robot.kinematics(robot.space().plus(state.pose, xi), state.velocity, k);
      return k;
    };
    const auto dynamics = [&](const Kinematics& k) {
      Dynamics d;
      robot.dynamics(k, d);
      return d;
    };
    const Kinematics k = at(PlatformVector::Zero(3));
    for (int axis = 0; axis < 3; ++axis) {
      const JointVector column = derivative(
          [&](double h) -> JointVector { return at(h * PlatformVector::Unit(3, axis)).joints.active; });
      map.add(relative(k.J_qa_x.col(axis), column));
    }
    const PlatformMatrix dJ =
        derivative([&](double h) -> PlatformMatrix { return at(h * state.velocity).J_qa_x; });
    rate.add(relative(k.dJ_qa_x, dJ));
    const PlatformMatrix C = dynamics(k).C_x;
    const PlatformMatrix dM =
        derivative([&](double h) -> PlatformMatrix { return dynamics(at(h * state.velocity)).M_x; });
    mass.add(relative(PlatformMatrix(C + C.transpose()), dM));
  }
}

}  // namespace
}  // namespace flinch::test
