#include "calibration/gumbel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "calibration/normal_quantile.h"

namespace flinch {
namespace {

/// y of x = location + scale y.
double reduced(double probability) { return -std::log(-std::log1p(-probability)); }

}  // namespace

double Gumbel::quantile_above(double probability) const { return location + scale * reduced(probability); }

double Gumbel::probability_above(double value) const {
  return -std::expm1(-std::exp(-(value - location) / scale));
}

Gumbel fit_gumbel(std::span<const double> maxima) {
  std::vector<double> sorted(maxima.begin(), maxima.end());
  std::sort(sorted.begin(), sorted.end());
  const double n = static_cast<double>(sorted.size());
  double mean = 0.0, weighted = 0.0;  // b_0, b_1
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    mean += sorted[i] / n;
    weighted += sorted[i] * static_cast<double>(i) / (n * (n - 1.0));
  }
  const double scale = (2.0 * weighted - mean) / std::numbers::ln2;
  return {.location = mean - std::numbers::egamma * scale, .scale = scale};
}

Gumbel fit_gumbel_to_quartiles(std::span<const double> maxima) {
  std::vector<double> sorted(maxima.begin(), maxima.end());
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&sorted](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  const double scale = (quantile(0.75) - quantile(0.25)) / (reduced(0.25) - reduced(0.75));
  return {.location = quantile(0.5) - reduced(0.5) * scale, .scale = scale};
}

double upper_quantile_above(const Gumbel& fit, std::size_t maxima, double probability, double confidence) {
  const double y = reduced(probability);
  const double variance = (1.1128 + 2.0 * 0.2287 * y + 0.8046 * y * y) / static_cast<double>(maxima);
  const double margin = normal_quantile(confidence) * std::sqrt(variance);
  // Far out it is the error of the scale, a factor, that counts.
  return fit.location + fit.scale * (y > 1.0 ? y * std::exp(margin / y) : y + margin);
}

}  // namespace flinch
