#pragma once

#include <array>

#include "systems/safety/angle_monitor.h"
#include "systems/safety/ring.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// Where the drives are at a tick, and what was commanded at the tick before.
struct DrivenTick {
  Padded<max_dof> angle;   ///< [rad]
  Padded<max_dof> torque;  ///< [Nm]
};

/// What should rest, and what should move: brakes, stops, drives.
struct RestMonitor {
  using Driven = Ring<DrivenTick, 32>;

  GateStatus gate{};  ///< of the tick before
  Time engaged{};     ///< since when the brakes have been told to close
  bool engage = true;
  std::array<double, 6> energy{};  ///< kinetic, a ring [J]
  std::size_t energies = 0;        ///< since the controlled stop began
  Time blind{};                    ///< since when nobody can tell whether it slows the robot down
  int unled = 0;                   ///< ticks in a row in which gravity has not led it
  Time unled_at{};                 ///< when it had not been led for a while
  Driven driven;                   ///< ticks in a row with drives that obey
  JointVector torque;              ///< commanded at the tick before [Nm]; empty: none
};

void advance(RestMonitor& watch, const RestMonitor::Driven::Past& past, const AngleMonitor& angles,
             const PlausibilityTick& tick, Plausibility& found) noexcept;

/// Notes at the end of a tick what the gate has done.
void remember(RestMonitor& watch, Time now, const GateStatus& gate, bool engage,
              const TorqueCommand& torque) noexcept;

}  // namespace flinch
