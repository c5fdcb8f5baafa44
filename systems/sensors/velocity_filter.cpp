#include "systems/sensors/velocity_filter.h"

#include "systems/foundation/setup_error.h"

namespace flinch {

VelocityFilter::VelocityFilter(std::shared_ptr<const ParallelRobot> robot,
                               const VelocityFilterSettings& settings)
    : robot_(std::move(robot)), sampling_(settings.sampling), low_pass_(settings.low_pass) {
  throw_if_any(problems(settings.low_pass));
  keep(Every{sampling_.period}, memory_, next_);
}

bool VelocityFilter::is_new(const JointReading& reading, const VelocityFilterMemory& memory) const {
  return reading.valid && reading.active.size() == robot_->drives() && reading.active.allFinite() &&
         (!memory.has_sample || reading.acquired > memory.acquired);
}

void VelocityFilter::advance(const JointReading& reading, const VelocityFilterMemory& memory, Time now,
                             VelocityFilterMemory& next) const {
  if (!is_new(reading, memory)) {
    next = sampling_.expired(memory.arrived, now) ? VelocityFilterMemory() : memory;
    return;
  }
  next = {.has_sample = true,
          .acquired = reading.acquired,
          .arrived = now,
          .position = reading.active,
          .velocity = {}};
  if (!memory.has_sample || sampling_.interrupted(memory.acquired, reading.acquired)) return;
  const double interval = to_seconds(reading.acquired - memory.acquired);
  const JointVector mean = robot_->drive_difference(reading.active, memory.position) / interval;
  next.velocity = low_pass_.next(memory.velocity, mean, interval);
}

void VelocityFilter::read(const VelocityFilterMemory& next, JointMotion& result) const {
  result.acquired = next.acquired;
  result.valid = next.velocity.started;
  const JointVector zero = JointVector::Zero(robot_->drives());
  result.position = next.has_sample ? next.position : zero;
  result.velocity = result.valid ? next.velocity.output : zero;
}

}  // namespace flinch
