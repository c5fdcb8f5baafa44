#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/bus_security.h"

namespace flinch {

/// Where the bus is.
struct BusSettings {
  std::uint32_t domain = 0;  ///< who shares the number shares the bus, 0 to 230
  /// Name or address of the network interface. What arrives at another one is not heard; "lo": nothing leaves
  /// the machine or comes from outside.
  std::string interface = "lo";
  std::vector<std::string> peers = {};  ///< addresses of the other ends where the network has no multicast
  int realtime_priority = 0;            ///< of the threads of the bus, SCHED_FIFO, 1 to 99; 0: as all threads
  std::optional<BusSecurity> security = {};  ///< without: whoever reaches the bus can read it and command
  bool anyone_may_command = false;           ///< on a network without keys, where it is refused otherwise
};

/// Programs that find room in one domain on one machine, of any kind: each has two ports of the 250 of its
/// domain, 7400 + 250 domain + 10 + 2 place and the next.
inline constexpr int programs_of_domain = 119;

/// All that is wrong with `settings`, one sentence each.
std::vector<std::string> problems(const BusSettings& settings);

/// What the user should know before going on, one sentence each: a bus that others can reach and command,
/// keys to care for.
std::vector<std::string> warnings(const BusSettings& settings);

/// The configuration of Cyclone DDS that makes this bus, in its XML.
std::string cyclone_configuration(const BusSettings& settings);

}  // namespace flinch
