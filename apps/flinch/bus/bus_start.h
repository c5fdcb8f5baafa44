#pragma once

#include <string>

#include "apps/flinch/bus_options.h"
#include "drivers/bus_settings.h"
#include "systems/framework/realtime_thread.h"

namespace flinch {

/// The bus that the options name. Threads of the bus get the wanted priority only where it is permitted.
/// Tells on stderr, unless `quiet`, what the user should know: a bus without security that others can reach.
/// `role`: whose keys to use, where there are keys.
BusSettings bus_settings(const BusOptions& options, bool quiet, BusRole role = BusRole::controller);

/// What a control loop asks the machine for.
RealtimeSettings loop_settings(const BusOptions& options);

/// Tells on stderr, unless `quiet`, what the machine has not granted, and how to change that.
void tell_what_is_missing(const RealtimeReport& report, bool quiet);

/// "domain 3 on lo", for messages and recordings.
std::string name_of(const BusOptions& options);

}  // namespace flinch
