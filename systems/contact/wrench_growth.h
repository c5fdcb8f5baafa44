#pragma once

#include <array>

#include "systems/framework/system.h"
#include "systems/signals/history.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// How an estimated wrench has come about: what of it is of the last `wrench_growth_step`, and what of the
/// one before. One contact in one place makes wrenches of one direction, whose size changes; where a second
/// contact joins it, as in a clamping, what is new has another direction than what was there.
inline constexpr Time wrench_growth_step = 5ms;

/// Tells the changes of an estimate during the last two steps, as estimates of their own. They are not valid
/// where nothing was estimated at their beginning, to within 1 ms, or since. (Derived.)
class WrenchGrowth final : public System {
 public:
  struct Estimated {
    Time acquired{};
    PlatformVector wrench;
  };
  using Past = History<Estimated, 16>;

 private:
  State<Past> past_ = state<Past>("past");

 public:
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  OutputPort<WrenchEstimate> change = output<&WrenchGrowth::latest>("change", wrench, past_);
  OutputPort<WrenchEstimate> change_before = output<&WrenchGrowth::before>("change_before", wrench, past_);

 private:
  Update remember_ = update<&WrenchGrowth::remember>(past_, wrench);

  void latest(const WrenchEstimate& now, const Past& past, WrenchEstimate& result) const;
  void before(const WrenchEstimate& now, const Past& past, WrenchEstimate& result) const;
  void remember(const WrenchEstimate& now, Past& past) const;
};

}  // namespace flinch
