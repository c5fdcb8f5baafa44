#pragma once

#include <vector>

#include "plant/position_wave.h"

namespace flinch {

/// How the torque of a motor depends on its position: magnets and teeth attract each other without any
/// current (cogging), and a current makes more torque here than there (torque ripple). `Wave` says by what
/// the position is told.
template <class Wave>
struct TorqueRippleBy {
  std::vector<Wave> cogging{};  ///< Whose sum it is [Nm or N].
  Wave ripple{};                ///< A share of the torque.

  /// What acts at `position` where an even motor would make `torque`.
  template <class Position>
  double at(const Position& position, double torque) const noexcept {
    double sum = torque * (1.0 + ripple.at(position));
    for (const Wave& wave : cogging) sum += wave.at(position);
    return sum;
  }
};

using TorqueRipple = TorqueRippleBy<PositionHarmonic>;

}  // namespace flinch
