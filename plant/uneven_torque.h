#pragma once

#include "plant/position_wave.h"

namespace flinch {

/// How the torque of a motor depends on its position: magnets and teeth attract each other without any
/// current (cogging), and a current makes more torque here than there (torque ripple).
struct UnevenTorque {
  PositionWave cogging;  ///< [Nm or N]
  PositionWave ripple;   ///< A share of the torque.

  /// What acts at `position` where an even motor would make `torque`.
  double at(double position, double torque) const noexcept {
    return torque * (1.0 + ripple.at(position)) + cogging.at(position);
  }
};

}  // namespace flinch
