#include "tests/peer/mujoco_hexapod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "systems/robot/forward_dynamics.h"
#include "systems/robot/hexapod_presets.h"

namespace flinch::peer {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Relative difference of the platform accelerations on 300 random states and forces, ascending. Angular
/// ones count at the characteristic length.
std::vector<double> differences(const HexapodParameters& parameters) {
  const Hexapod robot(parameters);
  MujocoHexapod mujoco(robot);
  std::mt19937_64 generator(2026);
  const auto draw = [&generator](const Vector6& limits) {
    Vector6 drawn = limits;
    for (double& entry : drawn) entry *= std::uniform_real_distribution<double>(-1.0, 1.0)(generator);
    return drawn;
  };
  const double length = parameters.characteristic_length;
  const Vector6 scale{1.0, 1.0, 1.0, length, length, length};
  std::vector<double> found;
  while (found.size() < 300) {
    const Vector6 from_home = draw({0.10, 0.10, 0.08, 0.25, 0.25, 0.25});
    const Vector6 velocity = draw({0.6, 0.6, 0.6, 3.0, 3.0, 3.0});
    const Vector6 forces = draw(Vector6::Constant(300.0));
    Kinematics k;
    Dynamics dynamics;
    robot.kinematics(robot.space().plus(robot.home_pose(), from_home), velocity, k);
    robot.dynamics(k, dynamics);
    const auto ours = forward_dynamics(k, dynamics, forces, Vector6(Vector6::Zero()));
    if (!k.valid || !ours) continue;
    const Vector6 theirs = mujoco.platform_acceleration(k, forces);
    found.push_back((*ours - theirs).cwiseProduct(scale).norm() / theirs.cwiseProduct(scale).norm());
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(MujocoHexapodPeer, GivesTheSamePlatformAccelerations) {
  HexapodParameters loaded = hexapod_robot(HexapodPayload::eccentric, HexapodFriction::ball_screws);
  for (HexapodLeg& leg : loaded.legs) leg.drive_friction.coulomb = 0.0;  // for which MuJoCo has another law
  for (const HexapodParameters& robot : {hexapod_robot(), loaded}) {
    const std::vector<double> found = differences(robot);
    std::printf(
        "  relative difference to MuJoCo: median %.2e, 99th percentile %.2e, largest %.2e (asked: p99 <= "
        "1e-3)\n",
        found[150], found[297], found.back());
    RecordProperty(robot.payload ? "p99 loaded" : "p99", std::to_string(found[297]));
    EXPECT_LE(found[297], 1e-3);
  }
}

}  // namespace
}  // namespace flinch::peer
