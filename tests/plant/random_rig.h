#pragma once

#include <random>

#include "systems/robot/planar_rrr.h"
#include "tests/plant/rig_scene.h"

namespace flinch::test {

/// The rig in random, reachable states.
class RandomRig {
 public:
  explicit RandomRig(std::uint64_t seed, RigFriction friction = RigFriction::none)
      : shared(individual_rig(friction)), robot(*shared), random_(seed) {}

  const std::shared_ptr<const PlanarRrr> shared;
  const PlanarRrr& robot;

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  Eigen::Vector2d point(double half_width) {
    const double x = uniform(-half_width, half_width);
    const double y = uniform(-half_width, half_width);
    return {x, y};
  }

  Eigen::Vector3d velocity() {
    const Eigen::Vector2d translation = point(1.5);
    return {translation.x(), translation.y(), uniform(-3.0, 3.0)};
  }

  Eigen::Vector3d pose() {
    while (true) {
      const Eigen::Vector2d position = point(0.35);
      const Eigen::Vector3d pose(position.x(), position.y(), uniform(-0.6, 0.6));
      if (robot.motion(pose, Eigen::Vector3d::Zero()).reachable) return pose;
    }
  }

  PlanarMotion motion() {
    const Eigen::Vector3d at = pose();
    return robot.motion(at, velocity());
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace flinch::test
