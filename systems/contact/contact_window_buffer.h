#pragma once

#include "systems/framework/system.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/contact_window.h"
#include "systems/signals/history.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Remembers an estimate and the motion, and tells their course at every tick of the first `window` of a
/// contact; at others the last one stands. A moment is the newest that is less than half a millisecond
/// younger than its age, for stamps jitter; where ticks are longer than a millisecond, it lies between those
/// of the ticks around it. The course is not valid where that one is 1.5 ms older than its age, or half a
/// tick more than one, or where something was not known since. (Derived.)
class ContactWindowBuffer final : public System {
 public:
  struct Remembered {
    Time acquired{};
    ContactMoment moment;
  };
  using Past = History<Remembered, 192>;  // 48 ms at least

 private:
  State<Past> past_ = state<Past>("past");

 public:
  explicit ContactWindowBuffer(Time window, Time period = 1ms) : window_(window), period_(period) {}

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");

 private:
  Intermediate<bool> active_ = intermediate<&ContactWindowBuffer::is_active>("active", clock, phase);

 public:
  OutputPort<ContactWindow> course =
      output<&ContactWindowBuffer::recall>(When(active_), "course", wrench, platform, past_);
  /// What of the estimate has come since the first moment of the course: without errors that are older.
  OutputPort<WrenchEstimate> growth = output<&ContactWindowBuffer::grow>(When(active_), "growth", course);

 private:
  Update remember_ = update<&ContactWindowBuffer::remember>(past_, wrench, platform);

  bool is_active(Time now, const ContactPhase& contact) const {
    return contact.active && now - contact.since <= window_;
  }
  void recall(const WrenchEstimate& estimate, const PlatformMotion& motion, const Past& past,
              ContactWindow& result) const;
  void grow(const ContactWindow& now, WrenchEstimate& result) const;
  void remember(const WrenchEstimate& estimate, const PlatformMotion& motion, Past& past) const;

  Time window_;
  Time period_;  ///< from tick to tick
};

/// What of the estimate has come since the first moment of a course.
inline PlatformVector growth_of(const ContactMoments& moments) {
  return moments.front().wrench_in_base - moments.back().wrench_in_base;
}

}  // namespace flinch
