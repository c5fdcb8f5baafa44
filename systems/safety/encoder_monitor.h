#pragma once

#include <array>
#include <optional>

#include "systems/framework/time.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// What could be known when a drive's encoder began to say the same angle, to the last bit, in every reading.
struct EncoderStandstill {
  Time since{};                   ///< acquisition of the first of these readings
  std::optional<double> current;  ///< of the drive, since its brake opened [A]
  JointVector mismatch;           ///< as EncoderMonitor::mismatch
};

/// What the drives' encoders have said lately, and what contradicts them: the memory behind the faults of
/// jumping and of frozen encoders.
struct EncoderMonitor {
  Time acquired{};       ///< of the last reading
  Time interval{};       ///< between the last two
  JointVector angle;     ///< of the last one; empty before the first [rad]
  JointVector step;      ///< by which the tick's reading differs from the one before; empty without one [rad]
  JointVector current;   ///< that drives the robot at this tick; empty: none known, or braked [A]
  JointVector mismatch;  ///< passive angles minus those that the active ones imply; empty: not known [rad]
  std::array<EncoderStandstill, max_dof> standstill;

  /// For how long a drive's encoder has said what it says, by the readings' acquisition.
  Time repeated(Eigen::Index drive) const;
  /// By how much the passive encoders have left what the active ones imply meanwhile [rad].
  double unseen_motion(Eigen::Index drive) const;
  /// By how much the drive's current has changed meanwhile [A].
  double unseen_current(Eigen::Index drive) const;
};

/// What a tick tells about the encoders.
struct EncoderTick {
  const ParallelRobot& robot;
  const JointReading& joints;
  const PlatformMotion& platform;  ///< from these joints
  const Kinematics& kinematics;    ///< of that platform
  const DriveReading& drives;
  bool braked;  ///< then no current moves the robot
};

/// Passive angles minus those that the active ones imply [rad]; empty: not known. `kinematics` is that of the
/// `platform`, as far as there is one.
JointVector passive_mismatch(const ParallelRobot& robot, const JointReading& joints,
                             const PlatformMotion& platform, const Kinematics& kinematics) noexcept;

/// The watch after a tick. Readings that are not valid, of another size, not finite, or not newer than the
/// last are passed over.
void advance(EncoderMonitor& watch, const EncoderTick& tick) noexcept;

}  // namespace flinch
