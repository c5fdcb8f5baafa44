#pragma once

#include <array>

#include "systems/safety/plausibility_tick.h"

namespace flinch {

/// Passive encoders against the active ones: by how much they have left what these imply, since they agreed.
struct ParityMonitor {
  int learned = 0;
  JointVector offset{};                        ///< while the robot was held, mean [rad]
  std::array<Padded<max_dof>, 16> mismatch{};  ///< a ring [rad]
  std::size_t count = 0;

  bool knows_offset() const noexcept { return learned >= LearnedNoise::enough; }
};

void advance(ParityMonitor& watch, const PlausibilityTick& tick, Plausibility& found) noexcept;

}  // namespace flinch
