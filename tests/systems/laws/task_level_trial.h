#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "systems/framework/random.h"
#include "systems/laws/task_level.h"
#include "tests/support/planar_rig.h"

namespace flinch::test {

/// The rig with friction in random postures, and levels that no drive limits.
class TaskLevelTrial : public testing::Test {
 protected:
  explicit TaskLevelTrial(std::uint64_t seed) : random(seed) {}

  Eigen::Vector3d any(double length, double angle) {
    return {random.uniform(-length, length), random.uniform(-length, length), random.uniform(-angle, angle)};
  }
  Posture any_posture() {
    const Eigen::Vector3d pose = any(0.1, 0.2), velocity = any(1.0, 3.0);
    return Posture(*robot, pose, velocity);
  }

  RandomGenerator random;
  std::shared_ptr<const PlanarRrr> robot = planar_rig(RigFriction::test_rig);
  TaskLevelSettings settings{.inverse = {},
                             .free_damping = 20.0,
                             .velocity_feedforward = 1.0,
                             .velocity_gain = 60.0,
                             .largest_acceleration = 1e9,
                             .largest_torque = 1e9};
};

}  // namespace flinch::test
