#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/printing.h"

#include <fmt/core.h>

namespace flinch {

BusSettings bus_settings(const BusOptions& options, bool quiet, BusRole role) {
  const bool urgent = options.priority > 0 && permits_realtime(options.priority);
  BusSettings settings{.domain = options.domain,
                       .interface = options.interface,
                       .peers = options.peers,
                       .realtime_priority = urgent ? options.priority : 0,
                       .anyone_may_command = options.anyone_may_command};
  if (!options.security.empty()) settings.security = BusSecurity{.folder = options.security, .role = role};
  for (const std::string& warning : warnings(settings)) {
    if (!quiet) print_message("warning: {}\n", warning);
  }
  return settings;
}

RealtimeSettings loop_settings(const BusOptions& options) {
  RealtimeSettings settings;
  if (options.priority == 0) return {.scheduling = Requirement::none, .locked_memory = Requirement::none};
  settings.priority = options.priority;
  return settings;
}

void tell_what_is_missing(const RealtimeReport& report, bool quiet) {
  if (quiet) return;
  for (const Privilege& privilege : report.privileges) {
    if (privilege.granted) continue;
    print_message("warning: {} was not granted: {}; {}\n", privilege.name, privilege.reason,
                  privilege.remedy);
  }
}

std::string name_of(const BusOptions& options) {
  return fmt::format("domain {} on {}", options.domain, options.interface);
}

}  // namespace flinch
