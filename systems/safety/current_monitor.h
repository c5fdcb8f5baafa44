#pragma once

#include <array>

#include "systems/safety/plausibility_tick.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// Motor currents against their commands: both are inside the cabinet, and no contact comes between them.
struct CurrentMonitor {
  std::array<JointVector, 6> commanded{};  ///< currents, the latest last; empty: none
  std::array<JointVector, 4> measured{};   ///< the latest last [A]
  Time acquired{};
  int readings = 0;                                      ///< in a row, at most 4
  LearnedNoise noise{};                                  ///< of a current [A]
  LearnedNoise third{};                                  ///< of its third difference [A]
  std::array<std::array<double, 2>, max_dof> outside{};  ///< how far, in its limit, at the two ticks before
  std::array<int, max_dof> quiet{};

  /// Whether a current has so much noise that it would be missed.
  bool is_noisy(Eigen::Index drive, const PlausibilityTick& tick) const noexcept;
};

void advance(CurrentMonitor& watch, const PlausibilityTick& tick, Plausibility& found) noexcept;

/// Notes what is commanded at the end of a tick.
void command(CurrentMonitor& watch, const PlausibilityLimits& limits, const TorqueCommand& torque) noexcept;

}  // namespace flinch
