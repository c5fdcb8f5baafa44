#include "systems/contact/wrench_growth.h"

namespace flinch {
namespace {

constexpr Time tolerance = 1ms;

/// What was estimated at that time; null where that was more than `tolerance` before.
const PlatformVector* estimated_at(Time time, const WrenchGrowth::Past& past) {
  const WrenchGrowth::Estimated* const then = past.last_before(time + Time{1});
  return then != nullptr && time - then->acquired <= tolerance ? &then->wrench : nullptr;
}

/// Of the estimate from `first` to `last`, where both are known.
void set_change(const WrenchEstimate& now, const PlatformVector* first, const PlatformVector* last,
                WrenchEstimate& result) {
  result.acquired = now.acquired;
  result.valid = false;
  if (!now.valid || first == nullptr || last == nullptr || first->size() != last->size()) return;
  result.wrench_in_base = *last - *first;
  result.valid = true;
}

}  // namespace

void WrenchGrowth::latest(const WrenchEstimate& now, const Past& past, WrenchEstimate& result) const {
  set_change(now, estimated_at(now.acquired - wrench_growth_step, past), &now.wrench_in_base, result);
}

void WrenchGrowth::before(const WrenchEstimate& now, const Past& past, WrenchEstimate& result) const {
  set_change(now, estimated_at(now.acquired - 2 * wrench_growth_step, past),
             estimated_at(now.acquired - wrench_growth_step, past), result);
}

void WrenchGrowth::remember(const WrenchEstimate& now, Past& past) const {
  if (now.valid)
    past.push({now.acquired, now.wrench_in_base});
  else
    past = Past();
}

}  // namespace flinch
