#pragma once

#include "diagrams/external_station.h"
#include "drivers/drive_group.h"
#include "drivers/powered_station.h"

namespace flinch {

/// Servo amplifiers with state machines of their own, led as one: what DdsServer puts on the bus. Whoever
/// talks with the amplifiers says before each tick what they tell, and brings them after it what they shall
/// do.
struct AmplifierStation : PoweredStation {
  InputPort<Statuswords> statuswords;   ///< of the amplifiers; none where they do not answer
  OutputPort<Controlword> controlword;  ///< for each of them
};

/// Adds what stands between the bus and the amplifiers behind `fieldbus`, as one nested diagram, "power":
///
///   statuswords -> DriveGroup, with wish -> DriveManager -> controlword
///   torque and brake from the bus -> PowerStage -> torque_command and brake of `fieldbus`
///
/// Torque passes only while all amplifiers are in operation; in every other state there is none, and the
/// brakes are closed. What comes in from bus and amplifiers becomes inputs of `builder`, which must build the
/// outermost diagram.
AmplifierStation add_amplifier_station(DiagramBuilder& builder, const ExternalStation& fieldbus);

}  // namespace flinch
