#include "experiments/campaign/exact_bounds.h"

#include <cmath>
#include <limits>

namespace flinch {
namespace {

/// Where a function that falls from above `level` to below it meets it.
template <class Function>
double solve_falling(double low, double high, double level, Function&& function) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double poisson_at_most(std::size_t events, double mean) {
  double sum = 0.0;
  for (std::size_t k = 0; k <= events; ++k) {
    const double count = static_cast<double>(k);
    sum += std::exp(count * std::log(mean) - mean - std::lgamma(count + 1.0));
  }
  return sum;
}

double binomial_at_most(std::size_t events, std::size_t trials, double share) {
  const double n = static_cast<double>(trials);
  double sum = 0.0;
  for (std::size_t k = 0; k <= events; ++k) {
    const double count = static_cast<double>(k);
    const double ways = std::lgamma(n + 1.0) - std::lgamma(count + 1.0) - std::lgamma(n - count + 1.0);
    sum += std::exp(ways + count * std::log(share) + (n - count) * std::log1p(-share));
  }
  return sum;
}

}  // namespace

double upper_rate(std::size_t events, double exposure, double confidence) {
  if (exposure <= 0.0) return std::numeric_limits<double>::infinity();
  const double count = static_cast<double>(events);
  const double highest = 10.0 * (count + 10.0) * (1.0 - std::log(1.0 - confidence));
  return solve_falling(0.0, highest, 1.0 - confidence,
                       [events](double mean) { return poisson_at_most(events, mean); }) /
         exposure;
}

double lower_rate(std::size_t events, double exposure, double confidence) {
  return events == 0 ? 0.0 : upper_rate(events - 1, exposure, 1.0 - confidence);
}

double upper_share(std::size_t events, std::size_t trials, double confidence) {
  if (events >= trials) return 1.0;
  return solve_falling(0.0, 1.0, 1.0 - confidence,
                       [=](double share) { return binomial_at_most(events, trials, share); });
}

}  // namespace flinch
