#pragma once

#include <atomic>
#include <string>
#include <string_view>

namespace flinch {

/// What Cyclone DDS tells of itself. Of packets that are none it writes a line each, with their bytes:
/// whoever reaches the bus could fill terminals and disks with that, and so could somebody whose keys are
/// refused.
class BusLog {
 public:
  /// The lines that are to be shown for a message; empty: none. The first few malformed packets are told in
  /// one short line each, then how many there were, at 10, 100, 1000, ... of them; of certificates that are
  /// refused the first, then likewise. Any thread may call it.
  std::string shown(std::string_view message);

  /// How often a certificate was refused. From any thread.
  long refused_certificates() const { return refused_certificates_; }

 private:
  std::string shown_packet(std::string_view line);
  std::string shown_refusal(std::string_view line);

  std::atomic<long> malformed_ = 0;
  std::atomic<long> refused_certificates_ = 0;
};

/// From now on what Cyclone DDS tells this program goes to stderr by a BusLog.
void tell_bus_log();

/// How often this program has refused the certificate of another since then.
long refused_certificates();

}  // namespace flinch
