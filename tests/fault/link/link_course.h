#pragma once

#include <cstdint>
#include <functional>

#include "tests/fault/link/link_latency.h"

namespace flinch::test {

/// How a robot that obeys a session has gone on.
struct Course {
  std::uint32_t ticks = 0;
  std::uint32_t braked = 0;     ///< ticks with closed brakes
  std::uint32_t silent = 0;     ///< ticks that obeyed nobody
  std::uint32_t by_others = 0;  ///< ticks that obeyed another session
  std::uint32_t backwards = 0;  ///< ticks that obeyed an older command than the tick before
  std::uint32_t refused = 0;    ///< commands
  Time lateness{};              ///< of robot or commander, as in Latency

  bool is_undisturbed() const { return braked == 0 && silent == 0 && backwards == 0; }
};

/// Who commands now; 0 for nobody.
std::uint32_t present_commander(const BusLog& log);

/// The identity of the robot that tells its status.
std::uint64_t present_robot(const BusLog& log);

/// Since `begin`.
Course course(const BusLog& log, const LogEnd& begin, std::uint32_t session);

/// Expects that a robot in motion goes on undisturbed and obeys nobody else. A trial in which the machine was
/// late by a tick is no evidence: it is told, and made again, twice at most. Throws TooBusy where it was late
/// each time.
void expect_undisturbed(const std::function<Course()>& trial);

}  // namespace flinch::test
