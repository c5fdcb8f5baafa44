#pragma once

#include "drivers/drive_state_machine.h"
#include "drivers/requested_drive_state.h"
#include "systems/framework/system.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// What a drive's state machine does to its motor: torque passes in operation_enabled only; in every other
/// state there is none, and the brakes are closed, as they are where the wish asks for it. The station is
/// enabled only in that state, and reports the machine's fault as its own.
class PowerStage final : public System {
 public:
  InputPort<Statusword> statusword = input<Statusword>("statusword");
  InputPort<RequestedDriveState> wish = input<RequestedDriveState>("wish");
  InputPort<TorqueCommand> wanted_torque = input<TorqueCommand>("wanted_torque");
  InputPort<BrakeCommand> wanted_brake = input<BrakeCommand>("wanted_brake");
  InputPort<StationStatus> bare_status = input<StationStatus>("bare_status");

  OutputPort<TorqueCommand> torque_command =
      output<&PowerStage::pass>("torque_command", statusword, wanted_torque);
  OutputPort<BrakeCommand> brake = output<&PowerStage::hold>("brake", statusword, wish, wanted_brake);
  OutputPort<StationStatus> status = output<&PowerStage::report>("status", statusword, bare_status);

 private:
  static bool is_enabled(const Statusword& drive) { return drive.state() == DriveState::operation_enabled; }

  TorqueCommand pass(const Statusword& drive, const TorqueCommand& torque) const {
    return is_enabled(drive) ? torque : TorqueCommand();
  }
  BrakeCommand hold(const Statusword& drive, const RequestedDriveState& wanted,
                    const BrakeCommand& command) const {
    return {.engage = command.engage || wanted.engage_brake || !is_enabled(drive)};
  }
  StationStatus report(const Statusword& drive, const StationStatus& bare) const {
    StationStatus told = bare;
    told.enabled = bare.enabled && is_enabled(drive);
    told.fault = bare.fault || drive.state() == DriveState::fault ||
                 drive.state() == DriveState::fault_reaction_active;
    return told;
  }
};

}  // namespace flinch
