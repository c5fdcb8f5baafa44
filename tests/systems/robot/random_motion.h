#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/systems/robot/differences.h"

namespace flinch::test {

struct PoseAndVelocity {
  Eigen::Vector3d pose;
  Eigen::Vector3d velocity;
};

/// Poses within `radius` and 35 degrees of home that the robot may work at (|det A| >= 0.2), velocities up to
/// 1 m/s and 3 rad/s. The same for the same seed.
inline std::vector<PoseAndVelocity> random_motions(const PlanarRrr& robot, int count, unsigned seed = 1,
                                                   double radius = 0.25) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&](double scale) { return scale * uniform(generator); };
  std::vector<PoseAndVelocity> motions;
  while (static_cast<int>(motions.size()) < count) {
    const Eigen::Vector3d pose(draw(radius), draw(radius), draw(0.61));
    const Eigen::Vector3d velocity(draw(1.0), draw(1.0), draw(3.0));
    Kinematics kinematics;
    robot.kinematics(pose, velocity, kinematics);
    if (pose.head<2>().norm() > radius || !kinematics.valid || std::abs(kinematics.det_A) < 0.2) continue;
    motions.push_back({pose, velocity});
  }
  return motions;
}

/// Tests that run for both published geometries, with the friction of the test rig.
class BothGeometries : public ::testing::TestWithParam<RigGeometry> {
 protected:
  PlanarRrr robot{rig_robot(GetParam(), RigFriction::test_rig)};
  std::vector<PoseAndVelocity> motions = random_motions(robot, 300);

  Kinematics kinematics_at(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) const {
    Kinematics kinematics;
    robot.kinematics(pose, velocity, kinematics);
    return kinematics;
  }
  Dynamics dynamics_at(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) const {
    Dynamics dynamics;
    robot.dynamics(kinematics_at(pose, velocity), dynamics);
    return dynamics;
  }
};

inline std::string geometry_name(const ::testing::TestParamInfo<RigGeometry>& info) {
  return info.param == RigGeometry::individual ? "Individual" : "Nominal";
}

}  // namespace flinch::test

#define FLINCH_FOR_BOTH_GEOMETRIES(suite)                                                                  \
  INSTANTIATE_TEST_SUITE_P(Bench, suite, ::testing::Values(RigGeometry::individual, RigGeometry::nominal), \
                           geometry_name)
