#include "calibration/normal_quantile.h"

#include <cmath>
#include <numbers>

#include "systems/foundation/bisection.h"

namespace flinch {

double normal_quantile(double probability) {
  return bisect([=](double x) { return probability - 0.5 * std::erfc(-x / std::numbers::sqrt2); }, -40.0,
                40.0);
}

}  // namespace flinch
