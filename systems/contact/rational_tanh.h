#pragma once

#include <algorithm>

namespace flinch {

/// tanh(x), within 6e-11 of its value and never beyond -1 or 1; NaN for NaN. Compilers do it for
/// several numbers at once, all with the same bits.
/// tanh(x / 2) is p / q, the continued fraction of Lambert (1768) down to its ninth term, and
/// tanh(x) = 2 p q / (p^2 + q^2). From 12.5 on tanh is 1 within 3e-11, and so is what it is here.
inline double rational_tanh(double x) noexcept {
  const double half = 0.5 * std::min(std::max(x, -12.5), 12.5), s = half * half;
  const double p = half * ((((s + 990.0) * s + 135135.0) * s + 4729725.0) * s + 34459425.0);
  const double q = (((45.0 * s + 13860.0) * s + 945945.0) * s + 16216200.0) * s + 34459425.0;
  return 2.0 * p * q / (p * p + q * q);
}

}  // namespace flinch
