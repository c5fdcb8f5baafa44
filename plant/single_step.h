#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "systems/framework/integrator.h"

namespace flinch {

/// Coefficients of an explicit Runge-Kutta method with an error estimate.
struct ButcherTable {
  std::vector<std::vector<double>> A;  ///< of each stage, those of the stages before it
  std::vector<double> b;               ///< of the solution
  std::vector<double> c;               ///< instants of the stages, in steps
  std::vector<double> error;           ///< of the solution less the embedded one
};

/// One step of such a method over a whole tick, which mostly is accurate enough.
class SingleStep {
 public:
  SingleStep(const ButcherTable& table, std::size_t size);

  int stages() const { return static_cast<int>(stages_.size()); }

  /// Evaluates all stages of a step of `duration` [s] from `y`. Never allocates.
  void take(DifferentialEquation& equation, double duration, std::span<const double> y);
  /// Estimated errors of the step just taken, each times its weight: their root mean square.
  double error(std::span<const double> weights);
  /// y at its end.
  void write(std::span<double> y) const;
  /// The rates of the stage at `t` and `y`, if the step just taken has evaluated them; otherwise empty.
  std::span<const double> known_rates(double t, std::span<const double> y) const;

 private:
  struct Stage {
    double t = 0.0;
    std::vector<double> y, rates;
  };
  /// start + duration * sum over k of coefficients[k] rates_k.
  void combine(std::span<const double> coefficients, const std::vector<double>& start,
               std::span<double> result) const;

  ButcherTable table_;
  double duration_ = 0.0;
  std::vector<Stage> stages_;
  std::vector<double> zero_, errors_;
};

}  // namespace flinch
