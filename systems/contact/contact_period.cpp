#include "systems/contact/contact_period.h"

#include "systems/foundation/setup_error.h"

namespace flinch {

ContactPeriod::ContactPeriod(Time same_contact) : same_contact_(same_contact) {
  if (same_contact < Time{}) throw SetupError("contact period: same_contact must not be negative");
}

ContactPeriod::Memory ContactPeriod::advance(Time now, const ContactDetection& contact,
                                             const ResetCommand& command, const Memory& last) const {
  Memory next = command.reset ? Memory() : last;
  const bool detected = contact.valid && contact.present_level != ContactLevel::none;
  if (detected) {
    next.detected = now;
    if (!next.phase.active) next.phase = {.active = true, .since = now};
  } else if (now - next.detected > same_contact_) {
    next.phase.active = false;
  }
  return next;
}

}  // namespace flinch
