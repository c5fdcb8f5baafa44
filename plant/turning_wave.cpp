#include "plant/turning_wave.h"

#include <cmath>

#include "systems/robot/planar_leg.h"

namespace flinch {

TurningHarmonic::TurningHarmonic(const PositionHarmonic& wave)
    : times_(static_cast<int>(wave.rate)), start_(wave.amplitude * unit_vector(wave.phase)) {}

// By squaring: each power c + i s of the direction whose number is in the rate turns the start, of which the
// imaginary part is wanted.
double TurningHarmonic::at(const Eigen::Vector2d& direction) const noexcept {
  double x = start_.x(), y = start_.y();
  double c = direction.x(), s = direction.y();
  for (int left = times_; left > 0; left /= 2) {
    if (left % 2 != 0) {
      const double turned = c * x - s * y;
      y = c * y + s * x;
      x = turned;
    }
    const double twice = c * c - s * s;
    s = 2.0 * c * s;
    c = twice;
  }
  return y;
}

bool repeats_each_turn(const PositionHarmonic& wave) {
  constexpr double most = 1000.0;  // above, rounding of the powers would be seen
  return wave.rate >= 0.0 && wave.rate <= most && wave.rate == std::floor(wave.rate);
}

}  // namespace flinch
