#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "systems/framework/integrator.h"
#include "systems/framework/runge_kutta.h"

namespace flinch {

/// How CashKarp integrates. The error of a step is kept below relative * |y_i| + absolute in the root mean
/// square over the states.
struct CashKarpOptions {
  // A tenth of the error of 1e-8 and 1e-9 for one right-hand side in twenty more.
  double relative_tolerance = 1e-9;
  double absolute_tolerance = 1e-10;  ///< In the units of the states.
  int max_steps = 10000;              ///< Within one tick, those included that are tried again.
};

/// Explicit Runge-Kutta method of fifth order with six stages and an embedded one of fourth order, by which
/// it chooses its steps (Cash and Karp 1990). Every tick starts afresh with one step of its whole length, so
/// that the result depends on nothing but y.
class CashKarp final : public Integrator {
 public:
  /// Throws SetupError for tolerances or steps that are not positive.
  explicit CashKarp(const CashKarpOptions& options = {});

  void prepare(std::size_t size) override;

  /// Where the tolerance cannot be reached within `max_steps`, returns false and has integrated the tick with
  /// many small fixed steps instead.
  bool advance(DifferentialEquation& equation, double duration, std::span<double> y) override;

  /// Right-hand sides evaluated since prepare().
  std::int64_t evaluations() const { return evaluations_; }

 private:
  static constexpr std::size_t stages = 6;

  bool advance_adaptively(DifferentialEquation& equation, double duration);
  double try_step(DifferentialEquation& equation, double t, double h);
  void evaluate(DifferentialEquation& equation, double t, const std::vector<double>& y, std::size_t stage);

  CashKarpOptions options_;
  std::vector<double> y_, next_;
  std::array<std::vector<double>, stages> rates_;
  std::int64_t evaluations_ = 0;
  RungeKutta fallback_;
};

}  // namespace flinch
