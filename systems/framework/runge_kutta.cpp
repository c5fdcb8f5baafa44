#include "systems/framework/runge_kutta.h"

namespace flinch {

void RungeKutta::prepare(std::size_t size) {
  for (auto* stage : {&k1_, &k2_, &k3_, &k4_, &at_}) stage->assign(size, 0.0);
}

bool RungeKutta::advance(DifferentialEquation& equation, double duration, std::span<double> y) {
  const double h = duration / steps_;
  for (int i = 0; i < steps_; ++i) step(equation, i * h, h, y);
  return true;
}

void RungeKutta::step(DifferentialEquation& equation, double t, double h, std::span<double> y) {
  const auto towards = [&](const std::vector<double>& k, double length) {
    for (std::size_t i = 0; i < y.size(); ++i) at_[i] = y[i] + length * k[i];
    return std::span<const double>(at_);
  };
  equation.rates(t, y, k1_);
  equation.rates(t + h / 2, towards(k1_, h / 2), k2_);
  equation.rates(t + h / 2, towards(k2_, h / 2), k3_);
  equation.rates(t + h, towards(k3_, h), k4_);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (k1_[i] + 2 * k2_[i] + 2 * k3_[i] + k4_[i]);
}

}  // namespace flinch
