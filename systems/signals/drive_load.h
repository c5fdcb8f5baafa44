#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"
#include "systems/signals/friction_interval.h"

namespace flinch {

/// How the drives work at one instant, as encoders, currents and model tell it; one entry a drive. What the
/// errors of an estimated contact grow with.
struct DriveLoad {
  Time acquired{};
  bool valid = false;
  JointVector rate;                  ///< [rad/s or m/s]
  JointVector torque;                ///< tau_a, not filtered [Nm or N]
  JointVector friction;              ///< of all joints, as the drives feel it: J_x_qa^T F_fr_x [Nm or N]
  FrictionInterval friction_bounds;  ///< of what dry friction near rest may do; zero while a drive slides
  /// Length of the drive's row of J_x_qa^T M_x J_x_qa: drives whose accelerations err independently, by a
  /// deviation of 1, err by so much in their torques [kg m^2 or kg]
  JointVector inertia;
  /// What the angular acceleration of the platform, as the drives make it, takes of the drive [Nm or N]
  JointVector turning;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("rate", "<drive velocity>", self.rate);
    visit("torque", "<drive force>", self.torque);
    visit("friction", "<drive force>", self.friction);
    visit("friction_low", "<drive force>", self.friction_bounds.low);
    visit("friction_high", "<drive force>", self.friction_bounds.high);
    visit("inertia", "<drive inertia>", self.inertia);
    visit("turning", "<drive force>", self.turning);
  }
};

}  // namespace flinch
