#include "calibration/error_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flinch {
namespace {

constexpr int iterations = 400;
constexpr double least_share = 1e-6;  // of the mean square that is noise at least
// Of a torque: its constant is known better. Errors as large as torques would hide every contact, for a
// contact is such a torque.
constexpr double most_of_torque = 0.2;
constexpr std::size_t torque_feature = 3;

/// The variances, as shares of which begins each part with as much as the others.
ErrorFeatures first_guess(std::span<const ErrorSample> samples) {
  double squared = 0.0;
  ErrorFeatures sum{};
  for (const ErrorSample& sample : samples) {
    squared += sample.squared;
    for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += sample.features[j];
  }
  ErrorFeatures guess{};
  for (std::size_t j = 0; j < sum.size(); ++j)
    guess[j] = sum[j] > 0.0 ? squared / (static_cast<double>(sum.size()) * sum[j]) : 0.0;
  return guess;
}

double variance(const ErrorFeatures& sizes, const ErrorSample& sample) {
  double sum = sample.known;
  for (std::size_t j = 0; j < sizes.size(); ++j) sum += sizes[j] * sample.features[j];
  return sum;
}

}  // namespace

/// Maximises the likelihood of v = known + sum of theta_j phi_j by multiplicative steps, which keep theta
/// positive and never lessen it (Fevotte and Idier 2011):
///   theta_j <- theta_j sqrt(sum(phi_j e^2 / v^2) / sum(phi_j / v))
ResidualErrors fit_error_sizes(std::span<const ErrorSample> samples) {
  ErrorFeatures sizes = first_guess(samples);
  const double least = least_share * static_cast<double>(sizes.size()) * sizes[0];
  for (int i = 0; i < iterations; ++i) {
    ErrorFeatures seen{}, expected{};
    for (const ErrorSample& sample : samples) {
      const double v = variance(sizes, sample);
      for (std::size_t j = 0; j < sizes.size(); ++j) {
        seen[j] += sample.features[j] * sample.squared / (v * v);
        expected[j] += sample.features[j] / v;
      }
    }
    for (std::size_t j = 0; j < sizes.size(); ++j)
      sizes[j] = expected[j] > 0.0 ? sizes[j] * std::sqrt(seen[j] / expected[j]) : 0.0;
    sizes[0] = std::max(sizes[0], least);
    sizes[torque_feature] = std::min(sizes[torque_feature], most_of_torque * most_of_torque);
  }
  return {.noise = std::sqrt(sizes[0]),
          .speed = std::sqrt(sizes[1]),
          .load = std::sqrt(sizes[2]),
          .torque = std::sqrt(sizes[3]),
          .friction = std::sqrt(sizes[4]),
          .lag = std::sqrt(sizes[5]),
          .rest = std::sqrt(sizes[6]),
          .acceleration = std::sqrt(sizes[7]),
          .turning = std::sqrt(sizes[8])};
}

}  // namespace flinch
