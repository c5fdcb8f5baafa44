#pragma once

#include <cmath>
#include <numbers>

namespace flinch {

/// The angle of the same direction in (-pi, pi] [rad].
inline double wrap_angle(double angle) noexcept {
  constexpr double pi = std::numbers::pi;
  if (angle > -pi && angle <= pi) return angle;
  if (angle > pi && angle < 3.0 * pi) return angle - 2.0 * pi;  // without rounding, as by remainder()
  if (angle < -pi && angle > -3.0 * pi) return angle + 2.0 * pi;
  const double wrapped = std::remainder(angle, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

}  // namespace flinch
