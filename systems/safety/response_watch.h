#pragma once

#include <array>

#include "systems/safety/plausibility_tick.h"

namespace flinch {

/// What each drive makes of its torque: the motion that the torques do not explain, against the motion that
/// the torque of this drive should have made. A drive of gain k leaves k - 1 times its own share, along its
/// own column and at every instant alike. What is pressed against the link of a drive may look like that,
/// but gives back less energy than it took, and like a drive of the wrong sign (k = -1) never for long.
struct ResponseWatch {
  static constexpr std::size_t window = 20;  ///< [ticks]

  /// Sums of one tick over the drives' accelerations; a_i: what 1 Nm of drive i makes of them.
  struct Tick {
    Padded<max_dof> torque = Padded<max_dof>::Zero();  ///< tau_i [Nm or N]
    Padded<max_dof> own = Padded<max_dof>::Zero();     ///< (a_i tau_i)^2
    Padded<max_dof> shared = Padded<max_dof>::Zero();  ///< a_i tau_i times what is not explained
    Padded<max_dof> given = Padded<max_dof>::Zero();   ///< what takes the place of tau_i gives [W]
    double rest = 0.0;                                 ///< square of what is not explained
  };

  Padded<max_dof> unexplained = Padded<max_dof>::Zero();  ///< low-passed [rad/s^2 or m/s^2]
  Padded<max_dof> torque = Padded<max_dof>::Zero();       ///< likewise [Nm or N]
  Padded<max_dof> rates = Padded<max_dof>::Zero();        ///< likewise [rad/s or m/s]
  Padded<max_dof> measured = Padded<max_dof>::Zero();     ///< torque at the reading before [Nm or N]
  double net = 0.0;                    ///< energy that the robot lately got by what is not explained [J]
  std::array<Tick, window> ticks{};    ///< a ring
  std::array<int, max_dof> strange{};  ///< ticks in a row that leave much of a torque unexplained
  std::array<int, max_dof> turned{};   ///< ticks in a row like those of a torque of the wrong sign
  std::size_t count = 0;               ///< in a row
};

/// The watch after a tick. `unexplained`: change of the drives' rates since the reading before, less what
/// `torque` makes of them [rad/s or m/s], over `interval` [s]; empty: not known. `rates`: of the drives.
void advance(ResponseWatch& watch, const JointVector& unexplained, double interval, const JointVector& torque,
             const JointVector& rates, const PlausibilityTick& tick, Plausibility& found) noexcept;

}  // namespace flinch
