#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "plant/hunt_crossley.h"
#include "plant/pylon.h"
#include "systems/robot/planar_rrr_parameters.h"

namespace flinch {

/// Dry friction that closed brakes put on the drives' axes: -torque tanh(rate / velocity).
struct BrakeFriction {
  double torque = 150.0;   ///< [Nm]
  double velocity = 0.02;  ///< [rad/s]
};

/// The simulated bench as a mechanism. Its robot need not be the one that a controller believes in.
struct BenchSettings {
  PlanarRrrParameters robot;
  std::optional<Eigen::Vector3d> initial_pose;      ///< The robot's home pose where not given [m, m, rad].
  Eigen::Vector3d initial_velocity{0.0, 0.0, 0.0};  ///< [m/s, m/s, rad/s]
  std::optional<Pylon> pylon;
  /// How the robot's own bodies touch; nothing: they pass through one another.
  std::optional<ContactMaterial> link_material = ContactMaterial{.stiffness = 5e4};
  BrakeFriction brake;
};

/// All that is wrong with `settings` besides the robot's parameters, one sentence each.
std::vector<std::string> problems(const BenchSettings& settings);

}  // namespace flinch
