#include "systems/robot/drive_parameters.h"

#include <algorithm>
#include <cmath>

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

WholeAndRest in_intervals(double delay, double interval) noexcept {
  const double whole = std::clamp(std::ceil(delay / interval - 1e-9) - 1.0, 0.0, most_delayed - 1.0);
  return {static_cast<std::size_t>(whole), delay - whole * interval};
}

}  // namespace flinch
