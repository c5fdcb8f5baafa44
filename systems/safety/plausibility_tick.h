#pragma once

#include <cmath>

#include "systems/framework/time.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/parallel_robot.h"
#include "systems/safety/plausibility_limits.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/plausibility.h"
#include "systems/signals/sampling.h"

namespace flinch {

/// What a tick tells those who look for contradictions.
struct PlausibilityTick {
  const ParallelRobot& robot;
  const PlausibilityLimits& limits;
  const MountedImu& mounted;  ///< by the limits' mount
  Time now;
  Time period;  ///< since the tick before at which anybody looked
  const JointReading& joints;
  const DriveReading& drives;
  const DriveTorque& torque;
  const ImuReading& imu;
  const PlatformMotion& platform;  ///< from these joints
  const Kinematics& kinematics;
  const Dynamics& dynamics;
  bool held;  ///< the brakes are closed
  bool free;  ///< they have been open for some ticks, and the drives obey

  // NOLINTNEXTLINE(readability-identifier-naming): as in the equations
  double T() const noexcept { return to_seconds(period); }
  /// How many looks there are in `time`, at least `least`.
  int looks(Time time, int least = 1) const noexcept { return periods_in(time, period, least); }
};

/// A vector with zeros below what it has: many of one size are copied at once.
template <int most>
using Padded = Eigen::Matrix<double, most, 1>;

template <int most>
Padded<most> padded(const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1>& vector) noexcept {
  Padded<most> whole = Padded<most>::Zero();
  whole.head(vector.size()) = vector;
  return whole;
}

/// What a sensor says while nothing moves, so much as there is of it.
struct LearnedNoise {
  static constexpr int enough = 50;
  static constexpr int most = 200;
  int count = 0;
  JointVector squares{};     ///< their sum
  JointVector deviations{};  ///< by that: standard deviations

  void add(const JointVector& value) noexcept {
    if (count >= most) return;
    if (count == 0) squares.setZero(value.size());
    squares += value.cwiseAbs2();
    ++count;
    deviations = (squares / count).cwiseSqrt();
  }
  bool known() const noexcept { return count >= enough; }
  /// Standard deviation of one of them, at least `least`.
  double deviation(Eigen::Index i, double least) const noexcept;
};

inline double LearnedNoise::deviation(Eigen::Index i, double least) const noexcept {
  if (!known() || i >= deviations.size()) return least;
  return deviations[i] > least ? deviations[i] : least;
}

/// Puts `value` over its limit where it is the largest so far, and names the drive where that makes a fault.
inline void note(Plausibility& found, PlausibilityCheck check, double ratio, GateFault fault,
                 int drive = -1) noexcept {
  if (ratio > found.of(check)) found.of(check) = ratio;
  if (!(ratio > 1.0)) return;
  if (found.present == 0) found.drive = drive;
  found.present |= fault_bit(fault);
}

}  // namespace flinch
