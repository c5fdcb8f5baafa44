#include "systems/contact/contact_window_buffer.h"

#include <algorithm>

namespace flinch {
namespace {

constexpr Time jitter = 500us;  // of a stamp against those that follow

ContactMoment between(const ContactWindowBuffer::Remembered& before,
                      const ContactWindowBuffer::Remembered& after, Time wanted) {
  const double share = to_seconds(wanted - before.acquired) / to_seconds(after.acquired - before.acquired);
  const ContactMoment &a = before.moment, &b = after.moment;
  return {a.wrench_in_base + share * (b.wrench_in_base - a.wrench_in_base),
          a.velocity + share * (b.velocity - a.velocity)};
}

}  // namespace

void ContactWindowBuffer::recall(const WrenchEstimate& estimate, const PlatformMotion& motion,
                                 const Past& past, ContactWindow& result) const {
  result.acquired = estimate.acquired;
  result.valid = false;
  if (!estimate.valid || !motion.valid()) return;
  result.moments.front() = {estimate.wrench_in_base, motion.velocity};
  const Remembered now{estimate.acquired, result.moments.front()};
  const Time tolerance = std::max<Time>(1ms, period_) + std::max(jitter, period_ / 2);  // one tick is missing
  for (std::size_t i = 1; i < window_ages.size(); ++i) {
    const Time wanted = estimate.acquired - window_ages[i];
    const Remembered* const then = past.last_before(wanted + jitter);
    if (then == nullptr || wanted - then->acquired > tolerance) return;
    const bool is_between = period_ > 1ms && then->acquired < wanted;
    const Remembered* const after = is_between ? past.around(wanted, &now).after : nullptr;
    result.moments[i] = after != nullptr ? between(*then, *after, wanted) : then->moment;
  }
  result.valid = true;
}

void ContactWindowBuffer::grow(const ContactWindow& now, WrenchEstimate& result) const {
  result.acquired = now.acquired;
  result.valid = now.valid;
  if (now.valid) result.wrench_in_base = growth_of(now.moments);
}

void ContactWindowBuffer::remember(const WrenchEstimate& estimate, const PlatformMotion& motion,
                                   Past& past) const {
  if (estimate.valid && motion.valid())
    past.push({estimate.acquired, {estimate.wrench_in_base, motion.velocity}});
  else
    past = Past();
}

}  // namespace flinch
