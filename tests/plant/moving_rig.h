#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "plant/rig_dynamics.h"
#include "plant/sundials_integrator.h"
#include "tests/plant/integrate_rig.h"

namespace flinch::test {

/// A rig, integrated tick by tick as the plant does: each tick with the chart and the candidates of its
/// start.
class MovingRig {
 public:
  explicit MovingRig(const RigSettings& settings, const SundialsOptions& options = {})
      : rig(RigDynamics::make(settings)), equation(*rig), integrator_(options) {
    y.assign(equation.size(), 0.0);
    const RigState start = rig->initial_state();
    std::copy_n(start.data(), start.size(), y.begin());
    equation.drives.braked = false;
    equation.drives.torque.setZero(rig->robot().drives());
    integrator_.prepare(y.size());
    look();
  }

  RigState state() const { return Eigen::Map<const Eigen::VectorXd>(y.data(), rig->initial_state().size()); }

  void tick(double duration = 1e-3) {
    RigStep next;
    rig->next_step(state(), time_, now, equation.step, next);
    time_ += duration;
    equation.step = next;
    ASSERT_TRUE(integrator_.advance(equation, duration, y));
    look();
  }

  /// Work of drives, applied wrench, gravity and contacts, less that lost to friction [J].
  double work() const {
    const auto works = std::span(y).last(RigEquation::works);
    return works[0] + works[1] + works[2] - works[3];
  }

  std::unique_ptr<const RigDynamics> rig;
  RigEquation equation;
  std::vector<double> y;
  RigSnapshot now;

 private:
  void look() { rig->snapshot(state(), equation.drives, equation.applied_wrench, equation.step, 1e-3, now); }

  SundialsIntegrator integrator_;
  double time_ = 0.0;
};

}  // namespace flinch::test
