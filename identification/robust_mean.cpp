#include "identification/robust_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/foundation/median.h"

namespace flinch {
namespace {

constexpr double normal_over_median = 1.4826;

}  // namespace

double robust_deviation(const std::vector<double>& residuals) {
  std::vector<double> distances;
  for (const double r : residuals) distances.push_back(std::abs(r));
  return normal_over_median * median(std::move(distances));
}

RobustMean robust_mean(const Eigen::VectorXd& samples) {
  std::vector<double> values(samples.begin(), samples.end());
  const double middle = median(values);
  std::vector<double> distances;
  for (const double v : values) distances.push_back(v - middle);
  const double limit = 4.0 * robust_deviation(distances);
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const double d : distances) {
    if (std::abs(d) > limit) continue;
    sum += d;
    squares += d * d;
    count += 1.0;
  }
  if (count == 0.0) return {middle, std::numeric_limits<double>::quiet_NaN()};
  const double mean = sum / count;
  const double variance = std::max(0.0, squares / count - mean * mean);
  return {middle + mean, std::sqrt(variance / std::max(1.0, count - 1.0))};
}

}  // namespace flinch
