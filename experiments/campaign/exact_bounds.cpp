#include "experiments/campaign/exact_bounds.h"

#include <cmath>
#include <limits>

#include "systems/foundation/bisection.h"

namespace flinch {
namespace {

double poisson_at_most(std::size_t events, double mean) {
  double sum = 0.0;
  for (std::size_t k = 0; k <= events; ++k) {
    const double count = static_cast<double>(k);
    sum += std::exp(count * std::log(mean) - mean - std::lgamma(count + 1.0));
  }
  return sum;
}

double binomial_exactly(std::size_t events, std::size_t trials, double share) {
  const double n = static_cast<double>(trials), k = static_cast<double>(events);
  const double ways = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
  return std::exp(ways + k * std::log(share) + (n - k) * std::log1p(-share));
}

double binomial_at_most(std::size_t events, std::size_t trials, double share) {
  double sum = 0.0;
  for (std::size_t k = 0; k <= events; ++k) sum += binomial_exactly(k, trials, share);
  return sum;
}

}  // namespace

double garwood_upper(std::size_t events, double exposure, double confidence) {
  if (exposure <= 0.0) return std::numeric_limits<double>::infinity();
  const double count = static_cast<double>(events);
  const double highest = 10.0 * (count + 10.0) * (1.0 - std::log(1.0 - confidence));
  const auto likelier = [=](double mean) { return poisson_at_most(events, mean) - (1.0 - confidence); };
  return bisect(likelier, 0.0, highest) / exposure;
}

double lower_rate(std::size_t events, double exposure, double confidence) {
  return events == 0 ? 0.0 : garwood_upper(events - 1, exposure, 1.0 - confidence);
}

double clopper_pearson_upper(std::size_t events, std::size_t trials, double confidence) {
  if (events >= trials) return 1.0;
  const auto likelier = [=](double share) {
    return binomial_at_most(events, trials, share) - (1.0 - confidence);
  };
  return bisect(likelier, 0.0, 1.0);
}

double confidence_below(std::size_t events, std::size_t trials, double share) {
  return events >= trials ? 0.0 : 1.0 - binomial_at_most(events, trials, share);
}

std::optional<std::size_t> tolerated_events(std::size_t trials, double share, double confidence) {
  std::optional<std::size_t> tolerated;
  for (std::size_t events = 0; confidence_below(events, trials, share) >= confidence; ++events)
    tolerated = events;
  return tolerated;
}

RankBounds ranks_around_quantile(std::size_t count, double share, double confidence) {
  const double beyond = 0.5 * (1.0 - confidence);
  RankBounds bounds;
  double chance = 0.0;  // that at most `below` values lie below the quantile
  for (std::size_t below = 0; below < count; ++below) {
    chance += binomial_exactly(below, count, share);
    if (chance <= beyond) bounds.lower = below + 1;
    if (chance >= 1.0 - beyond && !bounds.upper) bounds.upper = below + 1;
  }
  return bounds;
}

std::size_t trials_without_event(double share, double confidence) {
  std::size_t trials = 1;
  while (!tolerated_events(trials, share, confidence)) ++trials;
  return trials;
}

}  // namespace flinch
