#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "plant/bench_dynamics.h"
#include "plant/sundials_integrator.h"
#include "tests/plant/integrate_bench.h"

namespace flinch::test {

/// A bench, integrated tick by tick as the plant does: each tick with the chart and the candidates of its
/// start.
class MovingBench {
 public:
  explicit MovingBench(const BenchSettings& settings, const SundialsOptions& options = {})
      : bench(BenchDynamics::make(settings)), equation(*bench), integrator_(options) {
    y.assign(equation.size(), 0.0);
    const BenchState start = bench->initial_state();
    std::copy_n(start.data(), start.size(), y.begin());
    equation.drives.braked = false;
    equation.drives.torque.setZero(bench->robot().drives());
    integrator_.prepare(y.size());
    look();
  }

  BenchState state() const {
    return Eigen::Map<const Eigen::VectorXd>(y.data(), bench->initial_state().size());
  }

  void tick(double duration = 1e-3) {
    BenchStep next;
    bench->next_step(state(), time_, now, equation.step, next);
    time_ += duration;
    equation.step = next;
    ASSERT_TRUE(integrator_.advance(equation, duration, y));
    look();
  }

  /// Work of drives, applied wrench, gravity and contacts, less that lost to friction [J].
  double work() const {
    const auto works = std::span(y).last(BenchEquation::works);
    return works[0] + works[1] + works[2] - works[3];
  }

  std::unique_ptr<const BenchDynamics> bench;
  BenchEquation equation;
  std::vector<double> y;
  BenchSnapshot now;

 private:
  void look() {
    bench->snapshot(state(), equation.drives, equation.applied_wrench, equation.step, 1e-3, now);
  }

  SundialsIntegrator integrator_;
  double time_ = 0.0;
};

}  // namespace flinch::test
