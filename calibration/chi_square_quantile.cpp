#include "calibration/chi_square_quantile.h"

#include <cmath>

#include "systems/foundation/bisection.h"

namespace flinch {
namespace {

/// How often it is above x: by steps of two degrees from erfc(sqrt(x / 2)) of one and exp(-x / 2) of two.
double above(double x, int degrees) {
  const bool is_odd = degrees % 2 == 1;
  double sum = is_odd ? std::erfc(std::sqrt(x / 2.0)) : std::exp(-x / 2.0);
  for (int n = is_odd ? 1 : 2; n < degrees; n += 2)
    sum += std::exp(0.5 * n * std::log(x / 2.0) - x / 2.0 - std::lgamma(0.5 * n + 1.0));
  return sum;
}

}  // namespace

double chi_square_quantile(int degrees, double probability) {
  const auto missing = [=](double x) { return probability - (1.0 - above(x, degrees)); };
  double high = 1.0;
  while (missing(high) > 0.0) high *= 2.0;
  return bisect(missing, 0.0, high);
}

}  // namespace flinch
