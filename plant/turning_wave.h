#pragma once

#include <Eigen/Core>

#include "plant/position_wave.h"

namespace flinch {

/// A wave along the position of a joint that turns, a whole number of times a turn, told by the joint's
/// direction instead of its angle: sin(n q + phase) from the n-th power of cos q + i sin q.
class TurningHarmonic {
 public:
  TurningHarmonic() = default;
  /// `wave` must be one that `repeats_each_turn`.
  explicit TurningHarmonic(const PositionHarmonic& wave);

  double at(const Eigen::Vector2d& direction) const noexcept;

 private:
  int times_ = 0;
  Eigen::Vector2d start_{0.0, 0.0};  ///< amplitude times the direction of the phase
};

/// Whether it is the same after a whole turn.
bool repeats_each_turn(const PositionHarmonic& wave);

}  // namespace flinch
