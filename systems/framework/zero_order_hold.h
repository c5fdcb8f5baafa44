#pragma once

#include "systems/framework/system.h"

namespace flinch {

/// Holds what it reads at a tick: continuous states see that value until the next one; discrete blocks see it
/// one tick later. This breaks an algebraic loop.
template <PortValue T>
class ZeroOrderHold final : public System {
  State<T> value_;

 public:
  explicit ZeroOrderHold(T initial = T{}) : value_(this->template state<T>("held", std::move(initial))) {
    held = this->template output<&ZeroOrderHold::read>("held", value_);
    this->keep(value_, input);
  }

  InputPort<T> input = System::input<T>("input");
  OutputPort<T> held;

 private:
  void read(const T& value, T& held_value) const { held_value = value; }
};

}  // namespace flinch
