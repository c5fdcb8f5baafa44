#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plant/obstacle.h"
#include "plant/rope_pull.h"
#include "plant/uneven_torque.h"
#include "systems/robot/mechanism.h"

namespace flinch {

/// Dry friction that closed brakes put on the drives: -effort tanh(rate / velocity + way / give), where `way`
/// is that from where the brake has closed or last slid to, at most `most_give` times `give`. So it holds a
/// load without creeping, as a stiff spring does, and slides under more than its effort.
struct BrakeFriction {
  static constexpr double most_give = 3.0;

  double torque = 150.0;           ///< Of drives that turn [Nm].
  double velocity = 0.02;          ///< [rad/s]
  double give = 1e-4;              ///< [rad]
  double force = 2000.0;           ///< Of drives that slide [N].
  double sliding_velocity = 0.02;  ///< [m/s]
  double sliding_give = 5e-5;      ///< [m]
};

/// The simulated bench as a mechanism. Its robot need not be the one that a controller believes in.
struct BenchSettings {
  std::shared_ptr<const Mechanism> robot;
  std::optional<Configuration> initial_pose;  ///< The robot's home pose where not given.
  std::optional<PlatformVector> initial_velocity;
  Obstacles obstacles;
  /// How the robot's own bodies touch; nothing: they pass through one another.
  std::optional<ContactMaterial> link_material = ContactMaterial{.stiffness = 5e4};
  BrakeFriction brake;
  std::vector<UnevenTorque> uneven_torque;  ///< Of each drive; empty: all are even.
  std::vector<RopePull> pulls;              ///< By ropes, besides all contacts.
};

/// All that is wrong with `settings`, one sentence each.
std::vector<std::string> problems(const BenchSettings& settings);

}  // namespace flinch
