#include "tests/peer/mujoco_legs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "convert/legs_of_robot.h"
#include "systems/config/config_reader.h"
#include "systems/config/legs_file.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch::peer {
namespace {

/// A robot file that is shipped, without the dry friction that MuJoCo has another law for.
LegsParameters shipped(const std::string& name) {
  ConfigReader reader = ConfigReader::open("apps/robots/" + name + ".yaml");
  LegsParameters robot = read_legs_parameters(reader);
  for (RobotLeg& leg : robot.legs)
    for (LegJoint& joint : leg.joints) joint.friction.coulomb = 0.0;
  return robot;
}

class Draw {
 public:
  template <class Vector>
  Vector vector(Eigen::Index size, double limit) {
    Vector drawn(size);
    for (double& entry : drawn) entry = std::uniform_real_distribution<double>(-limit, limit)(generator_);
    return drawn;
  }

 private:
  std::mt19937_64 generator_{2026};
};

/// Relative difference of the platform accelerations on 300 random states and efforts, ascending. Angular
/// ones count at the characteristic length.
std::vector<double> differences(const ParallelRobot& robot, const LegsParameters& parameters) {
  MujocoLegs mujoco(parameters);
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  PlatformVector scale = PlatformVector::Ones(robot.dof());
  scale.tail(robot.space().rotations()).setConstant(parameters.characteristic_length);
  Draw draw;
  std::vector<double> found;
  for (int attempt = 0; found.size() < 300 && attempt < 1000; ++attempt) {
    const auto from_home = draw.vector<PlatformVector>(robot.dof(), 0.1);
    const auto velocity = draw.vector<PlatformVector>(robot.dof(), 0.8);
    const auto efforts = draw.vector<JointVector>(robot.drives(), turns ? 20.0 : 200.0);
    Kinematics k;
    Dynamics dynamics;
    const Configuration pose = robot.space().plus(robot.home_pose(), from_home);
    robot.kinematics(pose, velocity, k);
    if (!k.valid) continue;
    robot.dynamics(k, dynamics);
    const auto ours = forward_dynamics(k, dynamics, efforts, PlatformVector::Zero(robot.dof()));
    const auto theirs = mujoco.platform_acceleration(pose, velocity, efforts);
    if (!ours || !theirs) continue;
    found.push_back((*ours - *theirs).cwiseProduct(scale).norm() / theirs->cwiseProduct(scale).norm());
  }
  std::sort(found.begin(), found.end());
  return found;
}

class MujocoLegsPeer : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Robots, MujocoLegsPeer,
                         testing::Values("delta", "planar_3rpr", "planar_4rrr", "hexa_6rus", "linapod_6pus",
                                         "tricept"),
                         [](const auto& each) { return std::string(each.param); });

void expect_same(const ParallelRobot& robot, const LegsParameters& parameters) {
  const std::vector<double> found = differences(robot, parameters);
  ASSERT_EQ(found.size(), 300U) << "states at which both close their loops";
  std::printf(
      "  relative difference to MuJoCo: median %.2e, 99th percentile %.2e, largest %.2e (asked: p99 <= "
      "1e-3)\n",
      found[150], found[297], found.back());
  testing::Test::RecordProperty("p99", std::to_string(found[297]));
  EXPECT_LE(found[297], 1e-3);
}

TEST_P(MujocoLegsPeer, GivesTheSamePlatformAccelerations) {
  const LegsParameters parameters = shipped(GetParam());
  expect_same(LegsRobot(parameters), parameters);
}

// What the closed forms of a mechanism say, against its model.
TEST(MujocoClosedFormsPeer, GiveTheSamePlatformAccelerations) {
  const PlanarRrr planar(rig_robot(RigGeometry::individual, RigFriction::none));
  const FiveBar five_bar(five_bar_robot(FiveBarElbows::outward, FiveBarFriction::none));
  const Hexapod hexapod(hexapod_robot(HexapodPayload::eccentric));
  for (const ParallelRobot* const robot :
       std::initializer_list<const ParallelRobot*>{&planar, &five_bar, &hexapod})
    expect_same(*robot, as_legs(*robot));
}

}  // namespace
}  // namespace flinch::peer
