#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plant/elastic_drives.h"
#include "plant/obstacle.h"
#include "plant/rope_pull.h"
#include "plant/torque_ripple.h"
#include "systems/robot/mechanism.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// As far as dry friction gives before it slides, of `effort / stiffness`.
inline constexpr double most_give = 3.0;

/// Dry friction that closed brakes put on the drives: -effort tanh(rate / velocity + way / give), where `way`
/// is that from where the brake has closed or last slid to, at most `most_give` times `give`. So it holds a
/// load without creeping, as a stiff spring does, and slides under more than its effort. Velocity and give
/// are larger on drives that move so little mass that they would swing or be damped faster than any
/// integrator follows.
struct BrakeFriction {
  double torque = 150.0;           ///< Of drives that turn [Nm].
  double velocity = 0.02;          ///< [rad/s]
  double give = 1e-4;              ///< [rad]
  double force = 2000.0;           ///< Of drives that slide [N].
  double sliding_velocity = 0.02;  ///< [m/s]
  double sliding_give = 5e-5;      ///< [m]
};

/// Dry friction that sticks, of a drive: -effort tanh(rate / velocity + stiffness way / effort), where `way`
/// is that from where it has stuck or last slid to, at most `most_give` times effort / stiffness. The effort
/// is that of the robot, whose friction it is in the place of; so a drive at rest holds a torque up to that
/// without creeping.
struct StickingFriction {
  JointVector stiffness;           ///< Of each drive [Nm/rad or N/m]; empty: friction is as the robot has it.
  double velocity = 1e-3;          ///< Of drives that turn [rad/s].
  double sliding_velocity = 1e-3;  ///< Of drives that slide [m/s].
};

/// The simulated rig as a mechanism. Its robot need not be the one that a controller believes in.
struct RigSettings {
  std::shared_ptr<const Mechanism> robot;
  std::optional<Configuration> initial_pose;  ///< The robot's home pose where not given.
  std::optional<PlatformVector> initial_velocity;
  Obstacles obstacles;
  /// How the robot's own bodies touch; nothing: they pass through one another.
  std::optional<ContactMaterial> link_material = ContactMaterial{.stiffness = 5e4};
  BrakeFriction brake;
  StickingFriction sticking;
  ElasticDrivesSettings elastic;
  std::vector<TorqueRipple> torque_ripple;  ///< Of each drive; empty: all are even.
  std::vector<RopePull> pulls;              ///< By ropes, besides all contacts.
};

/// All that is wrong with `settings`, one sentence each.
std::vector<std::string> problems(const RigSettings& settings);

}  // namespace flinch
