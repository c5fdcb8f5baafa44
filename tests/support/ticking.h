#pragma once

#include <memory>

#include "systems/framework/context.h"
#include "systems/framework/diagram_builder.h"

namespace flinch::test {

/// A diagram of discrete blocks that is run by hand: set inputs, tick, look at outputs. A copy goes on from
/// the same tick by itself.
class Ticking {
 public:
  explicit Ticking(DiagramBuilder& builder) : diagram_(builder.build()), context_(diagram_->make_context()) {}

  /// The time of the next tick.
  Time now() const { return context_.time(); }

  template <class T>
  void set(InputPort<T> input, const T& value) {
    context_.set(input, value);
  }

  /// As the last tick saw it.
  template <class Port>
  const typename Port::Value& get(Port port) const {
    return context_.get(port);
  }

  void tick() {
    diagram_->evaluate(context_);
    diagram_->update(context_);
    context_.set_time(context_.time() + diagram_->tick());
  }

 private:
  std::shared_ptr<const Diagram> diagram_;
  Context context_;
};

}  // namespace flinch::test
