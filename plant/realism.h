#pragma once

#include <cstdint>
#include <optional>

#include "systems/robot/drive_parameters.h"

namespace flinch {

/// How far robots that are built alike may be off their model: the largest sizes from which one robot is
/// drawn, see `draw_perturbed_robot`. Zero: it is as the model says.
struct Realism {
  std::optional<std::uint64_t> seed{};  ///< Of the robot that is drawn; none: that of the run.

  // ---- mechanics
  double friction = 0.0;  ///< Of each drive and passive joint, a share either way.
  /// Of the dry friction of each drive, which then sticks: from a twentieth of this up [Nm/rad or N/m].
  double friction_stiffness = 0.0;
  double leg_inertia = 0.0;       ///< Of each leg's masses and moments of inertia, a share either way.
  double platform_inertia = 0.0;  ///< Likewise, of the platform.
  double payload = 0.0;           ///< Point mass at the platform's origin that nobody knows of [kg].

  // ---- drives
  /// Of springs between motors and legs, once to twice this [Nm/rad or N/m]; 0: motors and legs are one.
  double drive_stiffness = 0.0;
  double drive_damping = 0.02;   ///< Its ratio.
  double backlash = 0.0;         ///< Of each drive, up to this [rad or m].
  double rotor_inertia = 0.0;    ///< Of each motor [kg m^2 or kg]; 0: a fifth of what it moves at home.
  double torque_constant = 0.0;  ///< Of each motor against the calibrated one, a share either way.
  double cogging = 0.0;          ///< Amplitude, a share of the largest torque of the drives.
  int cogging_periods = 24;      ///< Of a turn of the motor.
  int cogging_harmonics = 1;     ///< Of these waves; the k-th has k times the periods and a k-th of the size.
  double torque_ripple = 0.0;    ///< Amplitude, a share of the torque.
  int torque_ripple_periods = 66;  ///< Of a turn of the motor.
  double current_lag = 0.0;        ///< Time constant with which a current follows its command [s].
  double screw_lead = 5e-3;        ///< Way of a drive that slides in a turn of its motor [m].

  // ---- encoders
  double active_encoder_wave = 0.0;     ///< Amplitude of an error once a turn of the motor [rad or m].
  double passive_encoder_wave = 0.0;    ///< Amplitude of an error once a turn [rad].
  double passive_encoder_offset = 0.0;  ///< Constant error, either way [rad].
};

/// Sizes as of a rig that was built and calibrated with care; docs/theory.md has their sources.
Realism rig_realism(DriveKind drives);

/// The same with friction as models have it, which creeps.
Realism kind_realism(DriveKind drives);

}  // namespace flinch
