#pragma once

#include "systems/framework/system.h"

/// Small blocks to try the framework with.
namespace flinch::test {

/// Counts ticks.
class Counter final : public System {
  State<double> count_ = state<double>("count", 0.0);

 public:
  explicit Counter(double step = 1.0) : step_(step) {}
  OutputPort<double> count = output<&Counter::read>("count", count_);

 private:
  Update increment_ = update<&Counter::increment>(count_, count_);
  double read(double value) const { return value; }
  double increment(double value) const { return value + step_; }
  double step_;
};

/// out = factor * in.
class Gain final : public System {
 public:
  explicit Gain(double factor) : factor_(factor) {}
  InputPort<double> in = input<double>("in");
  OutputPort<double> out = output<&Gain::multiply>("out", in);

 private:
  double multiply(double value) const { return factor_ * value; }
  double factor_;
};

/// sum = a + b.
class Adder final : public System {
 public:
  InputPort<double> a = input<double>("a");
  InputPort<double> b = input<double>("b");
  OutputPort<double> sum = output<&Adder::add>("sum", a, b);

 private:
  double add(double left, double right) const { return left + right; }
};

/// One tick, or one period, of delay.
class Delay final : public System {
  State<double> held_ = state<double>("held", 0.0);

 public:
  explicit Delay(Every every = Every{1ms}) { keep(every, held_, in); }
  InputPort<double> in = input<double>("in");
  OutputPort<double> out = output<&Delay::read>("out", held_);

 private:
  double read(double held) const { return held; }
};

/// x' = rate * x + push.
class Decay final : public System {
  State<double> x_;

 public:
  Decay(double rate, double initial) : x_(state<double>("x", initial)), rate_(rate) {
    x = output<&Decay::read>("x", x_);
    derivative<&Decay::rate_of_change>(x_, x_, push);
  }
  InputPort<double> push = input<double>("push");
  OutputPort<double> x;

 private:
  double read(double value) const { return value; }
  double rate_of_change(double value, double pushed) const { return rate_ * value + pushed; }
  double rate_;
};

}  // namespace flinch::test
