#include "systems/estimators/base_force_observer.h"

#include <string>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// Of each component. Throws SetupError.
PlatformVector gain_of(const LegBases* bases, double gain) {
  if (bases == nullptr) throw SetupError("base forces: this robot has no model of its base joints");
  if (bases->size() > max_dof) {
    throw SetupError("base forces: " + std::to_string(bases->size()) + " components are more than the " +
                     std::to_string(max_dof) + " that can be followed");
  }
  if (!(gain > 0.0)) throw SetupError("base forces: the gain must be positive [1/s]");
  return PlatformVector::Constant(bases->size(), gain);
}

}  // namespace

BaseForceObserver::BaseForceObserver(std::shared_ptr<const LegBases> bases,
                                     const BaseForceObserverSettings& settings)
    : bases_(std::move(bases)), settings_(settings), method_(gain_of(bases_.get(), settings.gain)) {}

bool BaseForceObserver::is_usable(const PlatformMotion& motion, const Kinematics& at,
                                  const DriveTorque& drives, const BaseForceReading& reading) const {
  return motion.valid() && at.valid && drives.valid && !drives.braked && drives.torque.allFinite() &&
         reading.valid && reading.force_in_base.size() == bases_->size() && reading.force_in_base.allFinite();
}

void BaseForceObserver::advance(const PlatformMotion& motion, const Kinematics& at, const DriveTorque& drives,
                                const BaseForceReading& reading, const Memory& memory, Time now,
                                Memory& next) const {
  const bool is_new =
      is_usable(motion, at, drives, reading) && (!memory.started || motion.acquired > memory.acquired);
  if (!is_new) {
    const bool lost = drives.braked || settings_.sampling.expired(memory.arrived, now);
    next = lost ? Memory() : memory;
    return;
  }
  const bool continued = memory.started &&
                         !settings_.sampling.interrupted(memory.acquired, motion.acquired) &&
                         memory.method.wrench.allFinite();
  next.started = true;
  next.acquired = motion.acquired;
  next.arrived = now;
  next.begun = continued ? memory.begun : now;
  BaseForces p, known;
  bases_->momentum(at, drives.torque, p, known);
  next.p = p;
  next.known = known + reading.force_in_base;
  if (!continued) {
    next.method = method_.begin(next.p);
    return;
  }
  const PlatformVector mean = 0.5 * (memory.known + next.known);
  method_.advance(memory.method, {to_seconds(motion.acquired - memory.acquired), memory.p, next.p, mean},
                  next.method);
}

void BaseForceObserver::read(const Memory& next, Time now, BaseForceEstimate& result) const {
  result = BaseForceEstimate();
  result.acquired = next.acquired;
  result.force_in_base.setZero(bases_->size());
  if (!next.started || !next.method.wrench.allFinite()) return;
  result.valid = now - next.begun >= settings_.input_settling_time + method_.settling_time();
  result.force_in_base = next.method.wrench;
}

}  // namespace flinch
