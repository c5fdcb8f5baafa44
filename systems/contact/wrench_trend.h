#pragma once

#include "systems/framework/system.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Tells what an estimated wrench F has changed by of late, F - s with s' = (F - s) / T: about as much as an
/// estimate that follows with the time constant T is behind what it estimates. (Derived.)
class WrenchTrend final : public System {
 public:
  /// `over`: T. Throws SetupError where it is not positive.
  explicit WrenchTrend(Time over);

  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");

 private:
  struct Slow {
    Time acquired{};
    PlatformVector wrench_in_base;  ///< s; empty before the first estimate
  };
  State<Slow> slow_ = state<Slow>("slow");

 public:
  /// Only the wrench of it; not valid at the first estimate of a series.
  OutputPort<WrenchEstimate> change = output<&WrenchTrend::compare>("change", wrench, slow_);

 private:
  Update follow_ = update<&WrenchTrend::follow>(slow_, wrench);

  WrenchEstimate compare(const WrenchEstimate& estimate, const Slow& slow) const;
  void follow(const WrenchEstimate& estimate, Slow& slow) const;

  Time over_;
};

}  // namespace flinch
