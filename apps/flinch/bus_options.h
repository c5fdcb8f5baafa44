#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace flinch {

/// Where a verb finds the bus, and how urgent it is there.
struct BusOptions {
  std::uint32_t domain = 0;
  std::string interface = "lo";
  std::vector<std::string> peers;
  std::filesystem::path security;   ///< folder of keys; empty: without
  std::string robot;                ///< name of the served one, or which one to command
  bool anyone_may_command = false;  ///< see BusSettings
  int priority = 80;                ///< SCHED_FIFO of loop and bus, where permitted; 0: not wanted
  bool lockstep = false;            ///< the simulated robot waits for its controller
  bool real_time = false;           ///< it does not; neither of both: whatever fits
};

}  // namespace flinch
