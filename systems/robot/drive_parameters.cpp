#include "systems/robot/drive_parameters.h"

#include "systems/robot/mechanism.h"

namespace flinch {

// The torque rate is what a blend over 10 ms from one end of the torque range to the other needs.
DriveParameters default_drives(DriveKind kind, int drives) {
  if (kind == DriveKind::revolute)
    return {.torque_constant = JointVector::Constant(drives, 6.1)};  // [ICRA23] III-B
  return {.torque_constant = JointVector::Constant(drives, 100.0),
          .max_torque = 500.0,
          .max_torque_rate = 100e3,
          .max_torque_jump = 200.0,
          .max_speed = 2.0,
          .max_encoder_rate = 3.0,
          .max_control_error = 0.05};
}

}  // namespace flinch
