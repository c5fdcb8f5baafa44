#pragma once

#include <array>

#include "systems/safety/plausibility_tick.h"

namespace flinch {

/// What each drive makes of its torque: the torques that would explain the motion besides those of the
/// drives, "foreign" ones, against the torque of this drive. A drive of gain k leaves k - 1 times its own
/// torque, at every instant alike, and nothing at the others. What is pressed against its link may look like
/// that, but gives back less energy than it took, and like a drive of the wrong sign (k = -1) never for long.
struct ResponseMonitor {
  static constexpr std::size_t parts = 5, window = 20;  ///< of the looks that it takes in; the most of them

  /// One entry per drive.
  struct Tick {
    Padded<max_dof> torque = Padded<max_dof>::Zero();  ///< tau_i [Nm or N]
    Padded<max_dof> own = Padded<max_dof>::Zero();     ///< square of what 1 - k would leave of it everywhere
    Padded<max_dof> shared = Padded<max_dof>::Zero();  ///< the same times the foreign torques
    Padded<max_dof> given = Padded<max_dof>::Zero();   ///< what takes the place of tau_i gives [W]
    double foreign = 0.0;                              ///< square of the foreign torques
  };

  Padded<max_dof> foreign = Padded<max_dof>::Zero();   ///< low-passed [Nm or N]
  Padded<max_dof> torque = Padded<max_dof>::Zero();    ///< likewise [Nm or N]
  Padded<max_dof> rates = Padded<max_dof>::Zero();     ///< likewise [rad/s or m/s]
  Padded<max_dof> measured = Padded<max_dof>::Zero();  ///< torque at the reading before [Nm or N]
  double net = 0.0;                    ///< energy that the robot lately got by foreign torques [J]
  std::array<Tick, window> ticks{};    ///< a ring
  std::array<int, max_dof> strange{};  ///< ticks in a row with much of a foreign torque
  std::array<int, max_dof> turned{};   ///< ticks in a row like those of a torque of the wrong sign
  std::size_t count = 0;               ///< in a row
};

/// The watch after a tick. `unexplained`: change of the drives' rates since the reading before, less what
/// `torque` makes of them [rad/s or m/s], over `interval` [s]; empty: not known. `rates`: of the drives.
void advance(ResponseMonitor& watch, const JointVector& unexplained, double interval,
             const JointVector& torque, const JointVector& rates, const PlausibilityTick& tick,
             Plausibility& found) noexcept;

}  // namespace flinch
