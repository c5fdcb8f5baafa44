#include "calibration/chi_square_quantile.h"

#include <cmath>

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
  double low = 0.0, high = 1.0;
  while (1.0 - above(high, degrees) < probability) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (1.0 - above(middle, degrees) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace flinch
