#include "plant/applied_wrench.h"

#include <algorithm>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

bool lasts(const WrenchRamp& ramp) { return ramp.rise >= 0s && ramp.hold >= 0s && ramp.fall >= 0s; }

}  // namespace

PlatformVector WrenchRamp::at(Time now) const {
  const Time top = start + rise;
  const Time descent = top + hold;
  const Time end = descent + fall;
  if (now < start || now >= end) return PlatformVector::Zero(peak_in_base.size());
  if (now < top) return to_seconds(now - start) / to_seconds(rise) * peak_in_base;
  if (now < descent) return peak_in_base;
  return to_seconds(end - now) / to_seconds(fall) * peak_in_base;
}

AppliedWrenchScript::AppliedWrenchScript(std::vector<WrenchRamp> ramps) : ramps_(std::move(ramps)) {
  if (!std::all_of(ramps_.begin(), ramps_.end(), lasts)) {
    throw SetupError("an applied wrench has a negative rise, hold or fall; durations must not be negative");
  }
  const auto differs = [&](const WrenchRamp& ramp) {
    return ramp.peak_in_base.size() != ramps_.front().peak_in_base.size();
  };
  if (std::any_of(ramps_.begin(), ramps_.end(), differs)) {
    throw SetupError("applied wrenches have different numbers of entries");
  }
}

AppliedWrench AppliedWrenchScript::read(Time now) const {
  AppliedWrench sum;
  if (!ramps_.empty()) sum.wrench_in_base.setZero(ramps_.front().peak_in_base.size());
  for (const WrenchRamp& ramp : ramps_) sum.wrench_in_base += ramp.at(now);
  return sum;
}

}  // namespace flinch
