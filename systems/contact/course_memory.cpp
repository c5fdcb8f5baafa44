#include "systems/contact/course_memory.h"

namespace flinch {
namespace {

constexpr Time jitter = 500us;            // of a stamp against those that follow
constexpr Time tolerance = 1ms + jitter;  // nothing new for one tick

}  // namespace

void CourseMemory::recall(const WrenchEstimate& estimate, const PlatformMotion& motion, const Past& past,
                          ContactCourse& result) const {
  result.acquired = estimate.acquired;
  result.valid = false;
  if (!estimate.valid || !motion.valid()) return;
  result.moments.front() = {estimate.wrench_in_base, motion.velocity};
  for (std::size_t i = 1; i < course_ages.size(); ++i) {
    const Time wanted = estimate.acquired - course_ages[i];
    const Remembered* const then = past.last_before(wanted + jitter);
    if (then == nullptr || wanted - then->acquired > tolerance) return;
    result.moments[i] = then->moment;
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
