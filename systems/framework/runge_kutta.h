#pragma once

#include <vector>

#include "systems/framework/integrator.h"

namespace flinch {

/// The classical Runge-Kutta method of fourth order with a fixed number of equal steps a tick.
class RungeKutta final : public Integrator {
 public:
  explicit RungeKutta(int steps_per_tick = 1) : steps_(steps_per_tick) {}

  void prepare(std::size_t size) override;
  bool advance(DifferentialEquation& equation, double duration, std::span<double> y) override;

 private:
  void step(DifferentialEquation& equation, double t, double h, std::span<double> y);

  int steps_;
  std::vector<double> k1_, k2_, k3_, k4_, at_;
};

}  // namespace flinch
