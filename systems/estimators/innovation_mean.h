#pragma once

#include <cmath>

namespace flinch {

/// Time over which innovations are averaged [s]: long enough for some twenty samples, short beside a contact.
inline constexpr double innovation_time = 0.02;

/// The innovation monitor: the mean of late of e^T S^-1 e / n, of which `square` is the newest e^T S^-1 e,
/// with `count` = n entries and `T` after the one before. It begins as 1, where it should be.
inline double innovation_mean(double before, double square, int count, double T) {
  return before + (1.0 - std::exp(-T / innovation_time)) * (square / count - before);
}

}  // namespace flinch
