#pragma once

#include <array>

#include "systems/safety/plausibility_tick.h"

namespace flinch {

/// Drive angles against what mass allows: how their rates change from tick to tick, less what the drives do.
/// A contact lasts for milliseconds and never turns round within one; a sensor knows no such bound.
struct AngleMonitor {
  std::array<JointVector, 4> angle{};  ///< the latest last [rad]
  std::array<double, 4> interval{};    ///< before each [s]
  Time acquired{};
  int readings = 0;                       ///< in a row without a gap, at most 4
  std::array<JointVector, 3> residual{};  ///< unexplained changes of rate, the latest last [rad/s]
  int residuals = 0;                      ///< in a row, at most 3
  LearnedNoise change{};                  ///< of a change of rate [rad/s]
  std::array<int, max_dof> quiet{};       ///< ticks without noise

  /// Standard deviation of an angle [rad].
  double angle_noise(Eigen::Index drive, const PlausibilityTick& tick) const noexcept;
  /// Whether an angle has so much noise that it would be missed.
  bool is_noisy(Eigen::Index drive, const PlausibilityTick& tick) const noexcept;
  /// Rates over the last two intervals [rad/s]; empty without them.
  JointVector rates() const noexcept;
  /// How the rates have changed at the last reading beyond what the drives do [rad/s]; empty: not known.
  JointVector unexplained() const noexcept { return residuals > 0 ? residual.back() : JointVector(); }
  /// Between the readings that tell them [s].
  double mean_interval() const noexcept { return 0.5 * (interval[3] + interval[2]); }
  /// The instant to which they belong.
  Time rates_at() const noexcept;
};

/// The watch after a tick. `torque`: of the two ticks before, mean [Nm]; empty: not known.
void advance(AngleMonitor& watch, const PlausibilityTick& tick, const JointVector& torque,
             Plausibility& found) noexcept;

}  // namespace flinch
