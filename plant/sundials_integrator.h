#pragma once

#include <cstdint>
#include <memory>

#include "systems/framework/integrator.h"

namespace flinch {

/// How SundialsIntegrator integrates. The error of a step is kept below relative * |y_i| + absolute in the
/// root mean square over the states.
struct SundialsOptions {
  /// Embedded explicit Runge-Kutta methods; both are of fifth order with an error estimate of fourth.
  enum class Tableau {
    cash_karp,       ///< Six stages; the more robust where forces begin inside a step.
    dormand_prince,  ///< Seven stages.
  };

  // A tenth of the error of 1e-8 and 1e-9 for one right-hand side in twenty more.
  double relative_tolerance = 1e-9;
  double absolute_tolerance = 1e-10;  ///< In the units of the states.
  Tableau tableau = Tableau::cash_karp;
  int max_steps = 10000;  ///< Within one tick.
};

/// Integrates with ARKODE's ERKStep of the SUNDIALS library: explicit Runge-Kutta with adaptive steps. Every
/// tick starts afresh with one step of its whole length, so that the result depends on nothing but y.
/// Each integrator has its own SUNDIALS context: use one a thread.
class SundialsIntegrator final : public Integrator {
 public:
  /// Throws SetupError for tolerances or steps that are not positive.
  explicit SundialsIntegrator(const SundialsOptions& options = {});
  ~SundialsIntegrator() override;

  /// Throws SetupError when SUNDIALS refuses.
  void prepare(std::size_t size) override;

  /// Where the tolerance cannot be reached within `max_steps`, returns false and has integrated the tick with
  /// many small fixed steps instead.
  bool advance(DifferentialEquation& equation, double duration, std::span<double> y) override;

  /// Right-hand sides evaluated since prepare().
  std::int64_t evaluations() const;

 private:
  class Solver;

  SundialsOptions options_;
  std::unique_ptr<Solver> solver_;
};

}  // namespace flinch
