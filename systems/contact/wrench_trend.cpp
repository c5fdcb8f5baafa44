#include "systems/contact/wrench_trend.h"

#include <cmath>

#include "systems/foundation/setup_error.h"

namespace flinch {

WrenchTrend::WrenchTrend(Time over) : over_(over) {
  if (over <= Time{}) throw SetupError("wrench trend: the time constant must be positive");
}

WrenchEstimate WrenchTrend::compare(const WrenchEstimate& estimate, const Slow& slow) const {
  WrenchEstimate lately;
  lately.acquired = estimate.acquired;
  lately.valid = estimate.valid && slow.wrench_in_base.size() == estimate.wrench_in_base.size();
  if (lately.valid) lately.wrench_in_base = estimate.wrench_in_base - slow.wrench_in_base;
  return lately;
}

void WrenchTrend::follow(const WrenchEstimate& estimate, Slow& slow) const {
  if (!estimate.valid) {
    slow = Slow();
    return;
  }
  if (slow.wrench_in_base.size() != estimate.wrench_in_base.size()) {
    slow.wrench_in_base = estimate.wrench_in_base;
  } else {
    const double passed = to_seconds(estimate.acquired - slow.acquired) / to_seconds(over_);
    slow.wrench_in_base -= std::expm1(-passed) * (estimate.wrench_in_base - slow.wrench_in_base);
  }
  slow.acquired = estimate.acquired;
}

}  // namespace flinch
