#include "plant/single_step.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flinch {

SingleStep::SingleStep(const ButcherTable& table, std::size_t size)
    : table_(table),
      stages_(table.b.size(), {.t = 0.0, .y = std::vector<double>(size), .rates = std::vector<double>(size)}),
      zero_(size),
      errors_(size) {}

void SingleStep::take(DifferentialEquation& equation, double duration, std::span<const double> y) {
  duration_ = duration;
  std::copy(y.begin(), y.end(), stages_.front().y.begin());
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    Stage& stage = stages_[i];
    stage.t = table_.c[i] * duration;
    if (i > 0) combine(table_.A[i], stages_.front().y, stage.y);
    equation.rates(stage.t, stage.y, stage.rates);
  }
}

double SingleStep::error(std::span<const double> weights) {
  combine(table_.error, zero_, errors_);
  double sum = 0.0;
  for (std::size_t i = 0; i < errors_.size(); ++i)
    sum += (errors_[i] * weights[i]) * (errors_[i] * weights[i]);
  return std::sqrt(sum / static_cast<double>(errors_.size()));
}

void SingleStep::write(std::span<double> y) const { combine(table_.b, stages_.front().y, y); }

std::span<const double> SingleStep::known_rates(double t, std::span<const double> y) const {
  for (const Stage& stage : stages_) {
    if (stage.t == t && std::equal(y.begin(), y.end(), stage.y.begin())) return stage.rates;
  }
  return {};
}

// As many numbers at once as robots with 3 coordinates have states, so that their sums stay in registers.
void SingleStep::combine(std::span<const double> coefficients, const std::vector<double>& start,
                         std::span<double> result) const {
  const auto add_up = [&]<std::size_t together>(std::size_t first, std::array<double, together> sum) {
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      const double factor = duration_ * coefficients[k];
      const double* const rates = stages_[k].rates.data() + first;
      for (std::size_t i = 0; i < together; ++i) sum[i] += factor * rates[i];
    }
    for (std::size_t i = 0; i < together; ++i) result[first + i] = sum[i] + start[first + i];
  };
  std::size_t done = 0;
  for (; done + 6 <= result.size(); done += 6) add_up(done, std::array<double, 6>{});
  for (; done < result.size(); ++done) add_up(done, std::array<double, 1>{});
}

}  // namespace flinch
