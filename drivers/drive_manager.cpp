#include "drivers/drive_manager.h"

namespace flinch {
namespace {

using enum DriveState;

DriveState state_for(RequestedDriveState::State wanted) {
  switch (wanted) {
    case RequestedDriveState::State::without_voltage:
      return switch_on_disabled;
    case RequestedDriveState::State::switched_on:
      return switched_on;
    case RequestedDriveState::State::operation_enabled:
      return operation_enabled;
    case RequestedDriveState::State::quick_stop:
      return quick_stop_active;
  }
  return switch_on_disabled;
}

/// The command that changes nothing: a controlword counts as long as it stands.
DriveCommand stay_in(DriveState state) {
  switch (state) {
    case operation_enabled:
      return DriveCommand::enable_operation;
    case switched_on:
      return DriveCommand::switch_on;
    case ready_to_switch_on:
      return DriveCommand::shutdown;
    case quick_stop_active:
      return DriveCommand::quick_stop;
    default:
      return DriveCommand::disable_voltage;
  }
}

}  // namespace

Controlword DriveManager::lead(std::uint32_t resets, const RequestedDriveState& wanted,
                               const Statusword& drive) const {
  const DriveState state = drive.state();
  if (state == fault && wanted.fault_resets != resets) return {controlword_for(DriveCommand::fault_reset)};
  const DriveCommand step = step_towards(state_for(wanted.state), state);
  return {controlword_for(step == DriveCommand::none ? stay_in(state) : step)};
}

}  // namespace flinch
