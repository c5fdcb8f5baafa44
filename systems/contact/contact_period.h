#pragma once

#include "systems/framework/system.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/reset_command.h"

namespace flinch {

/// Tells one contact from the next: a contact begins where the detector detects something after it has been
/// quiet for `same_contact`, or since the reset, and lasts until then.
class ContactPeriod final : public System {
 public:
  struct Memory {
    ContactPhase phase;
    Time detected{};  ///< last tick at which the detector detected it
  };

 private:
  State<Memory> last_ = state<Memory>("last");

 public:
  /// Throws SetupError for a negative time.
  explicit ContactPeriod(Time same_contact = 100ms);

  InputPort<ContactDetection> detection = input<ContactDetection>("detection");
  InputPort<ResetCommand> reset = input<ResetCommand>("reset");

 private:
  Intermediate<Memory> next_ = intermediate<&ContactPeriod::advance>("next", clock, detection, reset, last_);

 public:
  OutputPort<ContactPhase> phase = output<&ContactPeriod::phase_of>("phase", next_);

 private:
  Update remember_ = keep(last_, next_);

  Memory advance(Time now, const ContactDetection& contact, const ResetCommand& command,
                 const Memory& last) const;
  ContactPhase phase_of(const Memory& next) const { return next.phase; }

  Time same_contact_;
};

}  // namespace flinch
