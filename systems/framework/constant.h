#pragma once

#include <utility>

#include "systems/framework/system.h"

namespace flinch {

/// Always the same value.
template <PortValue T>
class Constant final : public System {
 public:
  explicit Constant(T constant) : constant_(std::move(constant)) {}

  OutputPort<T> value = System::output<&Constant::read>("value");

 private:
  void read(T& value_out) const { value_out = constant_; }

  T constant_;
};

}  // namespace flinch
