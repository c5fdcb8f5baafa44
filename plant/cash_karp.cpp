#include "plant/cash_karp.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr int fallback_steps = 200;
constexpr double caution = 0.9;  // of the step that would just reach the tolerance
constexpr double least_factor = 0.1, most_factor = 5.0;

// The tableau of Cash and Karp: where each stage lies, and what it is made of.
constexpr double c[] = {0.0, 1.0 / 5, 3.0 / 10, 3.0 / 5, 1.0, 7.0 / 8};
constexpr double a[][5] = {{},
                           {1.0 / 5},
                           {3.0 / 40, 9.0 / 40},
                           {3.0 / 10, -9.0 / 10, 6.0 / 5},
                           {-11.0 / 54, 5.0 / 2, -70.0 / 27, 35.0 / 27},
                           {1631.0 / 55296, 175.0 / 512, 575.0 / 13824, 44275.0 / 110592, 253.0 / 4096}};
constexpr double fifth[] = {37.0 / 378, 0.0, 250.0 / 621, 125.0 / 594, 0.0, 512.0 / 1771};
constexpr double fourth[] = {2825.0 / 27648, 0.0, 18575.0 / 48384, 13525.0 / 55296, 277.0 / 14336, 1.0 / 4};

std::vector<std::string> problems(const CashKarpOptions& options) {
  Findings found;
  found.positive("relative_tolerance", options.relative_tolerance);
  found.positive("absolute_tolerance", options.absolute_tolerance);
  found.positive("max_steps", options.max_steps);
  return found.take();
}

/// The next step over the one that had this error, as a multiple of the tolerance: the error of the embedded
/// method grows with the fifth power of the step. An error that is no number asks for the smallest.
double step_factor(double error) {
  if (!(error > 0.0)) return error == 0.0 ? most_factor : least_factor;
  return std::clamp(caution * std::pow(error, -0.2), least_factor, most_factor);
}

}  // namespace

CashKarp::CashKarp(const CashKarpOptions& options) : options_(options), fallback_(fallback_steps) {
  throw_if_any(problems(options));
}

void CashKarp::prepare(std::size_t size) {
  y_.assign(size, 0.0);
  next_.assign(size, 0.0);
  for (std::vector<double>& rates : rates_) rates.assign(size, 0.0);
  fallback_.prepare(size);
  evaluations_ = 0;
}

bool CashKarp::advance(DifferentialEquation& equation, double duration, std::span<double> y) {
  std::copy(y.begin(), y.end(), y_.begin());
  if (y.empty()) return true;
  if (!advance_adaptively(equation, duration)) {
    fallback_.advance(equation, duration, y);
    return false;
  }
  std::copy(y_.begin(), y_.end(), y.begin());
  return true;
}

bool CashKarp::advance_adaptively(DifferentialEquation& equation, double duration) {
  double t = 0.0, longest = duration;
  evaluate(equation, t, y_, 0);
  for (int tries = 0; tries < options_.max_steps; ++tries) {
    const double steps = std::ceil((duration - t) / longest);  // of equal length, to the end
    const double h = (duration - t) / steps;
    const double error = try_step(equation, t, h);
    longest = h * step_factor(error);
    if (!(error <= 1.0)) continue;
    y_.swap(next_);
    if (steps <= 1.0) return true;
    t += h;
    evaluate(equation, t, y_, 0);
  }
  return false;
}

/// Computes `next_` from `y_` and its rates. Returns the error as a multiple of the tolerance.
double CashKarp::try_step(DifferentialEquation& equation, double t, double h) {
  const std::size_t size = y_.size();
  for (std::size_t stage = 1; stage < stages; ++stage) {
    for (std::size_t i = 0; i < size; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < stage; ++k) sum += a[stage][k] * rates_[k][i];
      next_[i] = y_[i] + h * sum;
    }
    evaluate(equation, t + c[stage] * h, next_, stage);
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < stages; ++k) {
      sum += fifth[k] * rates_[k][i];
      difference += (fifth[k] - fourth[k]) * rates_[k][i];
    }
    next_[i] = y_[i] + h * sum;
    const double error =
        h * difference / (options_.relative_tolerance * std::abs(y_[i]) + options_.absolute_tolerance);
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(size));
}

void CashKarp::evaluate(DifferentialEquation& equation, double t, const std::vector<double>& y,
                        std::size_t stage) {
  equation.rates(t, y, rates_[stage]);
  ++evaluations_;
}

}  // namespace flinch
