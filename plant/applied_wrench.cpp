#include "plant/applied_wrench.h"

#include <algorithm>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

bool lasts(const WrenchRamp& ramp) { return ramp.rise >= 0s && ramp.hold >= 0s && ramp.fall >= 0s; }

}  // namespace

Eigen::Vector3d WrenchRamp::at(Time now) const {
  const Time top = start + rise;
  const Time descent = top + hold;
  const Time end = descent + fall;
  if (now < start || now >= end) return Eigen::Vector3d::Zero();
  if (now < top) return to_seconds(now - start) / to_seconds(rise) * peak_in_base;
  if (now < descent) return peak_in_base;
  return to_seconds(end - now) / to_seconds(fall) * peak_in_base;
}

AppliedWrenchScript::AppliedWrenchScript(std::vector<WrenchRamp> ramps) : ramps_(std::move(ramps)) {
  if (!std::all_of(ramps_.begin(), ramps_.end(), lasts)) {
    throw SetupError("an applied wrench has a negative rise, hold or fall; durations must not be negative");
  }
}

AppliedWrench AppliedWrenchScript::read(Time now) const {
  AppliedWrench sum;
  for (const WrenchRamp& ramp : ramps_) sum.wrench_in_base += ramp.at(now);
  return sum;
}

}  // namespace flinch
