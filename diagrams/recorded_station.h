#pragma once

#include <string>

#include "diagrams/faulty_value.h"
#include "diagrams/station.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/recording.h"

namespace flinch {

/// Adds what a station once told, as one nested diagram, "station", that plays it back tick by tick, bit for
/// bit: to run another control path on the same readings, or the same one again. What it is commanded has no
/// effect. After its end and between its samples it does as Player does.
///
/// The recording keeps the readings as `prefix` + "joints", "drives", "imu", "status" and, where there was an
/// instrument, "force_torque"; those of 'flinch run' have no prefix. Throws SetupError when one is missing or
/// was recorded without one of its fields.
/// `faults`: put on top of the readings. Those of drives and brakes are refused.
Station add_recorded_station(DiagramBuilder& builder, const Recording& recording,
                             const std::string& prefix = "", const RequestedFaults& faults = {});

}  // namespace flinch
