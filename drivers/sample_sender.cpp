#include "drivers/sample_sender.h"

#include <drivers/idl/flinch.h>

#include "systems/framework/monotonic_clock.h"

namespace flinch {

void stamp(flinch_Header& header, const SenderIdentity& sender, std::uint32_t number) noexcept {
  header.session = sender.session;
  header.robot = sender.robot;
  header.robot_id = sender.robot_id;
  header.version = protocol_version;
  header.number = number;
  header.sent_ns = MonotonicClock::now().count();
}

}  // namespace flinch
