#include "systems/safety/plausibility_limits.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/findings.h"
#include "systems/signals/sampling.h"

namespace flinch {

std::vector<std::string> problems(const PlausibilityLimits& limits, int drives) {
  Findings found("plausibility.");
  found.positive("drive_acceleration", limits.drive_acceleration, "rad/s^2");
  found.positive("jump", limits.jump);
  found.positive("isolated", limits.isolated);
  found.positive("pair", limits.pair);
  found.positive("inertial", limits.inertial);
  found.positive("parity", limits.parity, "rad");
  found.positive("current", limits.current, "A");
  found.positive("current_noise", limits.current_noise);
  found.not_negative("current_scale", limits.current_scale);
  found.positive("still_torque", limits.still_torque, "Nm");
  found.positive("resting_rate", limits.resting_rate, "rad/s");
  found.require(limits.quiet_ticks > 0, "quiet_ticks must be positive");
  found.require(limits.torque_constant.size() == 0 || limits.torque_constant.size() == drives,
                "torque_constant must have one entry for each drive");
  return found.take();
}

QuietRow quiet_row(const PlausibilityLimits& limits, Time look) noexcept {
  constexpr int fewest = 4;
  const int most = limits.quiet_ticks;
  const int looks = std::min(most, periods_in(most * 1ms, look, fewest));
  return {looks, looks == most ? limits.quiet : std::pow(limits.quiet, static_cast<double>(most) / looks)};
}

}  // namespace flinch
