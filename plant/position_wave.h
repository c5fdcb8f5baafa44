#pragma once

#include <cmath>

namespace flinch {

/// What repeats along the position q of a joint: amplitude * sin(rate * q + phase).
struct PositionHarmonic {
  double amplitude = 0.0;
  double rate = 0.0;   ///< Of the phase along the position [rad/rad], of a joint that slides [rad/m].
  double phase = 0.0;  ///< At position zero [rad].

  double at(double position) const noexcept {
    return amplitude == 0.0 ? 0.0 : amplitude * std::sin(rate * position + phase);
  }
};

}  // namespace flinch
