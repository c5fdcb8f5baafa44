#pragma once

#include <optional>

#include "systems/framework/context.h"
#include "systems/framework/diagram.h"

namespace flinch {

/// Copies the value of a port of a running diagram where there is one.
template <class T>
class OptionalSlot {
 public:
  template <class Port>
  OptionalSlot(const Diagram& diagram, const std::optional<Port>& port) {
    if (port) slot_ = diagram.slot(*port);
  }

  /// Leaves `value` alone where there is no port.
  void copy(const Context& context, T& value) const noexcept {
    if (slot_) value = context[*slot_];
  }
  bool exists() const noexcept { return slot_.has_value(); }

 private:
  std::optional<Slot<T>> slot_;
};

}  // namespace flinch
