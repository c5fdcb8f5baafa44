#include "systems/contact/course_memory.h"

#include <algorithm>

namespace flinch {
namespace {

constexpr Time jitter = 500us;  // of a stamp against those that follow

CourseMoment between(const CourseMemory::Remembered& before, const CourseMemory::Remembered& after,
                     Time wanted) {
  const double share = to_seconds(wanted - before.acquired) / to_seconds(after.acquired - before.acquired);
  const CourseMoment &a = before.moment, &b = after.moment;
  return {a.wrench_in_base + share * (b.wrench_in_base - a.wrench_in_base),
          a.velocity + share * (b.velocity - a.velocity)};
}

}  // namespace

void CourseMemory::recall(const WrenchEstimate& estimate, const PlatformMotion& motion, const Past& past,
                          ContactCourse& result) const {
  result.acquired = estimate.acquired;
  result.valid = false;
  if (!estimate.valid || !motion.valid()) return;
  result.moments.front() = {estimate.wrench_in_base, motion.velocity};
  const Remembered now{estimate.acquired, result.moments.front()};
  const Time tolerance = std::max<Time>(1ms, period_) + std::max(jitter, period_ / 2);  // one tick is missing
  for (std::size_t i = 1; i < course_ages.size(); ++i) {
    const Time wanted = estimate.acquired - course_ages[i];
    const Remembered* const then = past.last_before(wanted + jitter);
    if (then == nullptr || wanted - then->acquired > tolerance) return;
    const bool is_between = period_ > 1ms && then->acquired < wanted;
    const Remembered* const after = is_between ? past.around(wanted, &now).after : nullptr;
    result.moments[i] = after != nullptr ? between(*then, *after, wanted) : then->moment;
  }
  result.valid = true;
}

void CourseMemory::grow(const ContactCourse& now, WrenchEstimate& result) const {
  result.acquired = now.acquired;
  result.valid = now.valid;
  if (now.valid) result.wrench_in_base = growth_of(now.moments);
}

void CourseMemory::remember(const WrenchEstimate& estimate, const PlatformMotion& motion, Past& past) const {
  if (estimate.valid && motion.valid())
    past.push({estimate.acquired, {estimate.wrench_in_base, motion.velocity}});
  else
    past = Past();
}

}  // namespace flinch
