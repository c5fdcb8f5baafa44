#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/peer/mujoco_rig.h"

namespace flinch::peer {
namespace {

std::array<double, 3> three(const JointVector& values) { return {values[0], values[1], values[2]}; }

/// The rig with legs made of bodies, so that both engines are told the same.
PlanarRrrParameters robot_of_bodies(RigGeometry geometry, RigFriction friction) {
  PlanarRrrParameters robot = rig_robot(geometry, friction);
  for (PlanarRrrLeg& leg : robot.legs)
    leg.inertia = base_parameters(rig_link1(), rig_link2(), leg.link1_length);
  return robot;
}

/// Relative difference of the platform accelerations on `count` random states and torques, ascending.
std::vector<double> differences(const PlanarRrrParameters& parameters, int count) {
  const PlanarRrr robot(parameters);
  MujocoRig mujoco(parameters, rig_link1(), rig_link2());
  std::mt19937_64 generator(2026);
  const auto draw = [&generator](double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(generator);
  };
  std::vector<double> found;
  while (static_cast<int>(found.size()) < count) {
    const Eigen::Vector3d pose(draw(0.2), draw(0.2), draw(0.5));
    const Eigen::Vector3d velocity(draw(1.5), draw(1.5), draw(4.0));
    const Eigen::Vector3d torques(draw(40.0), draw(40.0), draw(40.0));
    Kinematics kinematics;
    robot.kinematics(pose, velocity, kinematics);
    const auto ours = robot.acceleration(pose, velocity, torques, Eigen::Vector3d::Zero());
    if (!kinematics.valid || !ours || std::abs(kinematics.det_A) < 0.1) continue;
    mujoco.set_state(pose, velocity, three(kinematics.joints.active), three(kinematics.joints.passive),
                     three(kinematics.rates.active), three(kinematics.rates.passive));
    const Eigen::Vector3d theirs = mujoco.platform_acceleration(torques);
    found.push_back((*ours - theirs).norm() / theirs.norm());
  }
  std::sort(found.begin(), found.end());
  return found;
}

class MujocoPeer : public testing::TestWithParam<std::pair<RigGeometry, RigFriction>> {};

TEST_P(MujocoPeer, GivesTheSamePlatformAccelerations) {
  const std::vector<double> found = differences(robot_of_bodies(GetParam().first, GetParam().second), 300);
  const double median = found[150], p99 = found[297];
  std::printf(
      "  relative difference to MuJoCo: median %.2e, 99th percentile %.2e, largest %.2e (asked: p99 <= "
      "1e-3)\n",
      median, p99, found.back());
  RecordProperty("p99", std::to_string(p99));
  EXPECT_LE(p99, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Robots, MujocoPeer,
                         testing::Values(std::pair{RigGeometry::nominal, RigFriction::none},
                                         std::pair{RigGeometry::individual, RigFriction::none},
                                         std::pair{RigGeometry::individual, RigFriction::simulation}));

}  // namespace
}  // namespace flinch::peer
