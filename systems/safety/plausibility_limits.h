#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/imu_mount.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Where a reading begins to contradict others. The defaults are those of the rig. Noise is learned while
/// the brakes hold the robot before it moves for the first time.
struct PlausibilityLimits {
  Time period = 1ms;  ///< from tick to tick of the control path
  /// What the largest torque gives the drive with the least inertia [rad/s^2]. A tenth of what it does in a
  /// tick counts as noise of a change of rate where less is measured.
  double drive_acceleration = 172.0;
  double jump = 5.0;        ///< change of a rate in one tick, in what `drive_acceleration` does meanwhile
  double isolated = 18.0;   ///< the same of one tick alone, in standard deviations of its noise
  double neighbours = 0.3;  ///< share of it that those before and after may have
  double pair = 8.0;        ///< of two changes there and back, in standard deviations
  double quiet = 0.03;      ///< share of its noise that is left of a signal which stands still
  int quiet_ticks = 8;      ///< such looks in a row, 1 ms apart; see `quiet_row`

  ImuMount imu_mount;
  Time stamp_spread{};            ///< width of the range in which stamps of the IMU err
  double inertial = 10.0;         ///< difference to the IMU, in standard deviations
  double gyroscope_scale = 0.03;  ///< share of the rate that may be missing
  /// By which encoders and IMU may be apart where the acceleration changes [s].
  double acceleration_time = 2e-3;
  double parity = 0.25 * std::numbers::pi / 180.0;  ///< of a passive encoder: its accuracy [rad]

  JointVector torque_constant{};  ///< by which the drives make a current of a torque; empty: not asked
  double current = 0.16;          ///< least difference between current and command [A]
  double current_noise = 8.0;     ///< the same in standard deviations
  double current_scale = 0.03;    ///< share of the current besides
  double still_torque = 10.0;     ///< change of a torque that must move something [Nm]
  double resting_rate = 0.1;      ///< of a drive that counts as held; by half of it, as at rest [rad/s]
  bool commands_act = true;       ///< what is commanded reaches the drives whose readings are seen
};

/// Looks in a row at which a signal is quiet, and the share of its noise that may be left: where looks are
/// rare a smaller share makes up for a shorter row, so that chance makes it as seldom. (Derived.)
struct QuietRow {
  int looks;
  double share;
};
QuietRow quiet_row(const PlausibilityLimits& limits, Time look) noexcept;

/// All that is wrong with `limits`, one sentence each.
std::vector<std::string> problems(const PlausibilityLimits& limits, int drives);

}  // namespace flinch
