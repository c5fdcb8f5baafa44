#pragma once

#include <cstdint>

namespace flinch {

/// States of a drive. CiA 402 (IEC 61800-7-201), power drive system.
enum class DriveState : std::uint8_t {
  not_ready_to_switch_on,  ///< starts up
  switch_on_disabled,      ///< no high voltage
  ready_to_switch_on,      ///< high voltage may be applied
  switched_on,             ///< high voltage applied, no torque
  operation_enabled,       ///< torque follows the commands
  quick_stop_active,       ///< brakes by its own ramp
  fault_reaction_active,   ///< does what it has been set to do about a fault
  fault,                   ///< no torque until a reset
};
inline constexpr int drive_state_count = 8;

/// What a controlword asks for.
enum class DriveCommand : std::uint8_t {
  none,  ///< a controlword that means nothing
  shutdown,
  switch_on,  ///< in operation_enabled: disable operation
  enable_operation,
  disable_voltage,
  quick_stop,
  fault_reset,
};
inline constexpr int drive_command_count = 7;

/// What `controlword` asks for after `previous`: a fault is reset by the rising edge of bit 7.
DriveCommand command_in(std::uint16_t controlword, std::uint16_t previous) noexcept;
/// The controlword that asks for `command`.
std::uint16_t controlword_for(DriveCommand command) noexcept;

/// The bits of the statusword that tell the state.
std::uint16_t statusword_of(DriveState state) noexcept;
/// The state that a statusword tells; fault for one that tells none.
DriveState state_in(std::uint16_t statusword) noexcept;

/// The state after `command`, by transitions 2 to 11 and 15; the same where the command is not allowed.
/// Transition 16, from a quick stop back to operation, is not offered.
DriveState after(DriveState state, DriveCommand command) noexcept;

/// The command that leads from `state` one step nearer to `wanted`, one of the five states before
/// fault_reaction_active that can be asked for; none where the drive moves on by itself or is there. It never
/// resets a fault: that is for people to decide.
DriveCommand step_towards(DriveState wanted, DriveState state) noexcept;

/// The state in which two drives are together, and so any number of them: what is wrong with one is wrong
/// with both, and they are as far up as the lower one. Commands that follow from it, given to all, bring
/// drives in different states to the same.
DriveState together(DriveState a, DriveState b) noexcept;

}  // namespace flinch
