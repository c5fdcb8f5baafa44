#pragma once

#include <cstdint>

#include "plant/contact_forces.h"
#include "systems/framework/time.h"

namespace flinch {

/// Time after which a quantity crosses zero, for one whose values g0, g1 [m] at 0 and `duration` [s] have
/// opposite signs and whose rates there are rate0, rate1 [m/s]: of the cubic Hermite polynomial through them.
double hermite_crossing(double g0, double rate0, double g1, double rate1, double duration) noexcept;

/// What must be remembered from tick to tick to say when contacts with obstacles began and ended. A contact
/// begins when the first body penetrates and ends when the last one leaves; both instants are interpolated
/// between ticks to about a microsecond.
struct ContactHistory {
  bool started = false;  ///< There has been a tick.
  Time now{};
  NearPairs pairs;
  bool in_contact = false;
  std::int64_t contacts = 0;  ///< Begun so far.
  Time onset{};               ///< Of the present or latest contact.
  Time end{};                 ///< Of the latest contact; while one lasts, `now`.
  double peak_force = 0.0;    ///< Greatest force of a single contact at the ticks since onset [N].

  /// The history at the next tick, where the near pairs and contacts are these.
  ContactHistory next(Time time, const NearPairs& pairs_then,
                      const ContactForces& contacts_then) const noexcept;
};

}  // namespace flinch
