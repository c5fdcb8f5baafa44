#pragma once

#include <cstdint>

namespace flinch {

/// What an end of the bus goes by. Both ends of a link go by the same.
enum class Pace : std::uint8_t {
  real_time,  ///< by the clock: a tick that is late is lost
  /// By the other end: a simulated robot moves on by one tick when it has the command for it, a controller
  /// when it has the readings of the next one. Stamps are times of the simulation.
  lockstep,
};

}  // namespace flinch
