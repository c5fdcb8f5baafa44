#pragma once

#include "diagrams/station.h"
#include "drivers/drive_state_machine.h"
#include "drivers/drive_wish.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

/// A station whose drives must be switched on before they act: what DdsServer puts on the bus.
struct PoweredStation : Station {
  InputPort<DriveWish> wish;
  OutputPort<Statusword> statusword;
};

/// Adds the state machine of a drive in front of `bare`, as one nested diagram, "power":
///
///   wish -> DriveMaster -> DriveStateMachine -> PowerStage -> torque and brakes of the bare station
///
/// A program that has real servo amplifiers keeps DriveMaster and brings controlword and statusword to and
/// from their fieldbus; the state machine and the power stage are then the amplifiers' own.
PoweredStation add_powered_station(DiagramBuilder& builder, const Station& bare);

}  // namespace flinch
