#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "systems/robot/planar_leg_bases.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/peer/mujoco_rig.h"

namespace flinch::peer {
namespace {

std::array<double, 3> three(const JointVector& values) { return {values[0], values[1], values[2]}; }

TEST(MujocoPeer, BearsTheSameForcesAtTheBaseJoints) {
  PlanarRrrParameters parameters = rig_robot(RigGeometry::individual, RigFriction::simulation);
  std::array<double, 3> moments{};
  for (std::size_t i = 0; i < 3; ++i) {
    PlanarRrrLeg& leg = parameters.legs[i];
    leg.inertia = base_parameters(rig_link1(), rig_link2(), leg.link1_length);
    moments[i] = rig_link1().mass * rig_link1().centre_of_mass + rig_link2().mass * leg.link1_length;
  }
  const auto robot = std::make_shared<const PlanarRrr>(parameters);
  const PlanarLegBases bases(robot, moments);
  MujocoRig mujoco(parameters, rig_link1(), rig_link2());
  std::mt19937_64 generator(2027);
  const auto draw = [&generator](double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(generator);
  };
  std::vector<double> found;
  while (found.size() < 300) {
    const Eigen::Vector3d pose(draw(0.2), draw(0.2), draw(0.5));
    const Eigen::Vector3d velocity(draw(1.5), draw(1.5), draw(4.0));
    const Eigen::Vector3d torques(draw(40.0), draw(40.0), draw(40.0));
    Kinematics kinematics;
    robot->kinematics(pose, velocity, kinematics);
    const auto acceleration = robot->acceleration(pose, velocity, torques, Eigen::Vector3d::Zero());
    if (!kinematics.valid || !acceleration || std::abs(kinematics.det_A) < 0.1) continue;
    BaseForces ours;
    bases.forces(kinematics, *acceleration, torques, {}, ours);
    mujoco.set_state(pose, velocity, three(kinematics.joints.active), three(kinematics.joints.passive),
                     three(kinematics.rates.active), three(kinematics.rates.passive));
    mujoco.platform_acceleration(torques);
    mj_rnePostConstraint(mujoco.model(), mujoco.data());
    Eigen::Matrix<double, 6, 1> theirs;
    for (int leg = 0; leg < 3; ++leg) {
      const std::string name = "leg" + std::to_string(leg) + "_link1";
      const int body = mj_name2id(mujoco.model(), mjOBJ_BODY, name.c_str());
      theirs.segment<2>(2 * leg) = Eigen::Map<const Eigen::Vector2d>(mujoco.data()->cfrc_int + 6 * body + 3);
    }
    found.push_back((ours - theirs).norm() / theirs.norm());
  }
  std::sort(found.begin(), found.end());
  std::printf("  base forces, relative difference to MuJoCo: median %.2e, 99th percentile %.2e\n", found[150],
              found[297]);
  EXPECT_LE(found[297], 1e-3);
}

}  // namespace
}  // namespace flinch::peer
