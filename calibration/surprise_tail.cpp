#include "calibration/surprise_tail.h"

#include <algorithm>
#include <cmath>

namespace flinch {

void SurpriseTail::add(double surprise, int drives) {
  if (!std::isfinite(surprise)) return;
  const double square = surprise * surprise;
  count_ += 1.0;
  squares_ += square;
  fourth_ += square * square;
  drives_ = drives;
}

/// E[chi^4] / E[chi^2]^2 is (n + 2) / n for chi-square of n degrees, and 1 + variation times that for a
/// variance that varies.
double SurpriseTail::variation() const {
  if (squares_ == 0.0) return 0.0;
  const double of_chi_square = 1.0 + 2.0 / drives_;
  return count_ * fourth_ / (squares_ * squares_) / of_chi_square - 1.0;
}

double SurpriseTail::power() const { return std::clamp(2.0 - 5.0 * variation(), 1.0, 2.0); }

}  // namespace flinch
