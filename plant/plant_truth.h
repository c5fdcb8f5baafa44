#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// What the simulated robot really does. No control block reads it.
struct PlantTruth {
  Time acquired{};
  bool valid = false;       ///< All legs reach the pose. Otherwise the robot has come apart and stands still.
  Configuration pose;       ///< x, in the base frame
  PlatformVector velocity;  ///< v
  PlatformVector acceleration;  ///< [m/s^2, m/s^2, rad/s^2]
  JointVector active;           ///< q_a [rad]
  JointVector passive;          ///< q_p [rad]
  JointVector coupling;         ///< q_c [rad]
  JointVector motors;           ///< Their positions, of elastic drives; empty: those of the legs, q_a [rad].
  JointVector drive_torque;     ///< tau_a that acts, without the brakes' [Nm]
  /// F_ext: all that acts from outside, contacts and applied wrench.
  PlatformVector wrench_in_base;
  /// Largest coordinate by which a leg, followed along its links, misses its joint on the platform
  /// [m].
  double loop_closure_error = 0.0;
  double kinetic_energy = 0.0;  ///< [J]

  /// What encoders on the motors would tell.
  const JointVector& motor_positions() const noexcept { return motors.size() > 0 ? motors : active; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("pose", "<pose>", self.pose, "base");
    visit("velocity", "<velocity>", self.velocity, "base");
    visit("acceleration", "<acceleration>", self.acceleration, "base");
    visit("active", "<drive position>", self.active);
    visit("passive", "<passive position>", self.passive);
    visit("coupling", "<passive position>", self.coupling);
    visit("motors", "<drive position>", self.motors);
    visit("drive_torque", "<drive force>", self.drive_torque);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
    visit("loop_closure_error", "m", self.loop_closure_error);
    visit("kinetic_energy", "J", self.kinetic_energy);
  }
};

}  // namespace flinch
