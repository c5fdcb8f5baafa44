#pragma once

#include <span>

namespace flinch {

/// The right-hand side of an ordinary differential equation: y' = f(t, y).
class DifferentialEquation {
 public:
  virtual ~DifferentialEquation() = default;
  /// Writes the rates of `y` at the time `t` [s since the start of the step]. Not to be called from two
  /// threads.
  virtual void rates(double t, std::span<const double> y, std::span<double> rates) = 0;
};

/// A method that integrates over one step, between the ticks of a diagram.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Called once before the first step, with the number of states: the place to allocate.
  virtual void prepare(std::size_t size) = 0;
  /// Replaces y(0) by y(duration) [s]. The right-hand side is smooth inside the step, and other than in the
  /// step before: nothing may be kept. Never allocates. Returns whether the method's own accuracy was
  /// reached.
  virtual bool advance(DifferentialEquation& equation, double duration, std::span<double> y) = 0;
};

}  // namespace flinch
