#include "drivers/drive_state_machine.h"

namespace flinch {
namespace {

using enum DriveState;

/// Transitions 1, 12, 13 and 14; the same state where none applies.
DriveState by_itself(DriveState state, const DriveCondition& drive) {
  if (drive.fault && state != fault && state != fault_reaction_active) return fault_reaction_active;
  if (state == not_ready_to_switch_on && drive.started) return switch_on_disabled;
  if (state == quick_stop_active && drive.standstill) return switch_on_disabled;
  if (state == fault_reaction_active && drive.standstill) return fault;
  return state;
}

}  // namespace

DriveStateMachine::Memory DriveStateMachine::next(const Memory& memory, const Controlword& word,
                                                  const DriveCondition& drive) noexcept {
  const DriveState moved = by_itself(memory.state, drive);
  if (moved != memory.state) return {moved, word};
  const DriveCommand command = command_in(word.bits, memory.last.bits);
  if (command == DriveCommand::fault_reset && drive.fault) return {memory.state, word};
  return {after(memory.state, command), word};
}

}  // namespace flinch
