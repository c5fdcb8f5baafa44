#pragma once

#include <cstdint>

#include "drivers/drive_state_machine.h"
#include "drivers/requested_drive_state.h"
#include "systems/framework/system.h"

namespace flinch {

/// Leads a drive to where it is wished, one transition of its state machine a tick, as a master on the
/// drive's fieldbus does. A fault is reset once for every increase of `fault_resets`, and never by itself.
class DriveManager final : public System {
  State<std::uint32_t> resets_ = state<std::uint32_t>("resets");

 public:
  InputPort<RequestedDriveState> wish = input<RequestedDriveState>("wish");
  InputPort<Statusword> statusword = input<Statusword>("statusword");
  OutputPort<Controlword> controlword = output<&DriveManager::lead>("controlword", resets_, wish, statusword);

 private:
  Update count_ = update<&DriveManager::count>(resets_, wish);

  Controlword lead(std::uint32_t resets, const RequestedDriveState& wanted, const Statusword& drive) const;
  std::uint32_t count(const RequestedDriveState& wanted) const { return wanted.fault_resets; }
};

}  // namespace flinch
