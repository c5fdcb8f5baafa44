#include "drivers/drive_state.h"

#include <algorithm>
#include <array>

namespace flinch {
namespace {

using enum DriveState;
using enum DriveCommand;

/// Words that mean the same differ only outside the mask.
struct Pattern {
  std::uint16_t mask;
  std::uint16_t value;
  bool fits(std::uint16_t word) const { return (word & mask) == value; }
};

/// By DriveState.
constexpr std::array<Pattern, drive_state_count> statuswords{{{0x4f, 0x00},
                                                              {0x4f, 0x40},
                                                              {0x6f, 0x21},
                                                              {0x6f, 0x23},
                                                              {0x6f, 0x27},
                                                              {0x6f, 0x07},
                                                              {0x4f, 0x0f},
                                                              {0x4f, 0x08}}};

struct Transition {
  DriveState from;
  DriveCommand command;
  DriveState to;
};

constexpr Transition transitions[] = {
    {switch_on_disabled, shutdown, ready_to_switch_on},         // 2
    {ready_to_switch_on, switch_on, switched_on},               // 3
    {switched_on, enable_operation, operation_enabled},         // 4
    {operation_enabled, switch_on, switched_on},                // 5
    {switched_on, shutdown, ready_to_switch_on},                // 6
    {ready_to_switch_on, disable_voltage, switch_on_disabled},  // 7
    {ready_to_switch_on, quick_stop, switch_on_disabled},       // 7
    {operation_enabled, shutdown, ready_to_switch_on},          // 8
    {operation_enabled, disable_voltage, switch_on_disabled},   // 9
    {switched_on, disable_voltage, switch_on_disabled},         // 10
    {switched_on, quick_stop, switch_on_disabled},              // 10
    {operation_enabled, quick_stop, quick_stop_active},         // 11
    {quick_stop_active, disable_voltage, switch_on_disabled},   // 12
    {fault, fault_reset, switch_on_disabled},                   // 15
};

/// The states in the order in which commands lead through them, without those that a drive leaves by itself.
int height(DriveState state) {
  switch (state) {
    case switch_on_disabled:
      return 0;
    case ready_to_switch_on:
      return 1;
    case switched_on:
      return 2;
    case operation_enabled:
      return 3;
    default:
      return -1;
  }
}

/// The states from the one that is heard least among others to the one that is always heard.
constexpr std::array<DriveState, drive_state_count> by_weight = {
    operation_enabled,      switched_on, ready_to_switch_on,   switch_on_disabled, quick_stop_active,
    not_ready_to_switch_on, fault,       fault_reaction_active};

}  // namespace

DriveCommand command_in(std::uint16_t controlword, std::uint16_t previous) noexcept {
  constexpr std::uint16_t reset_bit = 0x80;
  if ((controlword & reset_bit) != 0) return (previous & reset_bit) == 0 ? fault_reset : none;
  if (Pattern{0x02, 0x00}.fits(controlword)) return disable_voltage;
  if (Pattern{0x06, 0x02}.fits(controlword)) return quick_stop;
  if (Pattern{0x07, 0x06}.fits(controlword)) return shutdown;
  if (Pattern{0x0f, 0x07}.fits(controlword)) return switch_on;
  return enable_operation;
}

std::uint16_t controlword_for(DriveCommand command) noexcept {
  switch (command) {
    case shutdown:
      return 0x06;
    case switch_on:
      return 0x07;
    case enable_operation:
      return 0x0f;
    case quick_stop:
      return 0x02;
    case fault_reset:
      return 0x80;
    case none:
    case disable_voltage:
      break;
  }
  return 0x00;
}

std::uint16_t statusword_of(DriveState state) noexcept {
  return statuswords[static_cast<std::size_t>(state)].value;
}

DriveState state_in(std::uint16_t statusword) noexcept {
  for (std::size_t i = 0; i < statuswords.size(); ++i) {
    if (statuswords[i].fits(statusword)) return static_cast<DriveState>(i);
  }
  return fault;
}

DriveState after(DriveState state, DriveCommand command) noexcept {
  for (const Transition& transition : transitions) {
    if (transition.from == state && transition.command == command) return transition.to;
  }
  return state;
}

DriveCommand step_towards(DriveState wanted, DriveState state) noexcept {
  if (wanted == quick_stop_active && state == operation_enabled) return quick_stop;
  const int now = height(state);
  const int goal = wanted == quick_stop_active ? now : height(wanted);
  if (now < 0 || goal < 0 || now == goal) return none;
  if (goal == 0) return disable_voltage;
  if (goal == 1) return shutdown;
  if (goal == 2) return now == 0 ? shutdown : switch_on;
  constexpr DriveCommand upwards[] = {shutdown, switch_on, enable_operation};
  return upwards[now];
}

DriveState together(DriveState a, DriveState b) noexcept {
  return *std::find_if(by_weight.rbegin(), by_weight.rend(),
                       [a, b](DriveState state) { return state == a || state == b; });
}

}  // namespace flinch
