#pragma once

#include <cstddef>
#include <numbers>

#include "systems/robot/cogging.h"
#include "systems/robot/vectors.h"

namespace flinch {

enum class DriveKind;

/// A torque that is further behind its current than this, or as far ahead, has another fault [s].
inline constexpr double longest_torque_delay = 1e-3;

/// A delay in intervals of a signal: so many whole ones, and the rest, which is one at most.
struct WholeAndRest {
  std::size_t whole = 0;
  double rest = 0.0;  ///< [s]
};
WholeAndRest in_intervals(double delay, double interval) noexcept;
/// How many whole intervals there are at most, in a loop of 4 kHz.
inline constexpr std::size_t most_delayed = 4;

/// What a robot's drives are given and may do. Units of a turning drive, of a sliding one in brackets.
struct DriveParameters {
  /// Torque of 1 A at each drive [Nm/A] ([N/A]).
  JointVector torque_constant;
  Cogging cogging{};  ///< As far as it is known [Nm] ([N]).
  /// By which the torque of each drive is behind its measured current [s]; empty: nothing is known.
  JointVector torque_delay{};
  double max_torque = 100.0;  ///< Of every drive [Nm] ([N]).
  /// Largest change of a drive's torque [Nm/s] ([N/s]).
  double max_torque_rate = 20e3;
  /// Largest change of a commanded torque in 1 ms, or from tick to tick where that is shorter [Nm] ([N]).
  double max_torque_jump = 40.0;
  double max_speed = 8.0;  ///< Of every drive [rad/s] ([m/s]).
  /// Largest speed between two readings that an encoder is believed [rad/s] ([m/s]).
  double max_encoder_rate = 12.0;
  /// Largest distance of a drive from where it should be [rad] ([m]).
  double max_control_error = 25.0 * std::numbers::pi / 180.0;
  /// By how much passive joints may have turned from where a drive's encoder says, when it repeats itself
  /// [rad].
  double max_unseen_motion = 0.25 * std::numbers::pi / 180.0;
};

/// For `drives` drives of one kind: turning ones as the rig has them, sliding ones as screws of a hexapod
/// of the size of a table have.
DriveParameters default_drives(DriveKind kind, int drives);

}  // namespace flinch
