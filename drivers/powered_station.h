#pragma once

#include "diagrams/station.h"
#include "drivers/drive_state_machine.h"
#include "drivers/requested_drive_state.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

/// A station whose drives must be switched on before they act: what DdsServer puts on the bus.
struct PoweredStation : Station {
  InputPort<RequestedDriveState> wish;
  OutputPort<Statusword> statusword;
};

/// Adds the state machine of a drive in front of `bare`, as one nested diagram, "power":
///
///   wish -> DriveManager -> DriveStateMachine -> PowerStage -> torque and brakes of the bare station
///
/// For drives that are nothing but simulated; real servo amplifiers have state machines of their own, see
/// add_amplifier_station().
PoweredStation add_powered_station(DiagramBuilder& builder, const Station& bare);

}  // namespace flinch
