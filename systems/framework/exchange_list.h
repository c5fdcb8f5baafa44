#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "systems/framework/exchange.h"

namespace flinch {

/// Several exchanges as one, in the order given: for a diagram that talks to a robot and shows what it does.
class ExchangeList final : public Exchange {
 public:
  /// All must outlive this.
  explicit ExchangeList(std::vector<std::reference_wrapper<Exchange>> exchanges)
      : exchanges_(std::move(exchanges)) {}

  void set_inputs(Context& context) override {
    for (Exchange& exchange : exchanges_) exchange.set_inputs(context);
  }
  void take_outputs(const Context& context) override {
    for (Exchange& exchange : exchanges_) exchange.take_outputs(context);
  }

 private:
  std::vector<std::reference_wrapper<Exchange>> exchanges_;
};

}  // namespace flinch
