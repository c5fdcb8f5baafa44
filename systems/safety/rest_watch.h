#pragma once

#include <array>

#include "systems/safety/angle_watch.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// What should rest, and what should move: brakes, stops, drives.
struct RestWatch {
  GateStatus gate{};  ///< of the tick before
  Time engaged{};     ///< since when the brakes have been told to close
  bool engage = true;
  std::array<double, 6> energy{};            ///< kinetic, a ring [J]
  std::size_t energies = 0;                  ///< since the controlled stop began
  bool rested = false;                       ///< it has come to its end
  std::array<Padded<max_dof>, 32> angle{};   ///< a ring [rad]
  std::array<Padded<max_dof>, 32> torque{};  ///< a ring [Nm]
  std::size_t ticks = 0;                     ///< in a row with drives that obey
  Eigen::Index commanded = 0;                ///< torques at the tick before
};

void advance(RestWatch& watch, const AngleWatch& angles, const PlausibilityTick& tick,
             Plausibility& found) noexcept;

/// Notes at the end of a tick what the gate has done.
void remember(RestWatch& watch, Time now, const GateStatus& gate, bool engage,
              const TorqueCommand& torque) noexcept;

}  // namespace flinch
