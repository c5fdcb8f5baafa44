#pragma once

#include <atomic>
#include <string>
#include <string_view>

namespace flinch {

/// What Cyclone DDS tells of itself. Of packets that are none it writes a line each, with their bytes:
/// whoever reaches the bus could fill terminals and disks with that.
class BusLog {
 public:
  /// The lines that are to be shown for a message; empty: none. The first few malformed packets are told in
  /// one short line each, then how many there were, at 10, 100, 1000, ... of them. Any thread may call it.
  std::string shown(std::string_view message);

 private:
  std::atomic<long> malformed_ = 0;
};

/// From now on what Cyclone DDS tells this program goes to stderr by a BusLog.
void tell_bus_log();

}  // namespace flinch
