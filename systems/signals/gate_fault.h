#pragma once

#include <cstdint>

namespace flinch {

/// Why the torque gate closes, from causes to consequences: where several come at once, the first is
/// reported.
enum class GateFault : std::uint8_t {
  none,
  loop_late,
  station_silent,
  station_fault,
  station_disabled,
  joints_invalid,
  joints_stale,
  encoder_jump,
  encoder_frozen,
  velocity_invalid,
  drives_invalid,
  drives_stale,
  forward_kinematics,
  encoders_implausible,
  type_1_singularity,
  type_2_singularity,
  workspace_radius,
  orientation,
  joint_range,
  joint_speed,
  self_collision,
  contact_unmonitored,
  control_error,
  command_invalid,
  command_stale,
  command_not_finite,
  torque_jump,
  operator_stop,
  touched_in_recovery,
  motion_contradicted,
  drive_not_following,
  drives_without_effect,
  stop_ineffective,
  brake_not_holding,
  status_contradicted,
  torque_contradicted,
};

/// What the torque gate does about a fault, in order of severity.
enum class GateReaction : std::uint8_t {
  none,
  controlled_stop,  ///< the torques of ControlledStop: the robot comes to rest and can be pushed by hand
  zero_torque_and_brake,  ///< no torque, brakes closed
};

/// A set of faults, one bit each: bit i stands for the fault with number i.
using FaultMask = std::uint64_t;

constexpr FaultMask fault_bit(GateFault fault) { return FaultMask{1} << static_cast<unsigned>(fault); }

/// Which faults are present at a tick.
struct FaultReport {
  bool valid = false;       ///< they have been looked for
  FaultMask present = 0;    ///< set of GateFault
  FaultMask tolerable = 0;  ///< those that, if present, a recovery bears now
  bool at_rest = false;     ///< every drive is known to be slower than FaultLimits::rest_speed

  bool none() const { return valid && present == 0; }
  FaultMask intolerable() const { return present & ~tolerable; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("present", "", self.present);
    visit("tolerable", "", self.tolerable);
    visit("at_rest", "", self.at_rest);
  }
};

}  // namespace flinch
