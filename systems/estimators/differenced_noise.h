#pragma once

#include <cmath>

namespace flinch {

/// Standard deviation [1/s] of what a first-order low pass shows of the differences of white noise of
/// deviation 1, each over the time step `T` [s], of which it keeps the share `a` of its state. (Derived.)
inline double differenced_noise(double a, double T) { return (1.0 - a) * std::sqrt(2.0 / (1.0 + a)) / T; }

}  // namespace flinch
