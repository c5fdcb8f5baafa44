#include "systems/contact/onset_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flinch {
namespace {

constexpr std::size_t longest = OnsetMemory::longest, order = AutoregressiveError::order;

using Course = std::array<double, longest>;

/// What `filters` of first order make of a step, `x` of their time constants after it:
/// 1 - exp(-x) (1 + x + x^2/2 + ...).
double step_behind_filters(int filters, double x) {
  double term = 1.0, sum = 0.0;
  for (int i = 0; i < filters; ++i) {
    sum += term;
    term *= x / (i + 1);
  }
  return 1.0 - std::exp(-x) * sum;
}

/// The change that a step shows as, from one sample after it on; its mean of late as in `track_residual`.
Course step_as_change(const ResidualTracking& tracking) {
  const double T = to_seconds(tracking.sampling.period);
  const double share = 1.0 - std::exp(-tracking.rate * T);
  Course change{};
  double mean = 0.0, time = 0.0;
  for (double& seen : change) {
    time += T;
    seen = step_behind_filters(tracking.answer.filters, tracking.answer.rate * time) - mean;
    mean += share * seen;
  }
  return change;
}

/// Onsets of which the last of so many samples tells.
std::size_t onsets(int samples) {
  const auto seen = static_cast<std::size_t>(samples);
  return seen > order ? std::min(seen - order, longest) : 0;
}

}  // namespace

OnsetRatio::OnsetRatio(const ResidualErrors& errors, const AutoregressiveError& course,
                       const ResidualTracking& tracking)
    : errors_(errors), course_(course), sampling_(tracking.sampling) {
  const Course step = step_as_change(tracking);
  double energy = 0.0;
  for (std::size_t t = 0; t < longest; ++t) {
    double unexpected = step[t];
    for (std::size_t j = 0; j < std::min(t, order); ++j) unexpected -= course.prediction[j] * step[t - 1 - j];
    signature_[t] = unexpected / course.innovation;
    energy_[t] = energy += signature_[t] * signature_[t];
  }
}

void OnsetRatio::follow(const ResidualSample& seen, const OnsetMemory& memory, OnsetMemory& next) const {
  next.samples = 0;
  if (!seen.settled) return;
  next = memory;
  if (!seen.is_new) return;
  const Time acquired = seen.load.acquired;
  const int before = sampling_.lost_between(memory.acquired, acquired) ? 0 : memory.samples;
  next.samples = std::min(before + 1, AutoregressiveError::order + OnsetMemory::longest);
  next.acquired = acquired;
  const JointVector z = whitened(seen.load, seen.change, errors_);
  if (onsets(next.samples) > 0) {
    JointVector e = z;
    for (std::size_t j = 0; j < order; ++j) e -= course_.prediction[j] * memory.before[j];
    e /= course_.innovation;
    next.matched[0] = signature_[0] * e;
    for (std::size_t k = 1; k < onsets(next.samples); ++k)
      next.matched[k] = memory.matched[k - 1] + signature_[k] * e;
  }
  next.before[0] = z;
  std::copy(memory.before.begin(), memory.before.end() - 1, next.before.begin() + 1);
}

double OnsetRatio::mahalanobis_distance(const OnsetMemory& memory) const {
  double largest = 0.0;
  for (std::size_t k = 0; k < onsets(memory.samples); ++k) {
    if (energy_[k] <= 0.0) continue;  // nothing of it would show yet
    const double twice_log_ratio = memory.matched[k].squaredNorm() / energy_[k];
    if (!std::isfinite(twice_log_ratio)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, twice_log_ratio);
  }
  return std::sqrt(largest);
}

}  // namespace flinch
